// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "aquafarm/base/check.h"
#include "aquafarm/tracks/reader.h"

namespace aquafarm {

const std::filesystem::path kData = std::filesystem::path(AQUAFARM_CORE_DIR) / "test" / "data";

/// Returns the content of a file in test/data.
inline std::string Sample(const std::string& name) {
  std::ifstream file(kData / name, std::ios::binary);
  if (!file) throw std::invalid_argument(name);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline StormFile Load(const std::string& name) { return LoadStormFile((kData / name).string()); }

/// Returns the fix at a time. The track must have such a fix.
inline const StormFix& At(const StormTrack& track, std::int64_t time) {
  return *std::find_if(track.fixes.begin(), track.fixes.end(),
                       [time](const StormFix& fix) { return fix.time == time; });
}

/// Replaces one part of a text. @throws std::invalid_argument if the part is missing
inline std::string With(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::invalid_argument(from);
  return text.replace(at, from.size(), to);
}

/// Returns the message of the error of parsing a text as file "x"; "was read" without an error.
inline std::string Refusal(const std::string& text) {
  try {
    ParseStormFile(text, "x");
  } catch (const InputError& error) {
    return error.what();
  }
  return "was read";
}

/// Returns the warnings of parsing a text as file "x", one per line.
inline std::string Warnings(const std::string& text) {
  std::string all;
  for (const std::string& warning : ParseStormFile(text, "x").warnings) all += warning + "\n";
  return all;
}

constexpr std::int64_t kInFaNoon = 1627192800;  // 2021-07-25 06:00 UTC

using Radii = std::array<double, kQuadrantCount>;

inline void ExpectRadii(const StormFix& fix, std::int32_t wind_kt, const Radii& expected) {
  const WindRing* ring = fix.Ring(wind_kt);
  ASSERT_NE(ring, nullptr) << wind_kt;
  for (std::size_t q = 0; q < expected.size(); ++q) {
    EXPECT_NEAR(ring->radius_km[q], expected[q], 0.05) << wind_kt << " kt, quadrant " << q;
  }
  EXPECT_FALSE(ring->estimated);
}

inline Radii NauticalMiles(Radii radii) {
  for (double& radius : radii) radius *= kKmPerNauticalMile;
  return radii;
}

}  // namespace aquafarm
