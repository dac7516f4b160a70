// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/ppo_updater.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {
namespace {

constexpr float kErrorShare =
    0.05F;  // weight of an update in the moving average of the squared error
constexpr float kMinDeviation = 1e-6F;
constexpr std::size_t kPrefetched = 4;  // rows ahead; shuffled rows are not contiguous in memory

void Prefetch(const float* values, std::size_t count) {
  constexpr std::size_t kCacheLine = 64 / sizeof(float);
  for (std::size_t i = 0; i < count; i += kCacheLine) __builtin_prefetch(values + i);
}

}  // namespace

PpoUpdater::PpoUpdater(const PpoOptions& options, ActorCritic& network)
    : options_(options),
      network_(network),
      adam_(network.weights().size()),
      learning_rate_(options.learning_rate.At(0.0)),
      value_error_(std::nanf("")),
      length_(options.recurrent ? static_cast<std::size_t>(options.sequence_length) : 1) {}

// Returns the sequences with at least one transition.
void PpoUpdater::Collect(const Rollout& rollout) {
  const std::size_t entries = rollout.shape().entries;
  sequences_.clear();
  for (std::size_t begin = 0; begin < rollout.slots(); begin += length_ * entries) {
    for (std::size_t slot = begin; slot < begin + entries; ++slot) {
      bool is_valid = false;
      for (std::size_t t = 0; t < length_; ++t) is_valid |= rollout.IsValid(slot + t * entries);
      if (is_valid) sequences_.push_back(static_cast<std::uint32_t>(slot));
    }
  }
}

// Fisher-Yates shuffle.
void PpoUpdater::Shuffle(RandomStream& rng) {
  for (std::size_t left = sequences_.size(); left > 1; --left) {
    std::swap(sequences_[left - 1], sequences_[rng.Below(static_cast<std::uint32_t>(left))]);
  }
}

void PpoUpdater::Update(const Rollout& rollout, const Context& context, RandomStream& rng) {
  const double progress = context.progress;
  learning_rate_ = options_.learning_rate.At(progress);
  coefficients_.clip = static_cast<float>(options_.clip_range.At(progress));
  coefficients_.value_clip = static_cast<float>(options_.value_clip_range);
  coefficients_.value = static_cast<float>(options_.value_coef);
  coefficients_.entropy = static_cast<float>(options_.exploration.level.At(progress));
  teacher_coef_ = static_cast<float>(options_.teacher.At(progress));
  Collect(rollout);
  if (sequences_.empty()) return;
  const double wanted = static_cast<double>(sequences_.size() * length_) / options_.batch_size;
  const auto batches = std::min(sequences_.size(), std::max<std::size_t>(1, std::lround(wanted)));
  PpoLoss sum;
  for (std::int32_t epoch = 0; epoch < options_.epochs; ++epoch) {
    Shuffle(rng);
    for (std::size_t batch = 0; batch < batches; ++batch) {
      const std::size_t first = sequences_.size() * batch / batches;
      const std::size_t end = sequences_.size() * (batch + 1) / batches;
      const PpoLoss loss = LearnMinibatch(rollout, first, end - first);
      const double total = loss.Total(coefficients_);
      if (!std::isfinite(total)) Fail("loss: got " + std::to_string(total), context);
      if (!adam_.Step(network_.gradient(), learning_rate_, options_.max_grad_norm,
                      network_.weights())) {
        Fail("gradient: got a number that is not finite", context);
      }
      sum += loss;
    }
  }
  const double scale = options_.reward_scale * options_.reward_scale;
  const auto error = static_cast<float>(sum.square_error /
                                        (static_cast<double>(batches) * options_.epochs) / scale);
  value_error_ =
      std::isnan(value_error_) ? error : value_error_ + kErrorShare * (error - value_error_);
}

void PpoUpdater::Fail(const std::string& what, const Context& context) const {
  throw LearnerFailed("ppo: " + what + " in gradient step " + std::to_string(adam_.steps() + 1) +
                      ", after " + std::to_string(context.farm_steps) +
                      " farm steps; expected a finite number: lower learning_rate or "
                      "reward_scale");
}

