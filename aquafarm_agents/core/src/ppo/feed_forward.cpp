// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/feed_forward.h"

#include "ppo/ppo_loss.h"

namespace aquafarm::agents {
FeedForward::FeedForward(std::size_t features, std::size_t hidden, const WeightOrigin& origin)
    : first_{origin.begin, features, hidden},
      second_{first_.end(), hidden, hidden},
      head_{second_.end(), hidden, kActorCriticOutputs} {
  weights_.resize(head_.end());
  gradient_.resize(head_.end());
  WeightDrawer drawer(origin);
  drawer.Draw(first_, weights_);
  drawer.Draw(second_, weights_);
  drawer.DrawHead(head_, weights_);
}

const float* FeedForward::Forward(const SequenceRows& rows, float*) {
  const std::size_t count = rows.rows();
  Reserve(count);
  first_.ForwardRelu(weights_, count, rows.features, first_out_.data());
  second_.ForwardRelu(weights_, count, first_out_.data(), second_out_.data());
  head_.Forward(weights_, count, second_out_.data(), outputs_.data());
  return outputs_.data();
}

void FeedForward::Backward(const SequenceRows& rows, const float* slopes) {
  const std::size_t count = rows.rows();
  head_.AddGradient(count, second_out_.data(), slopes, gradient_);
  head_.BackwardInput(weights_, count, slopes, second_slopes_.data());
  BackwardRelu(count * second_.outputs, second_out_.data(), second_slopes_.data());
  second_.AddGradient(count, first_out_.data(), second_slopes_.data(), gradient_);
  second_.BackwardInput(weights_, count, second_slopes_.data(), first_slopes_.data());
  BackwardRelu(count * first_.outputs, first_out_.data(), first_slopes_.data());
  first_.AddGradient(count, rows.features, first_slopes_.data(), gradient_);
}

void FeedForward::Reserve(std::size_t rows) {
  if (outputs_.size() >= rows * kActorCriticOutputs) return;
  outputs_.resize(rows * kActorCriticOutputs);
  for (auto* one : {&first_out_, &second_out_, &first_slopes_, &second_slopes_}) {
    one->resize(rows * first_.outputs);
  }
}

}  // namespace aquafarm::agents
