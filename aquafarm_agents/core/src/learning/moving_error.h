// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace aquafarm::agents {

/// Returns the moving average of a mean squared error after a new one.
///
/// average: before it; NaN if there was none
/// share: weight of the new error
inline float MoveError(float average, float error, float share = 0.01F) {
  return std::isnan(average) ? error : average + share * (error - average);
}

}  // namespace aquafarm::agents
