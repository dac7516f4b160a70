// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/lstm_actor_critic.h"

#include <Eigen/Core>
#include <algorithm>

#include "networks/lstm_cell.h"
#include "ppo/ppo_loss.h"

namespace aquafarm::agents {
namespace {

constexpr std::size_t kGates = 4;    // in the order i, f, g, o
constexpr float kForgetBias = 1.0F;  // added to the initial bias of f, so that c persists at first

Eigen::Map<Eigen::ArrayXf> At(std::vector<float>& values, std::size_t begin, std::size_t size) {
  return {values.data() + begin, static_cast<Eigen::Index>(size)};
}

}  // namespace

LstmActorCritic::LstmActorCritic(std::size_t features, std::size_t hidden,
                                 const WeightOrigin& origin)
    : hidden_(hidden),
      first_{origin.begin, features, hidden},
      gates_{first_.end(), hidden, kGates * hidden},
      recurrent_{gates_.end(), hidden, kGates * hidden},
      head_{recurrent_.bias(), 2 * hidden, kActorCriticOutputs} {
  weights_.resize(std::max(head_.end(), recurrent_.end()));
  WeightDrawer drawer(origin);
  for (const Linear* layer : {&first_, &gates_, &recurrent_}) drawer.Draw(*layer, weights_);
  weights_.resize(head_.end());  // the recurrent matrix has no bias
  drawer.DrawHead(head_, weights_);
  for (std::size_t i = 0; i < hidden; ++i) weights_[gates_.bias() + hidden + i] += kForgetBias;
  gradient_.resize(weights_.size());
  recurrent_transposed_.resize(kGates * hidden * hidden);
}

void LstmActorCritic::Reserve(const SequenceRows& rows) {
  const std::size_t count = rows.rows();
  if (outputs_.size() < count * kActorCriticOutputs) {
    outputs_.resize(count * kActorCriticOutputs);
    for (auto* one : {&seen_, &hidden_before_, &cell_before_, &cell_tanh_, &seen_slopes_}) {
      one->resize(count * hidden_);
    }
    for (auto* one : {&gate_values_, &gate_slopes_}) one->resize(count * kGates * hidden_);
    for (auto* one : {&joined_, &joined_slopes_}) one->resize(count * 2 * hidden_);
  }
  for (auto* one : {&hidden_now_, &cell_now_, &hidden_slopes_, &cell_slopes_}) {
    one->resize(rows.sequences * hidden_);
  }
}

void LstmActorCritic::LoadState(const SequenceRows& rows) {
  for (std::size_t s = 0; s < rows.sequences; ++s) {
    const float* const state = rows.state + s * state_size();
    std::copy_n(state, hidden_, hidden_now_.data() + s * hidden_);
    std::copy_n(state + hidden_, hidden_, cell_now_.data() + s * hidden_);
  }
}

void LstmActorCritic::StepForward(const SequenceRows& rows, std::size_t step) {
  const std::size_t first = step * rows.sequences;
  for (std::size_t s = 0; s < rows.sequences; ++s) {
    if (rows.is_first[first + s] == 0) continue;
    At(hidden_now_, s * hidden_, hidden_) = 0.0F;
    At(cell_now_, s * hidden_, hidden_) = 0.0F;
  }
  const std::size_t size = rows.sequences * hidden_;
  std::copy_n(hidden_now_.data(), size, hidden_before_.data() + first * hidden_);
  std::copy_n(cell_now_.data(), size, cell_before_.data() + first * hidden_);
  float* const gates = gate_values_.data() + first * kGates * hidden_;
  Multiply(rows.sequences, kGates * hidden_, hidden_, hidden_now_.data(),
           weights_.data() + recurrent_.begin, 1.0F, gates);
  for (std::size_t s = 0; s < rows.sequences; ++s) {
    const std::size_t row = first + s;
    float* const cell = cell_now_.data() + s * hidden_;
    LstmCellForward(hidden_, gate_values_.data() + row * kGates * hidden_, cell, cell,
                    cell_tanh_.data() + row * hidden_, hidden_now_.data() + s * hidden_);
    std::copy_n(hidden_now_.data() + s * hidden_, hidden_, joined_.data() + row * 2 * hidden_);
    std::copy_n(seen_.data() + row * hidden_, hidden_,
                joined_.data() + row * 2 * hidden_ + hidden_);
  }
}

const float* LstmActorCritic::Forward(const SequenceRows& rows, float* state_after) {
  Reserve(rows);
  LoadState(rows);
  first_.ForwardRelu(weights_, rows.rows(), rows.features, seen_.data());
  gates_.Forward(weights_, rows.rows(), seen_.data(), gate_values_.data());
  for (std::size_t step = 0; step < rows.steps; ++step) StepForward(rows, step);
  head_.Forward(weights_, rows.rows(), joined_.data(), outputs_.data());
  if (state_after == nullptr) return outputs_.data();
  for (std::size_t s = 0; s < rows.sequences; ++s) {
    float* const state = state_after + s * state_size();
    std::copy_n(hidden_now_.data() + s * hidden_, hidden_, state);
    std::copy_n(cell_now_.data() + s * hidden_, hidden_, state + hidden_);
  }
  return outputs_.data();
}

void LstmActorCritic::StepBackward(const SequenceRows& rows, std::size_t step) {
  const std::size_t first = step * rows.sequences;
  for (std::size_t s = 0; s < rows.sequences; ++s) {
    const std::size_t row = first + s;
    At(hidden_slopes_, s * hidden_, hidden_) += At(joined_slopes_, row * 2 * hidden_, hidden_);
    LstmCellBackward(hidden_, gate_values_.data() + row * kGates * hidden_,
                     cell_before_.data() + row * hidden_, cell_tanh_.data() + row * hidden_,
                     hidden_slopes_.data() + s * hidden_, cell_slopes_.data() + s * hidden_,
                     gate_slopes_.data() + row * kGates * hidden_);
  }
  Multiply(rows.sequences, hidden_, kGates * hidden_,
           gate_slopes_.data() + first * kGates * hidden_, recurrent_transposed_.data(), 0.0F,
           hidden_slopes_.data());
  for (std::size_t s = 0; s < rows.sequences; ++s) {
    if (rows.is_first[first + s] == 0) continue;
    At(hidden_slopes_, s * hidden_, hidden_) = 0.0F;
    At(cell_slopes_, s * hidden_, hidden_) = 0.0F;
  }
}

void LstmActorCritic::Backward(const SequenceRows& rows, const float* slopes) {
  const std::size_t count = rows.rows();
  head_.AddGradient(count, joined_.data(), slopes, gradient_);
  head_.BackwardInput(weights_, count, slopes, joined_slopes_.data());
  std::fill(hidden_slopes_.begin(), hidden_slopes_.end(), 0.0F);
  std::fill(cell_slopes_.begin(), cell_slopes_.end(), 0.0F);
  Transpose(hidden_, kGates * hidden_, weights_.data() + recurrent_.begin,
            recurrent_transposed_.data());
  for (std::size_t step = rows.steps; step-- > 0;) StepBackward(rows, step);
  MultiplyTransposed(hidden_, kGates * hidden_, count, hidden_before_.data(), gate_slopes_.data(),
                     1.0F, gradient_.data() + recurrent_.begin);
  gates_.AddGradient(count, seen_.data(), gate_slopes_.data(), gradient_);
  gates_.BackwardInput(weights_, count, gate_slopes_.data(), seen_slopes_.data());
  for (std::size_t row = 0; row < count; ++row) {
    At(seen_slopes_, row * hidden_, hidden_) +=
        At(joined_slopes_, row * 2 * hidden_ + hidden_, hidden_);
  }
  BackwardRelu(count * hidden_, seen_.data(), seen_slopes_.data());
  first_.AddGradient(count, rows.features, seen_slopes_.data(), gradient_);
}

}  // namespace aquafarm::agents
