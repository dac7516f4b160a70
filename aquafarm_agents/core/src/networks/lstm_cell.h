// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The elementwise part of an LSTM with forget gates (Gers et al. 2000) for one row:
///
///   c' = f c + i g,   h' = o tanh(c')
///
/// Gates are in the order i, f, g, o. Each gate is a nonlinear function of a sum: tanh for g, the
/// sigmoid for the others. Both functions are accurate to 2e-7, and NaN stays NaN.

#include <cstddef>

namespace aquafarm::agents {

/// Computes one step of the cell.
/// @param size number of units
/// @param gates [4 size] the sums; receives the gates
/// @param before [size] c
/// @param cell [size] receives c'; may be `before`
/// @param cell_tanh [size] receives tanh(c')
/// @param output [size] receives h'
void LstmCellForward(std::size_t size, float* gates, const float* before, float* cell,
                     float* cell_tanh, float* output);

/// Computes the gradient of LstmCellForward.
/// @param gates [4 size] the gates from LstmCellForward
/// @param before, cell_tanh [size] as in LstmCellForward
/// @param hidden_slopes [size] d loss / d h'
/// @param cell_slopes [size] d loss / d c' through later steps only; receives d loss / d c
/// @param gate_slopes [4 size] receives d loss / d sums
void LstmCellBackward(std::size_t size, const float* gates, const float* before,
                      const float* cell_tanh, const float* hidden_slopes, float* cell_slopes,
                      float* gate_slopes);

}  // namespace aquafarm::agents
