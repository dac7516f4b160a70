// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Layers for libtorch whose products are computed by BLAS and whose gradients are written out. For
/// the small batches of value learners, each operation of libtorch costs as much as its arithmetic
/// (docs/decisions/fused_layers.md). All tensors are floats in the memory of the CPU.

#include <torch/torch.h>

#include <tuple>

namespace aquafarm::agents {

inline const float* Data(const torch::Tensor& tensor) { return tensor.data_ptr<float>(); }

/// Returns whether the functions below accept an input and a network's weight. They throw
/// LogicError for shapes other than those in their comments.
bool CanFuse(const torch::Tensor& input, const torch::Tensor& weight);

/// Q = head(ReLU(Linear(ReLU(Linear(input))))) with weights and biases as in torch::nn::Linear. The
/// head is V + A − mean A if `value_weight` is defined, else A.
/// @param input [..., F] @returns [..., A]
torch::Tensor FusedMlp(const torch::Tensor& input, const torch::Tensor& first_weight,
                       const torch::Tensor& first_bias, const torch::Tensor& second_weight,
                       const torch::Tensor& second_bias, const torch::Tensor& advantage_weight,
                       const torch::Tensor& advantage_bias, const torch::Tensor& value_weight,
                       const torch::Tensor& value_bias);

/// An LSTM of one layer, with the weights of torch::nn::LSTM.
/// @param input [T, B, F] @param hidden, cell [1, B, H]: the state before the first step
/// @param input_weight [4H, F] @param hidden_weight [4H, H] @param input_bias, hidden_bias [4H]
/// @returns h of each step [T, B, H], and h and c after the last step, each [1, B, H]
std::tuple<torch::Tensor, torch::Tensor, torch::Tensor> FusedLstm(
    const torch::Tensor& input, const torch::Tensor& hidden, const torch::Tensor& cell,
    const torch::Tensor& input_weight, const torch::Tensor& hidden_weight,
    const torch::Tensor& input_bias, const torch::Tensor& hidden_bias);

}  // namespace aquafarm::agents
