// SPDX-License-Identifier: BSD-3-Clause
#include "networks/fused_values.h"

#include <algorithm>

#include "aquafarm/base/check.h"
#include "networks/fused_parts.h"

namespace aquafarm::agents {
namespace {

float* Grow(std::vector<float>& buffer, std::size_t size) {
  if (buffer.size() < size) buffer.resize(size);
  return buffer.data();
}

}  // namespace

const float* HiddenAndHead::Forward(std::size_t rows, const float* in, const float* parameters) {
  float* const out = Grow(out_, rows * hidden_);
  LinearForward(rows, inputs_, hidden_, in, parameters, parameters + inputs_ * hidden_, out);
  Rectify(rows * hidden_, out);
  const float* const weight = parameters + head();
  const float* const bias = weight + hidden_ * kActionCount;
  float* const values = Grow(values_, rows * kActionCount);
  LinearForward(rows, hidden_, kActionCount, out, weight, bias, values);
  if (!dueling_) return values;
  const float* const of_state = bias + kActionCount;
  float* const state_values = Grow(state_values_, rows);
  LinearForward(rows, hidden_, 1, out, of_state, of_state + hidden_, state_values);
  AddStateValue(rows, kActionCount, state_values, values);
  return values;
}

float* HiddenAndHead::Backward(std::size_t rows, const float* slopes, const float* in,
                               const ParameterMemory& parameters) {
  const std::size_t weight = head();
  const std::size_t bias = weight + hidden_ * kActionCount;
  float* const gradient = parameters.gradient;
  float* const out_slopes = Grow(out_slopes_, rows * hidden_);
  float beta = 0.0F;
  if (dueling_) {
    const std::size_t of_state = bias + kActionCount;
    float* const advantage_slopes = Grow(value_slopes_, rows * kActionCount);
    std::copy_n(slopes, rows * kActionCount, advantage_slopes);
    float* const state_slopes = Grow(state_value_slopes_, rows);
    SplitStateValue(rows, kActionCount, advantage_slopes, state_slopes);
    LinearGradient(rows, hidden_, 1, out_.data(), state_slopes, gradient + of_state,
                   gradient + of_state + hidden_);
    LinearInputSlopes(rows, hidden_, 1, state_slopes, parameters.values + of_state, 0.0F,
                      out_slopes);
    slopes = advantage_slopes;
    beta = 1.0F;
  }
  LinearGradient(rows, hidden_, kActionCount, out_.data(), slopes, gradient + weight,
                 gradient + bias);
  LinearInputSlopes(rows, hidden_, kActionCount, slopes, parameters.values + weight, beta,
                    out_slopes);
  BackwardRelu(rows * hidden_, out_.data(), out_slopes);
  LinearGradient(rows, inputs_, hidden_, in, out_slopes, gradient, gradient + inputs_ * hidden_);
  float* const in_slopes = Grow(in_slopes_, rows * inputs_);
  LinearInputSlopes(rows, inputs_, hidden_, out_slopes, parameters.values, 0.0F, in_slopes);
  return in_slopes;
}

const float* FusedMlpValues::Forward(std::size_t rows, const float* observations) {
  seen_ = observations;
  float* const first = Grow(first_, rows * hidden_);
  LinearForward(rows, features_, hidden_, observations, parameters_.values,
                parameters_.values + features_ * hidden_, first);
  Rectify(rows * hidden_, first);
  return rest_.Forward(rows, first, parameters_.values + rest());
}

void FusedMlpValues::Backward(std::size_t rows, const float* slopes) {
  float* const first_slopes = rest_.Backward(
      rows, slopes, first_.data(), {parameters_.values + rest(), parameters_.gradient + rest()});
  BackwardRelu(rows * hidden_, first_.data(), first_slopes);
  LinearGradient(rows, features_, hidden_, seen_, first_slopes, parameters_.gradient,
                 parameters_.gradient + features_ * hidden_);
}

FusedLstmValues::FusedLstmValues(std::size_t features, std::size_t hidden, bool skip_connection,
                                 bool dueling, const ParameterMemory& parameters)
    : features_(features),
      hidden_(hidden),
      skip_connection_(skip_connection),
      parameters_(parameters),
      rest_(width(), width(), dueling),
      bias_(4 * hidden),
      transposed_(4 * hidden * hidden) {}

LstmWeights<const float> FusedLstmValues::weights() const {
  const float* const first = parameters_.values + lstm();
  return {first, first + 4 * hidden_ * hidden_, bias_.data()};
}

void FusedLstmValues::Reserve(const LstmShape& shape) {
  const std::size_t count = shape.steps * shape.rows;
  for (auto* one : {&input_, &cell_tanh_, &output_}) Grow(*one, count * hidden_);
  Grow(cells_, count * hidden_ + shape.step_size());
  Grow(gates_, count * shape.gates());
  Grow(hidden_before_, shape.step_size());
}

void FusedLstmValues::WarmUp(std::size_t steps, std::size_t rows, const float* features,
                             float* state) {
  shape_ = {steps, rows, hidden_, hidden_};
  seen_ = features;
  Reserve(shape_);
  const std::size_t count = steps * rows;
  LinearForward(count, features_, hidden_, features, parameters_.values,
                parameters_.values + features_ * hidden_, input_.data());
  Rectify(count * hidden_, input_.data());
  const float* const biases = parameters_.values + lstm() + 8 * hidden_ * hidden_;
  for (std::size_t i = 0; i < 4 * hidden_; ++i) bias_[i] = biases[i] + biases[4 * hidden_ + i];
  for (std::size_t row = 0; row < rows; ++row) {
    const float* const one = state + row * 2 * hidden_;
    std::copy_n(one, hidden_, hidden_before_.data() + row * hidden_);
    std::copy_n(one + hidden_, hidden_, cells_.data() + row * hidden_);
  }
  LstmForward(shape_, input_.data(), hidden_before_.data(), weights(), transposed_.data(), trace());
  const std::size_t last = (steps - 1) * shape_.step_size();
  for (std::size_t row = 0; row < rows; ++row) {
    float* const one = state + row * 2 * hidden_;
    std::copy_n(output_.data() + last + row * hidden_, hidden_, one);
    std::copy_n(cells_.data() + last + shape_.step_size() + row * hidden_, hidden_, one + hidden_);
  }
}

const float* FusedLstmValues::Forward(std::size_t steps, std::size_t rows, const float* features,
                                      float* state) {
  WarmUp(steps, rows, features, state);
  const std::size_t count = steps * rows;
  const float* joined = output_.data();
  if (skip_connection_) {
    float* to = Grow(joined_, count * width());
    joined = to;
    for (std::size_t row = 0; row < count; ++row) {
      to = std::copy_n(output_.data() + row * hidden_, hidden_, to);
      to = std::copy_n(input_.data() + row * hidden_, hidden_, to);
    }
  }
  return rest_.Forward(count, joined, parameters_.values + rest());
}

void FusedLstmValues::Backward(std::size_t count, const float* slopes) {
  LstmShape shape = shape_;
  if (shape.steps == 1) {
    shape.rows = count;
  } else {
    shape.steps = count / shape.rows;
    AQUAFARM_CHECK_EQ(shape.steps * shape.rows, count);
  }
  float* const gradient = parameters_.gradient;
  const float* const joined_slopes =
      rest_.Backward(count, slopes, skip_connection_ ? joined_.data() : output_.data(),
                     {parameters_.values + rest(), gradient + rest()});
  const float* output_slopes = joined_slopes;
  if (skip_connection_) {
    float* to = Grow(output_slopes_, count * hidden_);
    output_slopes = to;
    for (std::size_t row = 0; row < count; ++row) {
      to = std::copy_n(joined_slopes + row * width(), hidden_, to);
    }
  }
  for (auto* one : {&hidden_slopes_, &cell_slopes_}) {
    std::fill_n(Grow(*one, shape.step_size()), shape.step_size(), 0.0F);
  }
  float* const input_slopes = Grow(input_slopes_, count * hidden_);
  float* const of_lstm = gradient + lstm();
  float* const of_bias = of_lstm + 8 * hidden_ * hidden_;
  LstmBackward(shape, input_.data(), hidden_before_.data(), weights(), trace(), output_slopes,
               hidden_slopes_.data(), cell_slopes_.data(),
               Grow(gate_slopes_, count * shape.gates()),
               {of_lstm, of_lstm + 4 * hidden_ * hidden_, of_bias}, input_slopes);
  std::copy_n(of_bias, 4 * hidden_, of_bias + 4 * hidden_);  // both biases have the same gradient
  if (skip_connection_) {
    for (std::size_t row = 0; row < count; ++row) {
      const float* const of_skip = joined_slopes + row * width() + hidden_;
      for (std::size_t i = 0; i < hidden_; ++i) input_slopes[row * hidden_ + i] += of_skip[i];
    }
  }
  BackwardRelu(count * hidden_, input_.data(), input_slopes);
  LinearGradient(count, features_, hidden_, seen_, input_slopes, gradient,
                 gradient + features_ * hidden_);
}

}  // namespace aquafarm::agents
