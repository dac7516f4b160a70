// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/ppo_updater.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "aquafarm/agents/learning/learner.h"
#include "aquafarm/base/check.h"
#include "learning/moving_error.h"
#include "learning/saved_numbers.h"
#include "ppo/central_actor_critic.h"

namespace aquafarm::agents {
namespace {

constexpr float kErrorShare = 0.05F;  // weight of an update in the moving average of the error
constexpr float kMinDeviation = 1e-6F;
constexpr std::size_t kLossTerms = 5;  // members of PpoLoss
enum AdvantageSum : std::size_t { kSum, kSquares, kRows, kSums };
// Gather prefetches the features of the sequence that is this many sequences ahead. Shuffled
// sequences are scattered in memory.
constexpr std::size_t kPrefetched = 4;

void Prefetch(const float* values, std::size_t count) {
  constexpr std::size_t kCacheLine = 64 / sizeof(float);
  for (std::size_t i = 0; i < count; i += kCacheLine) __builtin_prefetch(values + i);
}

}  // namespace

PpoUpdater::PpoUpdater(const PpoOptions& options, ActorCritic& network, std::size_t shards,
                       ProcessGroup* group)
    : options_(options),
      network_(network),
      adam_(network.weights().size()),
      learning_rate_(options.learning_rate.At(0.0)),
      value_error_(std::nanf("")),
      entropy_(std::log(static_cast<float>(kActionCount))),  // the first policy is nearly uniform
      group_(group),
      sequences_(shards),
      gradients_(shards, std::vector<float>(network.weights().size())),
      losses_(shards, std::vector<double>(kLossTerms)),
      advantage_sums_(shards),
      length_(options.recurrent ? static_cast<std::size_t>(options.sequence_length) : 1) {}

// Lists in sequences_[shard] the first samples of the sequences with at least one transition.
void PpoUpdater::Collect(const Rollout& rollout, std::size_t shard) {
  const std::size_t slots = rollout.shape().slots;
  std::vector<std::uint32_t>& sequences = sequences_[shard];
  sequences.clear();
  for (std::size_t begin = 0; begin < rollout.samples(); begin += length_ * slots) {
    for (std::size_t sample = begin; sample < begin + slots; ++sample) {
      bool is_valid = false;
      for (std::size_t t = 0; t < length_; ++t) is_valid |= rollout.IsValid(sample + t * slots);
      if (is_valid) sequences.push_back(static_cast<std::uint32_t>(sample));
    }
  }
}

// Shuffles sequences_[shard] (Fisher-Yates).
void PpoUpdater::Shuffle(std::size_t shard, RandomStream& rng) {
  std::vector<std::uint32_t>& sequences = sequences_[shard];
  for (std::size_t left = sequences.size(); left > 1; --left) {
    std::swap(sequences[left - 1], sequences[rng.Below(static_cast<std::uint32_t>(left))]);
  }
}

// Returns the number of sequences in all shards of all ranks.
std::size_t PpoUpdater::CountSequences() {
  std::vector<double> count{0.0};  // exact for counts below 2^53
  for (const auto& one : sequences_) count[0] += static_cast<double>(one.size());
  if (group_ != nullptr) group_->Sum(nothing_, count);
  return static_cast<std::size_t>(count[0]);
}

// Returns which of a shard's sequences belong to a minibatch.
PpoUpdater::Range PpoUpdater::Part(std::size_t shard, std::size_t batch) const {
  const std::size_t size = sequences_[shard].size();
  const std::size_t first = size * batch / batches_;
  return {first, size * (batch + 1) / batches_ - first};
}

void PpoUpdater::Update(const std::vector<Input>& inputs, const Context& context) {
  AQUAFARM_CHECK_EQ(inputs.size(), sequences_.size());
  const double progress = context.progress;
  learning_rate_ = options_.learning_rate.At(progress);
  coefficients_.clip = static_cast<float>(options_.clip_range.At(progress));
  coefficients_.value_clip = static_cast<float>(options_.value_clip_range);
  coefficients_.value = static_cast<float>(options_.value_coef);
  coefficients_.entropy = static_cast<float>(options_.exploration.level.At(progress));
  coefficients_.imitation = static_cast<float>(options_.teacher.At(progress));
  for (std::size_t i = 0; i < inputs.size(); ++i) Collect(*inputs[i].rollout, i);
  const std::size_t sequences = CountSequences();
  if (sequences == 0) return;
  const double wanted = static_cast<double>(sequences * length_) / options_.batch_size;
  const auto batches = static_cast<std::size_t>(std::lround(wanted));
  batches_ = std::min(sequences, std::max<std::size_t>(1, batches));
  PpoLoss sum;
  std::size_t learned = 0;  // minibatches
  for (std::int32_t epoch = 0; epoch < options_.epochs; ++epoch) {
    for (std::size_t i = 0; i < inputs.size(); ++i) Shuffle(i, *inputs[i].rng);
    SumAdvantages(inputs);
    for (std::size_t batch = 0; batch < batches_; ++batch) {
      // With few sequences, rounding may leave a minibatch empty in every shard.
      if (advantage_sums_[0][batch * kSums + kRows] == 0.0) continue;
      const PpoLoss loss = LearnMinibatch(inputs, batch);
      const double total = loss.Total(coefficients_);
      if (!std::isfinite(total)) Fail("loss: got " + std::to_string(total), context);
      if (!adam_.Step(gradients_[0], learning_rate_, options_.max_grad_norm, network_.weights())) {
        Fail("gradient: got a number that is not finite", context);
      }
      sum += loss;
      ++learned;
    }
  }
  const double count = static_cast<double>(std::max<std::size_t>(1, learned));
  const double scale = options_.reward_scale * options_.reward_scale;
  const auto error = static_cast<float>(sum.square_error / count / scale);
  entropy_ = static_cast<float>(sum.entropy / count);
  value_error_ = MoveError(value_error_, error, kErrorShare);
}

void PpoUpdater::Fail(const std::string& what, const Context& context) const {
  throw LearnerFailed(std::string(options_.algorithm()) + ": " + what + " in gradient step " +
                      std::to_string(adam_.steps() + 1) + ", after " +
                      std::to_string(context.farm_steps) +
                      " farm steps; expected a finite number: lower learning_rate or "
                      "reward_scale");
}

// Sums the advantages of each minibatch of an epoch, with one exchange between the ranks.
void PpoUpdater::SumAdvantages(const std::vector<Input>& inputs) {
  for (std::size_t shard = 0; shard < inputs.size(); ++shard) {
    const Rollout& rollout = *inputs[shard].rollout;
    const std::size_t slots = rollout.shape().slots;
    advantage_sums_[shard].assign(batches_ * kSums, 0.0);
    for (std::size_t batch = 0; batch < batches_; ++batch) {
      double* const sums = advantage_sums_[shard].data() + batch * kSums;
      const Range part = Part(shard, batch);
      for (std::size_t i = part.first; i < part.first + part.count; ++i) {
        for (std::size_t t = 0; t < length_; ++t) {
          const std::size_t sample = sequences_[shard][i] + t * slots;
          if (!rollout.IsValid(sample)) continue;
          const auto advantage = static_cast<double>(rollout.advantage(sample));
          sums[kSum] += advantage;
          sums[kSquares] += advantage * advantage;
          sums[kRows] += 1.0;
        }
      }
    }
  }
  AddAsTree(advantage_sums_);
  if (group_ != nullptr) group_->Sum(nothing_, advantage_sums_[0]);
}

void PpoUpdater::NormalizeAdvantages(std::size_t batch) {
  const double* const sums = advantage_sums_[0].data() + batch * kSums;
  weight_ = 1.0F / static_cast<float>(sums[kRows]);
  if (!options_.normalize_advantages) return;
  const double mean = sums[kSum] / sums[kRows];
  const double variance = std::max(0.0, sums[kSquares] / sums[kRows] - mean * mean);
  mean_ = static_cast<float>(mean);
  inverse_deviation_ = 1.0F / (static_cast<float>(std::sqrt(variance)) + kMinDeviation);
}

// Sums the gradients of a minibatch over all shards of all ranks in gradients_[0]. Returns the sum
// of the losses.
PpoLoss PpoUpdater::LearnMinibatch(const std::vector<Input>& inputs, std::size_t batch) {
  NormalizeAdvantages(batch);
  const std::size_t chunk = std::max<std::size_t>(1, network_.chunk_rows() / length_);
  for (std::size_t shard = 0; shard < inputs.size(); ++shard) {
    std::swap(network_.gradient(), gradients_[shard]);
    std::fill(network_.gradient().begin(), network_.gradient().end(), 0.0F);
    const Range part = Part(shard, batch);
    const std::uint32_t* const sequences = sequences_[shard].data() + part.first;
    PpoLoss loss;
    for (std::size_t done = 0; done < part.count; done += chunk) {
      loss +=
          LearnChunk(*inputs[shard].rollout, sequences + done, std::min(chunk, part.count - done));
    }
    std::swap(network_.gradient(), gradients_[shard]);
    losses_[shard] = {loss.policy, loss.value, loss.entropy, loss.square_error, loss.clipped};
  }
  AddAsTree(gradients_);
  AddAsTree(losses_);
  if (group_ != nullptr) group_->Sum(gradients_[0], losses_[0]);
  const std::vector<double>& all = losses_[0];
  return {all[0], all[1], all[2], all[3], all[4]};
}

PpoLoss PpoUpdater::LearnChunk(const Rollout& rollout, const std::uint32_t* sequences,
                               std::size_t count) {
  Gather(rollout, sequences, count);
  SequenceRows rows;
  rows.steps = length_;
  rows.sequences = count;
  rows.features = features_.data();
  rows.state = state_.data();
  rows.is_first = is_first_.data();
  rows.joint = joint_.data();
  const float* const outputs = network_.Forward(rows, nullptr);
  const PpoRows recorded{masks_.data(),      actions_.data(), log_probs_.data(), values_.data(),
                         advantages_.data(), targets_.data(), weights_.data(),   labels_.data()};
  const PpoLoss loss =
      ComputeLoss(outputs, rows.rows(), recorded, coefficients_, distribution_, slopes_.data());
  network_.Backward(rows, slopes_.data());
  return loss;
}

void PpoUpdater::Gather(const Rollout& rollout, const std::uint32_t* sequences, std::size_t count) {
  const std::size_t rows = count * length_;
  const std::size_t width = rollout.shape().features;
  const std::size_t state_size = rollout.shape().state_size;
  const std::size_t joint_size = network_.joint_agents() * width;
  features_.resize(rows * width);
  joint_.resize(rows * joint_size);
  state_.resize(count * state_size);
  is_first_.resize(rows);
  masks_.resize(rows);
  actions_.resize(rows);
  labels_.resize(rows);
  slopes_.resize(rows * kActorCriticOutputs);
  for (std::vector<float>* one : {&log_probs_, &values_, &advantages_, &targets_, &weights_}) {
    one->resize(rows);
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (i + kPrefetched < count) Prefetch(rollout.features(sequences[i + kPrefetched]), width);
    const std::size_t begin = sequences[i];
    if (state_size > 0) {
      std::copy_n(rollout.state(begin), state_size, state_.data() + i * state_size);
    }
    for (std::size_t t = 0; t < length_; ++t) {
      const std::size_t sample = begin + t * rollout.shape().slots;
      const std::size_t row = t * count + i;
      std::copy_n(rollout.features(sample), width, features_.data() + row * width);
      if (joint_size > 0) {
        const std::size_t agent = sample % rollout.shape().agents;
        JoinObservations(rollout.features(sample - agent), rollout.shape().agents, width, agent,
                         joint_.data() + row * joint_size);
      }
      is_first_[row] = rollout.is_first(sample) ? 1 : 0;
      masks_[row] = rollout.mask(sample);
      actions_[row] = rollout.action(sample);
      labels_[row] = rollout.label(sample);
      log_probs_[row] = rollout.log_prob(sample);
      values_[row] = rollout.value(sample);
      advantages_[row] = (rollout.advantage(sample) - mean_) * inverse_deviation_;
      targets_[row] = rollout.target(sample);
      weights_[row] = rollout.IsValid(sample) ? weight_ : 0.0F;
    }
  }
}

template <typename Self, typename Visit>
void PpoUpdater::VisitNumbers(Self& self, const Visit& visit) {
  visit("learning_rate", self.learning_rate_);
  visit("value_error", self.value_error_);
}

void PpoUpdater::Save(Checkpoint& checkpoint) const {
  checkpoint.SetArray("weights", network_.weights());
  adam_.Save(checkpoint);
  SaveNumbers(checkpoint, "ppo.updater", [this](const auto& visit) { VisitNumbers(*this, visit); });
}

void PpoUpdater::Load(const Checkpoint& checkpoint) {
  std::vector<float> weights;
  checkpoint.GetArray("weights", network_.weights().size(), weights);
  LoadNumbers<double>(checkpoint, "ppo.updater", "ppo.numbers",
                      [this](const auto& visit) { VisitNumbers(*this, visit); });
  adam_.Load(checkpoint);
  network_.weights() = std::move(weights);
}

}  // namespace aquafarm::agents
