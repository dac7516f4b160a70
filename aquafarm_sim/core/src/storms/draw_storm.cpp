// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/storms/draw_storm.h"

#include <algorithm>

#include "aquafarm/base/check.h"
#include "aquafarm/base/deterministic_math.h"
#include "aquafarm/base/rng.h"

namespace aquafarm {

const std::vector<ArchivedStorm>& StormsOf(const StormsSpec& storms, std::uint64_t seed) {
  AQUAFARM_CHECK_EQ(storms.library != nullptr, true);
  return IsEvaluationSeed(seed) ? storms.library->evaluation : storms.library->training;
}

DrawnStorm DrawStorm(const StormsSpec& storms, std::uint64_t seed, std::uint64_t episode,
                     std::int32_t disaster, double x, double y) {
  constexpr double kWeakest = 0.3;  // min factor of the recorded wind
  constexpr double kHour_s = 3600.0;
  const std::vector<ArchivedStorm>& among = StormsOf(storms, seed);
  const StormPerturbation& by = storms.perturbation;
  RandomStream rng({seed, episode, RngStream::kStorm, static_cast<std::uint32_t>(disaster)});
  DrawnStorm drawn;
  drawn.storm = &among[rng.Below(static_cast<std::uint32_t>(among.size()))];
  const StormPath& path = drawn.storm->path;
  // Every error is drawn, even if its deviation is 0. A change of one deviation therefore does not
  // change the other draws.
  drawn.errors.along_km = by.along_km * rng.Normal();
  drawn.errors.across_km = by.across_km * rng.Normal();
  const double start_h = by.start_h * (2.0 * static_cast<double>(rng.Unit()) - 1.0);
  drawn.errors.wind_factor = std::max(kWeakest, 1.0 + by.intensity * rng.Normal());
  drawn.errors.size_factor = Exp(by.size * rng.Normal());
  const double wanted_s = (storms.approach_h + start_h) * kHour_s;
  const PathApproach approach =
      ClosestApproach(path, x, y, drawn.errors.along_km / path.cell_size_km,
                      drawn.errors.across_km / path.cell_size_km);
  drawn.errors.shift_s = wanted_s - approach.step * path.step_duration_s;
  return drawn;
}

}  // namespace aquafarm
