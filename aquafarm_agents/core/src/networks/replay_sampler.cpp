// SPDX-License-Identifier: BSD-3-Clause
#include "networks/replay_sampler.h"

#include <algorithm>
#include <cmath>

namespace aquafarm::agents {
namespace {

constexpr float kSmallestPriority = 1e-4F;
constexpr const char* kLargest = "priorities.largest";

}  // namespace

template <typename Scalar>
ReplaySampler<Scalar>::ReplaySampler(const Replay<Scalar>& replay, const DeepOptions& options,
                                     std::size_t steps, std::size_t group)
    : replay_(replay),
      priority_(options.priority_exponent),
      importance_(options.importance_exponent),
      steps_(steps),
      group_(group),
      beginnings_(replay.rows()),
      weights_(static_cast<std::size_t>(options.batch_size), 1.0F) {
  if (priority_ > 0.0) priorities_ = std::make_unique<SumTree>(replay.rows());
}

template <typename Scalar>
void ReplaySampler<Scalar>::Add() {
  for (std::size_t slot = 0; slot < replay_.slots(); slot += group_) {
    Mark(replay_.Row(replay_.size() - 1, slot), false);  // the row may have held an older time step
    if (replay_.size() <= steps_) continue;
    const std::size_t age = replay_.size() - 1 - steps_;
    Mark(replay_.Row(age, slot), Begins(age, slot));
  }
}

template <typename Scalar>
void ReplaySampler<Scalar>::Mark(std::size_t row, bool begins) {
  beginning_count_ -= beginnings_[row];
  beginning_count_ += begins ? 1 : 0;
  beginnings_[row] = begins ? 1 : 0;
  if (priorities_) priorities_->Set(row, begins ? largest_priority_ : 0.0F);
}

template <typename Scalar>
bool ReplaySampler<Scalar>::IsReady() const {
  return beginning_count_ > 0 && (!priorities_ || priorities_->Total() > 0.0F);
}

template <typename Scalar>
TransitionIndex ReplaySampler<Scalar>::Draw(RandomStream& rng, std::size_t i) {
  if (priorities_) {
    const float total = priorities_->Total();
    const float part = (static_cast<float>(i) + rng.Unit()) / static_cast<float>(weights_.size());
    const std::size_t row = priorities_->Find(part * total);
    weights_[i] = priorities_->Get(row) / total;
    return {replay_.Age(row), row % replay_.slots()};
  }
  const auto moments = static_cast<std::uint32_t>(replay_.size() - steps_);
  for (;;) {  // terminates, because IsReady() holds
    const std::size_t age = rng.Below(moments);
    const std::size_t slot =
        group_ * rng.Below(static_cast<std::uint32_t>(replay_.slots() / group_));
    if (Begins(age, slot)) return {age, slot};
  }
}

template <typename Scalar>
const std::vector<float>& ReplaySampler<Scalar>::ImportanceWeights(double progress) {
  if (!priorities_) return weights_;
  const double exponent = importance_ + (1.0 - importance_) * progress;
  float largest = 0.0F;
  for (float& weight : weights_) {
    weight = static_cast<float>(std::pow(static_cast<double>(weight), -exponent));
    largest = std::max(largest, weight);
  }
  for (float& weight : weights_) weight /= largest;
  return weights_;
}

template <typename Scalar>
void ReplaySampler<Scalar>::UpdatePriority(std::size_t row, float error) {
  if (!priorities_) return;
  const float priority = std::pow(error + kSmallestPriority, static_cast<float>(priority_));
  largest_priority_ = std::max(largest_priority_, priority);
  priorities_->Set(row, priority);
}

template <typename Scalar>
void ReplaySampler<Scalar>::Save(Checkpoint& checkpoint) const {
  if (!priorities_) return;
  std::vector<float> priorities;
  for (std::size_t row = 0; row < replay_.rows(); ++row) {
    priorities.push_back(priorities_->Get(row));
  }
  checkpoint.SetArray("priorities", priorities);
  checkpoint.SetArray(kLargest, std::vector<float>{largest_priority_});
}

template <typename Scalar>
void ReplaySampler<Scalar>::Load(const Checkpoint& checkpoint) {
  std::fill(beginnings_.begin(), beginnings_.end(), std::uint8_t{0});
  beginning_count_ = 0;
  for (std::size_t age = 0; age < replay_.size(); ++age) {
    for (std::size_t slot = 0; slot < replay_.slots(); slot += group_) {
      Mark(replay_.Row(age, slot), Begins(age, slot));
    }
  }
  if (!priorities_) return;
  std::vector<float> priorities;
  std::vector<float> largest;
  // In older checkpoints the largest priority is the last element of `priorities`.
  const bool is_apart = checkpoint.Has(kLargest);
  checkpoint.GetArray("priorities", replay_.rows() + (is_apart ? 0 : 1), priorities);
  if (is_apart) checkpoint.GetArray(kLargest, 1, largest);
  for (std::size_t row = 0; row < replay_.rows(); ++row) priorities_->Set(row, priorities[row]);
  largest_priority_ = is_apart ? largest[0] : priorities.back();
}

template class ReplaySampler<float>;
template class ReplaySampler<std::uint8_t>;

}  // namespace aquafarm::agents
