// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <vector>

#include "aquafarm/base/check.h"
#include "networks/fused.h"
#include "networks/lstm_sequence.h"

namespace aquafarm::agents {
namespace {

using torch::Tensor;
using torch::autograd::AutogradContext;
using torch::autograd::variable_list;

LstmShape ShapeOf(const Tensor& input, const Tensor& hidden_weight) {
  return {static_cast<std::size_t>(input.size(0)), static_cast<std::size_t>(input.size(1)),
          static_cast<std::size_t>(input.size(2)), static_cast<std::size_t>(hidden_weight.size(1))};
}

struct Sequence {
  Tensor gates;      // [T, B, 4H] after the activation functions
  Tensor cells;      // [T + 1, B, H]; element 0 is c before the first step
  Tensor cell_tanh;  // [T, B, H]
  Tensor output;     // [T, B, H]
};

LstmTrace TraceOf(const Tensor& gates, const Tensor& cells, const Tensor& cell_tanh,
                  const Tensor& output) {
  return {gates.data_ptr<float>(), cells.data_ptr<float>(), cell_tanh.data_ptr<float>(),
          output.data_ptr<float>()};
}

Sequence Evaluate(const Tensor& input, const Tensor& hidden, const Tensor& cell,
                  const Tensor& input_weight, const Tensor& hidden_weight, const Tensor& input_bias,
                  const Tensor& hidden_bias) {
  const LstmShape shape = ShapeOf(input, hidden_weight);
  const auto options = input.options().requires_grad(false);
  const std::int64_t steps = input.size(0);
  const std::int64_t rows = input.size(1);
  const std::int64_t size = hidden_weight.size(1);
  Sequence made{torch::empty({steps, rows, 4 * size}, options),
                torch::empty({steps + 1, rows, size}, options),
                torch::empty({steps, rows, size}, options),
                torch::empty({steps, rows, size}, options)};
  std::vector<float> bias(Data(input_bias), Data(input_bias) + shape.gates());
  for (std::size_t i = 0; i < bias.size(); ++i) bias[i] += Data(hidden_bias)[i];
  std::copy_n(Data(cell), shape.step_size(), made.cells.data_ptr<float>());
  std::vector<float> transposed(shape.hidden * shape.gates());
  LstmForward(shape, Data(input), Data(hidden),
              {Data(input_weight), Data(hidden_weight), bias.data()}, transposed.data(),
              TraceOf(made.gates, made.cells, made.cell_tanh, made.output));
  return made;
}

// Returns the last element along the first dimension. The result keeps this dimension, with size 1.
Tensor Last(const Tensor& tensor) { return tensor.narrow(0, tensor.size(0) - 1, 1); }

// Returns `slopes`, the gradient of the loss with respect to h or c after the last step, as a
// vector. An undefined tensor means that the loss does not depend on h or c; the result is then
// zeros.
std::vector<float> EndSlopes(const Tensor& slopes, std::size_t size) {
  if (!slopes.defined()) return std::vector<float>(size);
  const Tensor values = slopes.contiguous();
  return {Data(values), Data(values) + size};
}

struct LstmFunction : torch::autograd::Function<LstmFunction> {
  enum Saved {
    kInput,
    kHidden,
    kInputWeight,
    kHiddenWeight,
    kGates,
    kCells,
    kCellTanh,
    kOutput,
    kSavedCount
  };

  static variable_list forward(AutogradContext* context, const Tensor& input, const Tensor& hidden,
                               const Tensor& cell, const Tensor& input_weight,
                               const Tensor& hidden_weight, const Tensor& input_bias,
                               const Tensor& hidden_bias) {
    const Sequence made =
        Evaluate(input, hidden, cell, input_weight, hidden_weight, input_bias, hidden_bias);
    variable_list saved(kSavedCount);
    saved[kInput] = input;
    saved[kHidden] = hidden;
    saved[kInputWeight] = input_weight;
    saved[kHiddenWeight] = hidden_weight;
    saved[kGates] = made.gates;
    saved[kCells] = made.cells;
    saved[kCellTanh] = made.cell_tanh;
    saved[kOutput] = made.output;
    context->save_for_backward(saved);
    return {made.output, Last(made.output).clone(), Last(made.cells).clone()};
  }

  static variable_list backward(AutogradContext* context, const variable_list& slopes) {
    const variable_list saved = context->get_saved_variables();
    const LstmShape shape = ShapeOf(saved[kInput], saved[kHiddenWeight]);
    const std::size_t of_step = shape.step_size();
    const Tensor of_output = slopes[0].defined() ? slopes[0].contiguous() : Tensor();
    std::vector<float> hidden_slopes = EndSlopes(slopes[1], of_step);
    std::vector<float> cell_slopes = EndSlopes(slopes[2], of_step);
    std::vector<float> gate_slopes(shape.steps * of_step * 4);
    Tensor of_input = torch::empty_like(saved[kInput]);
    Tensor input_weight = torch::empty_like(saved[kInputWeight]);
    Tensor hidden_weight = torch::empty_like(saved[kHiddenWeight]);
    Tensor bias = torch::empty({saved[kHiddenWeight].size(0)}, saved[kHiddenWeight].options());
    LstmBackward(
        shape, Data(saved[kInput]), Data(saved[kHidden]),
        {Data(saved[kInputWeight]), Data(saved[kHiddenWeight]), nullptr},
        TraceOf(saved[kGates], saved[kCells], saved[kCellTanh], saved[kOutput]),
        of_output.defined() ? Data(of_output) : nullptr, hidden_slopes.data(), cell_slopes.data(),
        gate_slopes.data(),
        {input_weight.data_ptr<float>(), hidden_weight.data_ptr<float>(), bias.data_ptr<float>()},
        of_input.data_ptr<float>());
    const auto to_state = [&](const std::vector<float>& values) {
      return torch::tensor(values).view(saved[kHidden].sizes());
    };
    return {of_input,     to_state(hidden_slopes), to_state(cell_slopes),
            input_weight, hidden_weight,           bias,
            bias.clone()};
  }
};

}  // namespace

std::tuple<Tensor, Tensor, Tensor> FusedLstm(const Tensor& input, const Tensor& hidden,
                                             const Tensor& cell, const Tensor& input_weight,
                                             const Tensor& hidden_weight, const Tensor& input_bias,
                                             const Tensor& hidden_bias) {
  AQUAFARM_CHECK_EQ(input.dim(), 3);
  AQUAFARM_CHECK_EQ(input.size(2), input_weight.size(1));
  for (const Tensor& state : {hidden, cell}) {
    AQUAFARM_CHECK_EQ(state.numel(), input.size(1) * hidden_weight.size(1));
    AQUAFARM_CHECK_EQ(CanFuse(state, hidden_weight), true);
  }
  const Tensor values = input.contiguous();
  const Tensor hidden_values = hidden.contiguous();
  const Tensor cell_values = cell.contiguous();
  if (!torch::GradMode::is_enabled()) {
    const Sequence made = Evaluate(values, hidden_values, cell_values, input_weight, hidden_weight,
                                   input_bias, hidden_bias);
    return {made.output, Last(made.output), Last(made.cells)};
  }
  const variable_list outputs = LstmFunction::apply(
      values, hidden_values, cell_values, input_weight, hidden_weight, input_bias, hidden_bias);
  return {outputs[0], outputs[1], outputs[2]};
}

}  // namespace aquafarm::agents
