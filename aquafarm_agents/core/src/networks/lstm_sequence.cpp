// SPDX-License-Identifier: BSD-3-Clause
#include "networks/lstm_sequence.h"

#include "networks/fused_parts.h"
#include "networks/lstm_cell.h"

namespace aquafarm::agents {

void LstmForward(const LstmShape& shape, const float* in, const float* hidden,
                 const LstmWeights<const float>& weights, float* transposed,
                 const LstmTrace& trace) {
  const std::size_t of_step = shape.step_size();
  LinearForward(shape.steps * shape.rows, shape.inputs, shape.gates(), in, weights.input,
                weights.bias, trace.gates);
  if (shape.steps > 1) Transpose(shape.gates(), shape.hidden, weights.hidden, transposed);
  for (std::size_t step = 0; step < shape.steps; ++step) {
    float* const gates = trace.gates + step * 4 * of_step;
    if (shape.steps > 1) {
      Multiply(shape.rows, shape.gates(), shape.hidden, hidden, transposed, 1.0F, gates);
    } else {
      MultiplyByTransposed(shape.rows, shape.gates(), shape.hidden, hidden, weights.hidden, 1.0F,
                           gates);
    }
    float* const output = trace.output + step * of_step;
    float* const cells = trace.cells + step * of_step;
    for (std::size_t at = 0; at < of_step; at += shape.hidden) {
      LstmCellForward(shape.hidden, gates + 4 * at, cells + at, cells + of_step + at,
                      trace.cell_tanh + step * of_step + at, output + at);
    }
    hidden = output;
  }
}

void LstmBackward(const LstmShape& shape, const float* in, const float* hidden,
                  const LstmWeights<const float>& weights, const LstmTrace& trace,
                  const float* output_slopes, float* hidden_slopes, float* cell_slopes,
                  float* gate_slopes, const LstmWeights<float>& gradient, float* in_slopes) {
  const std::size_t rows = shape.steps * shape.rows;
  const std::size_t of_step = shape.step_size();
  for (std::size_t step = shape.steps; step-- > 0;) {
    const std::size_t first = step * of_step;
    if (output_slopes != nullptr) {
      for (std::size_t i = 0; i < of_step; ++i) hidden_slopes[i] += output_slopes[first + i];
    }
    for (std::size_t at = 0; at < of_step; at += shape.hidden) {
      LstmCellBackward(shape.hidden, trace.gates + 4 * (first + at), trace.cells + first + at,
                       trace.cell_tanh + first + at, hidden_slopes + at, cell_slopes + at,
                       gate_slopes + 4 * (first + at));
    }
    LinearInputSlopes(shape.rows, shape.hidden, shape.gates(), gate_slopes + 4 * first,
                      weights.hidden, 0.0F, hidden_slopes);
  }
  LinearInputSlopes(rows, shape.inputs, shape.gates(), gate_slopes, weights.input, 0.0F, in_slopes);
  LinearGradient(rows, shape.inputs, shape.gates(), in, gate_slopes, gradient.input, gradient.bias);
  // h before the first step is `hidden`; h before each other step is the output of the previous
  // step.
  MultiplyTransposed(shape.gates(), shape.hidden, shape.rows, gate_slopes, hidden, 0.0F,
                     gradient.hidden);
  if (shape.steps == 1) return;
  MultiplyTransposed(shape.gates(), shape.hidden, rows - shape.rows, gate_slopes + 4 * of_step,
                     trace.output, 1.0F, gradient.hidden);
}

}  // namespace aquafarm::agents
