// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Differentiable functions of libtorch tensors. Each function computes several layers, with the
/// matrix products of gemm.h. In libtorch, each layer consists of separate operations, whose
/// overhead is as large as their arithmetic for small batches (docs/decisions/fused_layers.md). All
/// tensors are floats in the memory of the CPU.

#include <torch/torch.h>

#include <tuple>

namespace aquafarm::agents {

/// Returns the values of a contiguous tensor of floats.
inline const float* Data(const torch::Tensor& tensor) { return tensor.data_ptr<float>(); }

/// Returns whether `input` and `weight` are floats in the memory of the CPU. The functions below
/// require such tensors. They throw LogicError if the size of an input or state does not fit the
/// weights.
bool CanFuse(const torch::Tensor& input, const torch::Tensor& weight);

/// Returns head(ReLU(Linear(ReLU(Linear(input))))) with weights and biases as in torch::nn::Linear.
/// The head is V + A − mean A if `value_weight` is defined, else A.
/// @param input [..., F]
/// @returns Q [..., actions]
torch::Tensor FusedMlp(const torch::Tensor& input, const torch::Tensor& first_weight,
                       const torch::Tensor& first_bias, const torch::Tensor& second_weight,
                       const torch::Tensor& second_bias, const torch::Tensor& advantage_weight,
                       const torch::Tensor& advantage_bias, const torch::Tensor& value_weight,
                       const torch::Tensor& value_bias);

/// Evaluates an LSTM of one layer with H units on B sequences of T steps, with weights as in
/// torch::nn::LSTM.
/// @param input [T, B, F] @param hidden, cell [1, B, H] state before the first step
/// @param input_weight [4H, F] @param hidden_weight [4H, H] @param input_bias, hidden_bias [4H]
/// @returns h of each step [T, B, H], and h and c after the last step, each [1, B, H]
std::tuple<torch::Tensor, torch::Tensor, torch::Tensor> FusedLstm(
    const torch::Tensor& input, const torch::Tensor& hidden, const torch::Tensor& cell,
    const torch::Tensor& input_weight, const torch::Tensor& hidden_weight,
    const torch::Tensor& input_bias, const torch::Tensor& hidden_bias);

}  // namespace aquafarm::agents
