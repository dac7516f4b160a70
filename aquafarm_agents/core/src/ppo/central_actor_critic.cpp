// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/central_actor_critic.h"

#include <algorithm>
#include <utility>

#include "aquafarm/base/check.h"
#include "ppo/ppo_loss.h"

namespace aquafarm::agents {
namespace {

constexpr std::size_t kValue = kActionCount;  // index of the value among the outputs

/// Swaps two vectors, and swaps them back in its destructor.
class Loan {
 public:
  Loan(std::vector<float>& own, std::vector<float>& other) : own_(own), other_(other) {
    std::swap(own_, other_);
  }
  ~Loan() { std::swap(own_, other_); }
  Loan(const Loan&) = delete;
  Loan& operator=(const Loan&) = delete;

 private:
  std::vector<float>& own_;
  std::vector<float>& other_;
};

}  // namespace

CentralActorCritic::CentralActorCritic(std::size_t agents, std::unique_ptr<ActorCritic> policy,
                                       std::unique_ptr<ActorCritic> critic)
    : agents_(agents),
      policy_{std::move(policy), {}, {}, {}},
      critic_{std::move(critic), {}, {}, {}},
      policy_size_(policy_.network->weights().size()) {
  weights_ = std::move(critic_.network->weights());
  AQUAFARM_CHECK_LT(policy_size_, weights_.size());
  std::copy(policy_.network->weights().begin(), policy_.network->weights().end(), weights_.begin());
  gradient_.resize(weights_.size());
}

// Both networks use weights_ and gradient_. Each network uses only its own part of them.
const float* CentralActorCritic::ForwardPart(Part& part, const SequenceRows& rows,
                                             bool needs_state) {
  const Loan weights(weights_, part.network->weights());
  part.state_after.resize(part.state.size());
  return part.network->Forward(RowsOf(part, rows), needs_state ? part.state_after.data() : nullptr);
}

void CentralActorCritic::BackwardPart(Part& part, const SequenceRows& rows) {
  const Loan weights(weights_, part.network->weights());
  const Loan gradient(gradient_, part.network->gradient());
  part.network->Backward(RowsOf(part, rows), part.slopes.data());
}

SequenceRows CentralActorCritic::RowsOf(const Part& part, const SequenceRows& rows) const {
  SequenceRows own = rows;
  own.state = part.state.data();
  if (&part == &critic_) own.features = rows.joint;
  return own;
}

const float* CentralActorCritic::Forward(const SequenceRows& rows, float* state_after) {
  SplitStates(rows);
  const bool needs_state = state_after != nullptr;
  const float* const logits = ForwardPart(policy_, rows, needs_state);
  const float* const values = ForwardPart(critic_, rows, needs_state);
  outputs_.assign(logits, logits + rows.rows() * kActorCriticOutputs);
  for (std::size_t i = kValue; i < outputs_.size(); i += kActorCriticOutputs) {
    outputs_[i] = values[i];
  }
  if (needs_state) JoinStates(rows.sequences, state_after);
  return outputs_.data();
}

void CentralActorCritic::Backward(const SequenceRows& rows, const float* slopes) {
  const std::size_t size = rows.rows() * kActorCriticOutputs;
  policy_.slopes.assign(slopes, slopes + size);
  critic_.slopes.assign(size, 0.0F);
  for (std::size_t i = kValue; i < size; i += kActorCriticOutputs) {
    std::swap(policy_.slopes[i], critic_.slopes[i]);
  }
  BackwardPart(policy_, rows);
  BackwardPart(critic_, rows);
}

void CentralActorCritic::SplitStates(const SequenceRows& rows) {
  const std::size_t size = policy_.network->state_size();
  for (Part* part : {&policy_, &critic_}) part->state.resize(rows.sequences * size);
  if (size == 0) return;
  for (std::size_t s = 0; s < rows.sequences; ++s) {
    const float* const both = rows.state + s * 2 * size;
    std::copy_n(both, size, policy_.state.data() + s * size);
    std::copy_n(both + size, size, critic_.state.data() + s * size);
  }
}

void CentralActorCritic::JoinStates(std::size_t sequences, float* state_after) const {
  const std::size_t size = policy_.network->state_size();
  for (std::size_t s = 0; s < sequences; ++s) {
    float* const both = state_after + s * 2 * size;
    std::copy_n(policy_.state_after.data() + s * size, size, both);
    std::copy_n(critic_.state_after.data() + s * size, size, both + size);
  }
}

void JoinObservations(const float* farm, std::size_t agents, std::size_t features,
                      std::size_t agent, float* joint) {
  joint = std::copy_n(farm + agent * features, features, joint);
  joint = std::copy_n(farm, agent * features, joint);
  std::copy_n(farm + (agent + 1) * features, (agents - agent - 1) * features, joint);
}

}  // namespace aquafarm::agents