void PpoUpdater::NormalizeAdvantages(const Rollout& rollout, std::size_t first, std::size_t count) {
  const std::size_t entries = rollout.shape().entries;
  double sum = 0.0;
  double squares = 0.0;
  std::size_t rows = 0;
  for (std::size_t i = first; i < first + count; ++i) {
    for (std::size_t t = 0; t < length_; ++t) {
      const std::size_t slot = sequences_[i] + t * entries;
      if (!rollout.IsValid(slot)) continue;
      const auto advantage = static_cast<double>(rollout.advantage(slot));
      sum += advantage;
      squares += advantage * advantage;
      ++rows;
    }
  }
  weight_ = 1.0F / static_cast<float>(rows);
  if (!options_.normalize_advantages) return;
  const double mean = sum / static_cast<double>(rows);
  const double variance = std::max(0.0, squares / static_cast<double>(rows) - mean * mean);
  mean_ = static_cast<float>(mean);
  inverse_deviation_ = 1.0F / (static_cast<float>(std::sqrt(variance)) + kMinDeviation);
}

PpoLoss PpoUpdater::LearnMinibatch(const Rollout& rollout, std::size_t first, std::size_t count) {
  NormalizeAdvantages(rollout, first, count);
  std::fill(network_.gradient().begin(), network_.gradient().end(), 0.0F);
  const std::size_t chunk = std::max<std::size_t>(1, network_.chunk_rows() / length_);
  PpoLoss loss;
  for (std::size_t done = 0; done < count; done += chunk) {
    loss += LearnChunk(rollout, first + done, std::min(chunk, count - done));
  }
  return loss;
}

PpoLoss PpoUpdater::LearnChunk(const Rollout& rollout, std::size_t first, std::size_t count) {
  Gather(rollout, first, count);
  SequenceRows rows;
  rows.steps = length_;
  rows.sequences = count;
  rows.features = features_.data();
  rows.state = state_.data();
  rows.started = started_.data();
  const float* const outputs = network_.Forward(rows, nullptr);
  const PpoRows recorded{masks_.data(),      actions_.data(), log_probs_.data(), values_.data(),
                         advantages_.data(), targets_.data(), weights_.data()};
  const PpoLoss loss =
      ComputeLoss(outputs, rows.rows(), recorded, coefficients_, distribution_, slopes_.data());
  if (teacher_ != nullptr && teacher_coef_ > 0.0F) {
    teacher_->AddSlopes(features_.data(), rows.rows(), masks_.data(), distribution_,
                        weights_.data(), teacher_coef_, slopes_.data());
  }
  network_.Backward(rows, slopes_.data());
  return loss;
}

void PpoUpdater::Gather(const Rollout& rollout, std::size_t first, std::size_t count) {
  const std::size_t rows = count * length_;
  const std::size_t width = rollout.shape().features;
  const std::size_t state_size = rollout.shape().state_size;
  features_.resize(rows * width);
  state_.resize(count * state_size);
  started_.resize(rows);
  masks_.resize(rows);
  actions_.resize(rows);
  slopes_.resize(rows * kActorCriticOutputs);
  for (std::vector<float>* one : {&log_probs_, &values_, &advantages_, &targets_, &weights_}) {
    one->resize(rows);
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (i + kPrefetched < count) {
      Prefetch(rollout.features(sequences_[first + i + kPrefetched]), width);
    }
    const std::size_t begin = sequences_[first + i];
    if (state_size > 0) {
      std::copy_n(rollout.state(begin), state_size, state_.data() + i * state_size);
    }
    for (std::size_t t = 0; t < length_; ++t) {
      const std::size_t slot = begin + t * rollout.shape().entries;
      const std::size_t row = t * count + i;
      std::copy_n(rollout.features(slot), width, features_.data() + row * width);
      started_[row] = rollout.started(slot) ? 1 : 0;
      masks_[row] = rollout.mask(slot);
      actions_[row] = rollout.action(slot);
      log_probs_[row] = rollout.log_prob(slot);
      values_[row] = rollout.value(slot);
      advantages_[row] = (rollout.advantage(slot) - mean_) * inverse_deviation_;
      targets_[row] = rollout.target(slot);
      weights_[row] = rollout.IsValid(slot) ? weight_ : 0.0F;
    }
  }
}

void PpoUpdater::Save(Checkpoint& checkpoint) const {
  checkpoint.SetArray("weights", network_.weights());
  adam_.Save(checkpoint);
  checkpoint.SetArray("ppo.numbers",
                      std::vector<double>{learning_rate_, static_cast<double>(value_error_)});
}

void PpoUpdater::Load(const Checkpoint& checkpoint) {
  std::vector<float> weights;
  std::vector<double> numbers;
  checkpoint.GetArray("weights", network_.weights().size(), weights);
  checkpoint.GetArray("ppo.numbers", 2, numbers);
  adam_.Load(checkpoint);
  network_.weights() = std::move(weights);
  learning_rate_ = numbers[0];
  value_error_ = static_cast<float>(numbers[1]);
}

}  // namespace aquafarm::agents
