// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm/ranch/ranch_builder.h"

namespace aquafarm {

const std::filesystem::path kData = std::filesystem::path(AQUAFARM_CORE_DIR) / "test" / "data";
constexpr std::int64_t kHour_s = 3600;
constexpr std::int64_t kMidnight = 1627171200;  // 2021-07-25 00:00 UTC

// Returns a request for a ranch at the island of coast.json, a square with a lake. The storm is
// that of cma.txt, which passes 20 km north of the island.
inline RanchRequest Request() {
  RanchRequest request;
  request.chart = (kData / "coast.json").string();
  request.center = GeoPoint{30.03, 122.05};
  request.width = 24;
  request.height = 20;
  request.cell_size_m = 500.0;
  request.track = (kData / "cma.txt").string();
  request.storm = "In-fa";
  return request;
}

inline bool Says(const std::vector<std::string>& lines, const std::string& words) {
  return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
    return line.find(words) != std::string::npos;
  });
}

inline std::string Refused(const RanchRequest& request) {
  try {
    BuildRanch(request);
  } catch (const InputError& error) {
    return error.what();
  }
  return "was made";
}

}  // namespace aquafarm
