// SPDX-License-Identifier: BSD-3-Clause
#include "networks/lstm_cell.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "aquafarm/base/widest.h"

namespace aquafarm::agents {
namespace {

// Returns e^x − 1 = 2^n e^r − 1 with x = n ln(2) + r and |r| ≤ ln(2) / 2. A Taylor series gives
// e^r − 1. Compilers vectorize loops that call this function. @param x in [-87, 87], or NaN
inline float ExpMinusOne(float x) {
  constexpr float kPerLog2 = 1.44269504F;
  constexpr float kLog2 = 0.693359375F;         // has few digits, so that n · kLog2 is exact
  constexpr float kLog2Rest = -2.12194440e-4F;  // ln 2 − kLog2
  constexpr float kToWhole = 12582912.0F;       // 1.5 · 2^23: adding it rounds to a whole number
  const float shifted = x * kPerLog2 + kToWhole;
  const float n = shifted - kToWhole;
  const float r = (x - n * kLog2) - n * kLog2Rest;
  float series = 1.0F / 5040.0F;
  for (const float factor : {1.0F / 720.0F, 1.0F / 120.0F, 1.0F / 24.0F, 1.0F / 6.0F, 0.5F}) {
    series = series * r + factor;
  }
  series = series * r * r + r;
  std::uint32_t bits = 0;
  std::memcpy(&bits, &shifted, sizeof bits);
  bits = (bits << 23U) + 0x3F800000U;  // the bits of 2^n
  float power = 0.0F;
  std::memcpy(&power, &bits, sizeof power);
  return power * series + (power - 1.0F);
}

// Limits x to [-limit, limit]. NaN stays NaN.
inline float Bound(float x, float limit) { return std::max(std::min(x, limit), -limit); }

inline float Logistic(float x) { return 1.0F / (2.0F + ExpMinusOne(Bound(-x, 87.0F))); }

inline float Tanh(float x) {
  const float e = ExpMinusOne(Bound(2.0F * x, 20.0F));
  return e / (e + 2.0F);
}

}  // namespace

AQUAFARM_WIDEST
void LstmCellForward(std::size_t size, float* gates, const float* before, float* cell,
                     float* cell_tanh, float* output) {
  for (std::size_t i = 0; i < 2 * size; ++i) gates[i] = Logistic(gates[i]);
  for (std::size_t i = 2 * size; i < 3 * size; ++i) gates[i] = Tanh(gates[i]);
  for (std::size_t i = 3 * size; i < 4 * size; ++i) gates[i] = Logistic(gates[i]);
  const float* const in = gates;
  const float* const forget = gates + size;
  const float* const added = gates + 2 * size;
  const float* const out = gates + 3 * size;
  for (std::size_t i = 0; i < size; ++i) cell[i] = forget[i] * before[i] + in[i] * added[i];
  for (std::size_t i = 0; i < size; ++i) cell_tanh[i] = Tanh(cell[i]);
  for (std::size_t i = 0; i < size; ++i) output[i] = out[i] * cell_tanh[i];
}

AQUAFARM_WIDEST
void LstmCellBackward(std::size_t size, const float* gates, const float* before,
                      const float* cell_tanh, const float* hidden_slopes, float* cell_slopes,
                      float* gate_slopes) {
  const float* __restrict const in = gates;
  const float* __restrict const forget = gates + size;
  const float* __restrict const added = gates + 2 * size;
  const float* __restrict const out = gates + 3 * size;
  float* __restrict const of_cell = cell_slopes;
  float* __restrict const of_in = gate_slopes;
  float* __restrict const of_forget = gate_slopes + size;
  float* __restrict const of_added = gate_slopes + 2 * size;
  float* __restrict const of_out = gate_slopes + 3 * size;
  for (std::size_t i = 0; i < size; ++i) {
    const float hidden_slope = hidden_slopes[i];
    const float slope = of_cell[i] + hidden_slope * out[i] * (1.0F - cell_tanh[i] * cell_tanh[i]);
    of_in[i] = slope * added[i] * in[i] * (1.0F - in[i]);
    of_forget[i] = slope * before[i] * forget[i] * (1.0F - forget[i]);
    of_added[i] = slope * in[i] * (1.0F - added[i] * added[i]);
    of_out[i] = hidden_slope * cell_tanh[i] * out[i] * (1.0F - out[i]);
    of_cell[i] = slope * forget[i];
  }
}

}  // namespace aquafarm::agents
