// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The elementwise part of an LSTM with forget gates (Gers et al. 2000) for one row:
///
///   c' = f c + i g,   h' = o tanh(c')
///
/// Gates are in the order i, f, g, o, [4 hidden]; sigmoid, but tanh for g.

#include <Eigen/Core>
#include <cstddef>

namespace aquafarm::agents {

using LstmRow = Eigen::Map<Eigen::ArrayXf>;
using ConstLstmRow = Eigen::Map<const Eigen::ArrayXf>;

/// Views `size` values as an array of Eigen.
inline LstmRow AsRow(float* values, std::size_t size) {
  return {values, static_cast<Eigen::Index>(size)};
}
inline ConstLstmRow AsRow(const float* values, std::size_t size) {
  return {values, static_cast<Eigen::Index>(size)};
}

/// @param gates [4 size] the sums; receives the gates
/// @param before [size] c
/// @param cell [size] receives c'; may be `before`
/// @param cell_tanh [size] receives tanh(c')
/// @param output [size] receives h'
inline void LstmCellForward(std::size_t size, float* gates, const float* before, float* cell,
                            float* cell_tanh, float* output) {
  auto in = AsRow(gates, size);
  auto forget = AsRow(gates + size, size);
  auto added = AsRow(gates + 2 * size, size);
  auto out = AsRow(gates + 3 * size, size);
  in = in.logistic();
  forget = forget.logistic();
  added = added.tanh();
  out = out.logistic();
  AsRow(cell, size) = forget * AsRow(before, size) + in * added;
  AsRow(cell_tanh, size) = AsRow(static_cast<const float*>(cell), size).tanh();
  AsRow(output, size) = out * AsRow(static_cast<const float*>(cell_tanh), size);
}

/// Slopes are d loss / d value.
/// @param gates [4 size] after LstmCellForward
/// @param hidden_slopes [size] of h'
/// @param cell_slopes [size] of c' by later steps; receives those of c
/// @param gate_slopes [4 size] receives those of the sums
inline void LstmCellBackward(std::size_t size, const float* gates, const float* before,
                             const float* cell_tanh, const float* hidden_slopes, float* cell_slopes,
                             float* gate_slopes) {
  const auto in = AsRow(gates, size);
  const auto forget = AsRow(gates + size, size);
  const auto added = AsRow(gates + 2 * size, size);
  const auto out = AsRow(gates + 3 * size, size);
  const auto tanh = AsRow(cell_tanh, size);
  const auto hidden_slope = AsRow(hidden_slopes, size);
  auto cell_slope = AsRow(cell_slopes, size);
  cell_slope += hidden_slope * out * (1.0F - tanh.square());
  AsRow(gate_slopes, size) = cell_slope * added * in * (1.0F - in);
  AsRow(gate_slopes + size, size) = cell_slope * AsRow(before, size) * forget * (1.0F - forget);
  AsRow(gate_slopes + 2 * size, size) = cell_slope * in * (1.0F - added.square());
  AsRow(gate_slopes + 3 * size, size) = hidden_slope * tanh * out * (1.0F - out);
  cell_slope *= forget;
}

}  // namespace aquafarm::agents
