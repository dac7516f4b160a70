// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "aquafarm/base/rng.h"

namespace aquafarm::agents {

/// Returns `size` random numbers, uniform in [min, 1). Equal arguments give equal numbers.
inline std::vector<float> Noise(std::size_t size, std::uint32_t stream, float min = -1.0F) {
  RandomStream rng({9, 0, RngStream::kLearner, stream});
  std::vector<float> values(size);
  for (float& one : values) one = rng.Uniform(min, 1.0F);
  return values;
}

}  // namespace aquafarm::agents
