// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace aquafarm::agents {

/// Returns the updated exponential moving average of a mean squared error.
/// @param average previous average; NaN before the first error
/// @param error new mean squared error
/// @param share weight of the new error
inline float MoveError(float average, float error, float share = 0.01F) {
  return std::isnan(average) ? error : average + share * (error - average);
}

}  // namespace aquafarm::agents
