// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <cstdint>

#include "aquafarm_viz/scene/values.h"

namespace aquafarm_viz {

std::vector<cv::Point> ShownActions(const Values& values, int every) {
  constexpr std::size_t kFew = 12;
  std::vector<cv::Point> rare;
  std::vector<cv::Point> shown;
  for (int y = 0; y < values.height; ++y) {
    for (int x = 0; x < values.width; ++x) {
      const std::uint8_t action = values.actions[values.Index(x, y)];
      if (action > 9) continue;
      const bool is_sample = x % every == every / 2 && y % every == every / 2;
      if (is_sample) {
        shown.emplace_back(x, y);
      } else if (action >= 8 && rare.size() <= kFew) {
        rare.emplace_back(x, y);
      }
    }
  }
  if (rare.size() <= kFew) shown.insert(shown.end(), rare.begin(), rare.end());
  return shown;
}

}  // namespace aquafarm_viz
