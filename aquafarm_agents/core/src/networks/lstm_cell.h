// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The elementwise part of an LSTM with forget gates (Gers et al. 2000) for one row:
///
///   c' = f c + i g,   h' = o tanh(c')
///
/// Gates are in the order i, f, g, o, [4 hidden]; sigmoid, but tanh for g. Both are accurate to
/// 2e-7; NaN stays NaN.

#include <cstddef>

namespace aquafarm::agents {

/// @param gates [4 size] the sums; receives the gates
/// @param before [size] c
/// @param cell [size] receives c'; may be `before`
/// @param cell_tanh [size] receives tanh(c')
/// @param output [size] receives h'
void LstmCellForward(std::size_t size, float* gates, const float* before, float* cell,
                     float* cell_tanh, float* output);

/// Slopes are d loss / d value.
/// @param gates [4 size] after LstmCellForward
/// @param hidden_slopes [size] of h'
/// @param cell_slopes [size] of c' by later steps; receives those of c
/// @param gate_slopes [4 size] receives those of the sums
void LstmCellBackward(std::size_t size, const float* gates, const float* before,
                      const float* cell_tanh, const float* hidden_slopes, float* cell_slopes,
                      float* gate_slopes);

}  // namespace aquafarm::agents
