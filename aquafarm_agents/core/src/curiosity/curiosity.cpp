// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/curiosity/curiosity.h"

#include <algorithm>
#include <utility>

#include "curiosity/curiosity_module.h"
#include "networks/deep_policy.h"

namespace aquafarm::agents {
namespace {

constexpr float kMeanShare = 0.01F;    // weight of a step in the moving average ē of the error e
constexpr float kMaxIntrinsic = 5.0F;  // max of e / ē (curiosity.h)

class CuriousLearner final : public Learner {
 public:
  CuriousLearner(std::unique_ptr<Learner> learner, const EnvironmentSpec& spec, std::uint64_t seed,
                 const Schedule& weight)
      : learner_(std::move(learner)),
        features_(static_cast<std::size_t>(spec.feature_count)),
        agents_(static_cast<std::size_t>(spec.agents)),
        weight_(weight),
        module_(spec.feature_count, seed) {}

  std::uint8_t observation_types() const override {
    return learner_->observation_types() | kFeaturesBit;
  }
  std::string options() const override { return learner_->options(); }
  void Step(const StepResults& results, double progress,
            std::vector<std::uint8_t>& actions) override;
  LearnerStatus status() const override { return learner_->status(); }
  std::unique_ptr<Policy> GreedyPolicy() const override { return learner_->GreedyPolicy(); }
  void SavePolicy(Checkpoint& checkpoint) const override { learner_->SavePolicy(checkpoint); }
  void Save(Checkpoint& checkpoint) const override;
  void Load(const Checkpoint& checkpoint) override;

 private:
  void AddIntrinsicReward(const StepResults& results, float weight);

  std::unique_ptr<Learner> learner_;
  const std::size_t features_;
  const std::size_t agents_;
  const Schedule weight_;
  CuriosityModule module_;
  StepResults augmented_;                 // results with the intrinsic reward added
  std::vector<float> seen_;               // [N, S, F] at the last step; empty before the first
  std::vector<std::uint8_t> taken_;       // [N, S] at the last step
  std::vector<std::uint8_t> was_active_;  // [N, S] at the last step
  float mean_error_{};                    // ē, moving average of e; 0 before the first transition
  std::uint64_t steps_{};                 // farm steps so far
  // Scratch memory: the transitions of this step.
  std::vector<float> from_;
  std::vector<float> to_;
  std::vector<std::int64_t> actions_;
  std::vector<std::size_t> slots_;
  std::vector<float> errors_;
};

void CuriousLearner::Step(const StepResults& results, double progress,
                          std::vector<std::uint8_t>& actions) {
  const auto weight = static_cast<float>(weight_.At(progress));
  steps_ += FarmSteps(results);
  if (weight > 0.0F && !seen_.empty()) {
    AddIntrinsicReward(results, weight);
    learner_->Step(augmented_, progress, actions);
  } else {
    learner_->Step(results, progress, actions);
  }
  seen_ = results.features;
  taken_ = actions;
  was_active_ = results.active;
}

void CuriousLearner::AddIntrinsicReward(const StepResults& results, float weight) {
  from_.clear();
  to_.clear();
  actions_.clear();
  slots_.clear();
  for (std::size_t slot = 0; slot < taken_.size(); ++slot) {
    if (results.is_first[slot / agents_] != 0 || was_active_[slot] == 0) continue;
    const auto begin = static_cast<std::ptrdiff_t>(slot * features_);
    const auto end = begin + static_cast<std::ptrdiff_t>(features_);
    from_.insert(from_.end(), seen_.begin() + begin, seen_.begin() + end);
    to_.insert(to_.end(), results.features.begin() + begin, results.features.begin() + end);
    actions_.push_back(taken_[slot]);
    slots_.push_back(slot);
  }
  augmented_ = results;
  if (slots_.empty()) return;
  module_.Step(from_, to_, actions_, steps_, errors_);
  float sum = 0.0F;
  for (const float error : errors_) sum += error;
  const float mean = sum / static_cast<float>(errors_.size());
  mean_error_ = mean_error_ == 0.0F ? mean : mean_error_ + kMeanShare * (mean - mean_error_);
  if (!(mean_error_ > 0.0F)) return;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    augmented_.rewards[slots_[i]] += weight * std::min(errors_[i] / mean_error_, kMaxIntrinsic);
  }
}

void CuriousLearner::Save(Checkpoint& checkpoint) const {
  learner_->Save(checkpoint);
  module_.Save(checkpoint);
  checkpoint.SetArray("curiosity.seen", seen_);
  checkpoint.SetArray("curiosity.taken", taken_);
  checkpoint.SetArray("curiosity.in_play", was_active_);
  checkpoint.SetArray("curiosity.mean", std::vector<float>{mean_error_});
  checkpoint.SetArray("curiosity.steps", std::vector<std::uint64_t>{steps_});
}

void CuriousLearner::Load(const Checkpoint& checkpoint) {
  std::vector<float> seen;
  std::vector<std::uint8_t> taken;
  std::vector<std::uint8_t> active;
  std::vector<float> mean;
  std::vector<std::uint64_t> steps{0};
  checkpoint.GetArray("curiosity.taken", checkpoint.Section("curiosity.taken").size(), taken);
  checkpoint.GetArray("curiosity.seen", taken.size() * features_, seen);
  checkpoint.GetArray("curiosity.in_play", taken.size(), active);
  checkpoint.GetArray("curiosity.mean", 1, mean);
  // Older checkpoints do not contain this section.
  if (checkpoint.Has("curiosity.steps")) checkpoint.GetArray("curiosity.steps", 1, steps);
  learner_->Load(checkpoint);
  module_.Load(checkpoint);
  seen_ = std::move(seen);
  taken_ = std::move(taken);
  was_active_ = std::move(active);
  mean_error_ = mean[0];
  steps_ = steps[0];
}

}  // namespace

std::unique_ptr<Learner> WithCuriosity(std::unique_ptr<Learner> learner,
                                       const EnvironmentSpec& spec, std::uint64_t seed,
                                       const ExplorationOptions& exploration) {
  return std::make_unique<CuriousLearner>(std::move(learner), spec, seed, exploration.curiosity);
}

}  // namespace aquafarm::agents
