// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/learning/replay.h"

#include <algorithm>

#include "aquafarm/base/check.h"
#include "learning/saved_numbers.h"

namespace aquafarm::agents {
namespace {

/// Position of the stored time steps in the ring, as saved.
struct Place {
  std::uint64_t oldest{};
  std::uint64_t size{};
};

template <typename Self, typename Visit>
void VisitPlace(Self& place, const Visit& visit) {
  visit("oldest", place.oldest);
  visit("size", place.size);
}

}  // namespace

SumTree::SumTree(std::size_t leaves) : leaves_(1) {
  while (leaves_ < leaves) leaves_ *= 2;
  nodes_.assign(2 * leaves_, 0.0F);
}

void SumTree::Set(std::size_t leaf, float priority) {
  std::size_t node = leaves_ + leaf;
  nodes_[node] = priority;
  // Sums are recomputed instead of adjusted, so that rounding errors do not accumulate.
  for (node /= 2; node >= 1; node /= 2) nodes_[node] = nodes_[2 * node] + nodes_[2 * node + 1];
}

std::size_t SumTree::Find(float mass) const {
  std::size_t node = 1;
  while (node < leaves_) {
    node *= 2;
    if (mass >= nodes_[node] && nodes_[node + 1] > 0.0F) mass -= nodes_[node++];
  }
  return node - leaves_;
}

template <typename Scalar>
Replay<Scalar>::Replay(const ReplayOptions& options)
    : options_(options), max_size_(std::max<std::size_t>(2, options.capacity / options.slots)) {
  const std::size_t all = rows();
  observations_.resize(all * options_.observation_size);
  recurrent_state_.resize(all * options_.recurrent_size);
  rewards_.resize(all);
  legal_.resize(all);
  actions_.resize(all);
  end_reasons_.resize(all);
  is_first_.resize(all);
}

template <typename Scalar>
void Replay<Scalar>::Add(const StepResults& results, const Scalar* observations,
                         const float* recurrent_state) {
  if (size_ == max_size_) {
    oldest_ = (oldest_ + 1) % max_size_;
  } else {
    ++size_;
  }
  const std::size_t row = Row(size_ - 1, 0);
  const std::size_t slots = options_.slots;
  std::copy_n(observations, slots * options_.observation_size,
              observations_.data() + row * options_.observation_size);
  if (options_.recurrent_size > 0) {
    std::copy_n(recurrent_state, slots * options_.recurrent_size,
                recurrent_state_.data() + row * options_.recurrent_size);
  }
  std::copy_n(results.rewards.data(), slots, rewards_.data() + row);
  std::copy_n(results.legal.data(), slots, legal_.data() + row);
  for (std::size_t i = 0; i < slots; ++i) {
    const std::size_t farm = i / static_cast<std::size_t>(options_.agents);
    // An inactive agent is done, even if the episode of its farm continues.
    constexpr auto kDone = static_cast<std::uint8_t>(EndReason::kAllRetrieved);
    end_reasons_[row + i] = results.active[i] != 0 ? results.end_reasons[farm] : kDone;
    is_first_[row + i] = results.is_first[farm];
  }
}

template <typename Scalar>
void Replay<Scalar>::SetActions(const std::vector<std::uint8_t>& actions) {
  AQUAFARM_CHECK_EQ(actions.size(), options_.slots);
  std::copy(actions.begin(), actions.end(), actions_.data() + Row(size_ - 1, 0));
}

template <typename Scalar>
Transition Replay<Scalar>::At(std::size_t age, std::size_t slot, std::size_t steps,
                              float discount) const {
  Transition transition;
  transition.from = Row(age, slot);
  transition.action = actions_[transition.from];
  transition.discount = 1.0F;
  for (std::size_t k = 1; k <= steps; ++k) {
    const std::size_t row = Row(age + k, slot);
    // If the farms were lost, the transition ends at the previous time step.
    if (k > 1 && is_first(row)) break;
    transition.reward += transition.discount * rewards_[row];
    transition.discount *= discount;
    transition.to = row;
    const EndReason reason = this->reason(row);
    if (IsTerminated(reason)) transition.discount = 0.0F;
    if (reason != EndReason::kNone) break;
  }
  return transition;
}

template <typename Scalar>
JointTransition Replay<Scalar>::JointAt(std::size_t age, std::size_t first, std::size_t steps,
                                        float discount, float* rewards) const {
  const auto agents = static_cast<std::size_t>(options_.agents);
  JointTransition transition;
  transition.discount = 1.0F;
  std::fill_n(rewards, agents, 0.0F);
  for (std::size_t k = 1; k <= steps; ++k) {
    const std::size_t row = Row(age + k, first);
    if (k > 1 && is_first(row)) break;
    bool goes_on = false;
    for (std::size_t agent = 0; agent < agents; ++agent) {
      rewards[agent] += transition.discount * rewards_[row + agent];
      goes_on = goes_on || reason(row + agent) == EndReason::kNone;
    }
    transition.discount *= discount;
    transition.to = row;
    if (!goes_on) break;
  }
  return transition;
}

template <typename Scalar>
std::size_t Replay<Scalar>::bytes() const {
  const auto of = [](const auto& values) { return values.size() * sizeof(values[0]); };
  return of(observations_) + of(recurrent_state_) + of(rewards_) + of(legal_) + of(actions_) +
         of(end_reasons_) + of(is_first_);
}

template <typename Scalar>
void Replay<Scalar>::Save(Checkpoint& checkpoint) const {
  const Place place{oldest_, size_};
  SaveNumbers(checkpoint, "replay", [&place](const auto& visit) { VisitPlace(place, visit); });
  checkpoint.LendArray("replay.observations", observations_);
  checkpoint.LendArray("replay.carry", recurrent_state_);
  checkpoint.LendArray("replay.rewards", rewards_);
  checkpoint.LendArray("replay.legal", legal_);
  checkpoint.LendArray("replay.actions", actions_);
  checkpoint.LendArray("replay.reasons", end_reasons_);
  checkpoint.LendArray("replay.started", is_first_);
}

template <typename Scalar>
void Replay<Scalar>::Load(const Checkpoint& checkpoint) {
  Place place;
  LoadNumbers<std::uint64_t>(checkpoint, "replay", "replay.place",
                             [&place](const auto& visit) { VisitPlace(place, visit); });
  if (place.oldest >= max_size_ || place.size > max_size_) {
    throw InputError(
        "checkpoint: section 'replay': a number is out of range; use another checkpoint");
  }
  checkpoint.GetArray("replay.observations", observations_.size(), observations_);
  checkpoint.GetArray("replay.carry", recurrent_state_.size(), recurrent_state_);
  checkpoint.GetArray("replay.rewards", rewards_.size(), rewards_);
  checkpoint.GetArray("replay.legal", legal_.size(), legal_);
  checkpoint.GetArray("replay.actions", actions_.size(), actions_);
  checkpoint.GetArray("replay.reasons", end_reasons_.size(), end_reasons_);
  checkpoint.GetArray("replay.started", is_first_.size(), is_first_);
  oldest_ = place.oldest;
  size_ = place.size;
}

template class Replay<float>;
template class Replay<std::uint8_t>;

}  // namespace aquafarm::agents
