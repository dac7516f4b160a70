// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <utility>

#include "aquafarm/agents/learning/warm_start.h"
#include "aquafarm/agents/networks/torch_runtime.h"
#include "aquafarm/agents/ppo/ppo.h"
#include "aquafarm/base/check.h"
#include "networks/farm_rows.h"
#include "ppo/actor.h"
#include "ppo/make_actor_critic.h"
#include "ppo/ppo_policy.h"
#include "ppo/ppo_updater.h"
#include "ppo/rollout.h"

namespace aquafarm::agents {
namespace {

Rollout::Shape RolloutShape(const EnvironmentSpec& spec, const PpoOptions& options,
                            std::size_t state_size) {
  Rollout::Shape shape;
  shape.entries = EntryCount(spec);
  shape.steps = static_cast<std::size_t>(options.Horizon(shape.entries));
  shape.agents = static_cast<std::size_t>(spec.agents);
  shape.features = static_cast<std::size_t>(spec.feature_count);
  shape.state_size = state_size;
  if (options.recurrent) {
    shape.sequence_length = static_cast<std::size_t>(options.sequence_length);
  }
  return shape;
}

// The weights of a policy or of a training checkpoint for a network of `size` weights.
std::vector<float> WeightsOf(const Checkpoint& checkpoint, std::size_t size) {
  std::vector<float> weights;
  const std::size_t got = checkpoint.Section("weights").size() / sizeof(float);
  if (got != size) {
    throw InputError("network: got a policy with " + std::to_string(got) + " weights, expected " +
                     std::to_string(size) + ": train with its options (" + checkpoint.options +
                     ")");
  }
  checkpoint.GetArray("weights", size, weights);
  return weights;
}

class PpoLearner final : public Learner, public WarmStart {
 public:
  PpoLearner(const EnvironmentSpec& spec, std::uint64_t seed, const PpoOptions& options,
             std::string resolved)
      : spec_(spec),
        options_(options),
        resolved_(std::move(resolved)),
        network_(MakeActorCritic(spec, options, seed)),
        actor_(spec, options, network_->state_size()),
        rollout_(RolloutShape(spec, options, network_->state_size())),
        updater_(options, *network_),
        exploration_(seed, EntryCount(spec)),
        rng_({seed, 0, RngStream::kLearner, 1}) {
    if (!HasTokens(spec)) return;
    updater_.SetTeacher(std::make_unique<const Teacher>(LayoutOfTokens(spec.feature_names)));
  }

  std::uint8_t encodings() const override { return kFeaturesBit; }
  std::string options() const override { return resolved_; }
  void Step(const StepResults& results, double progress,
            std::vector<std::uint8_t>& actions) override;
  LearnerStatus status() const override {
    return {updater_.value_error(), entropy_, static_cast<float>(updater_.learning_rate())};
  }
  std::unique_ptr<Policy> GreedyPolicy() const override {
    return std::make_unique<PpoPolicy>(spec_, options_, network_->weights());
  }
  void SavePolicy(Checkpoint& checkpoint) const override {
    checkpoint.SetArray("weights", network_->weights());
  }
  void Save(Checkpoint& checkpoint) const override;
  void Load(const Checkpoint& checkpoint) override;
  void LoadWeights(const Checkpoint& checkpoint) override {
    CheckFits(checkpoint, spec_, NetworkKind::kMlp);
    network_->weights() = WeightsOf(checkpoint, network_->weights().size());
  }

 private:
  void Update(const StepResults& results, double progress);

  const EnvironmentSpec spec_;
  const PpoOptions options_;
  const std::string resolved_;
  const std::unique_ptr<ActorCritic> network_;
  Actor actor_;
  Rollout rollout_;
  PpoUpdater updater_;
  AgentRng exploration_;
  RandomStream rng_;  // order of the samples
  std::uint64_t farm_steps_{};
  float entropy_{};  // mean of the policy at the last step, nats
  std::vector<float> log_probs_;
};

void PpoLearner::Step(const StepResults& results, double progress,
                      std::vector<std::uint8_t>& actions) {
  farm_steps_ += FarmSteps(results);
  rollout_.Complete(results, static_cast<float>(options_.reward_scale));
  if (rollout_.IsFull()) Update(results, progress);
  actor_.Observe(*network_, results);
  actor_.Sample(exploration_, actions);
  const ActionDistribution& distribution = actor_.distribution();
  entropy_ = distribution.entropies.mean();
  log_probs_.resize(actions.size());
  for (std::size_t i = 0; i < actions.size(); ++i) {
    log_probs_[i] = distribution.log_probs(static_cast<Eigen::Index>(i), actions[i]);
  }
  rollout_.Add(results, actor_.masks(), actions, log_probs_, actor_.values(),
               actor_.state_before());
}

void PpoLearner::Update(const StepResults& results, double progress) {
  // The step is taken again with the new weights, from the same recurrent states.
  const std::vector<float> state = actor_.state();
  actor_.Observe(*network_, results);
  actor_.state() = state;
  rollout_.Finish(actor_.values(), static_cast<float>(options_.gamma),
                  static_cast<float>(options_.gae_lambda));
  updater_.Update(rollout_, {progress, farm_steps_}, rng_);
  rollout_.Clear();
}

void PpoLearner::Save(Checkpoint& checkpoint) const {
  updater_.Save(checkpoint);
  rollout_.Save(checkpoint);
  exploration_.Save(checkpoint);
  checkpoint.SetArray("ppo.rng", std::vector<std::uint64_t>{rng_.position(), farm_steps_});
  checkpoint.SetArray("ppo.entropy", std::vector<float>{entropy_});
  checkpoint.SetArray("ppo.state", actor_.state());
}

void PpoLearner::Load(const Checkpoint& checkpoint) {
  std::vector<std::uint64_t> rng;
  std::vector<float> entropy;
  std::vector<float> state;
  checkpoint.GetArray("ppo.rng", 2, rng);
  checkpoint.GetArray("ppo.entropy", 1, entropy);
  checkpoint.GetArray("ppo.state", actor_.state().size(), state);
  updater_.Load(checkpoint);
  rollout_.Load(checkpoint);
  exploration_.Load(checkpoint);
  rng_.Seek(rng[0]);
  farm_steps_ = rng[1];
  entropy_ = entropy[0];
  actor_.state() = std::move(state);
}

}  // namespace

std::uint8_t PpoEncodings(const std::string& options) {
  std::string resolved;
  PpoOptions::Parse(options, resolved);
  return kFeaturesBit;
}

std::unique_ptr<Learner> MakePpo(const EnvironmentSpec& spec, std::uint64_t seed,
                                 const std::string& text) {
  std::string resolved;
  const PpoOptions options = PpoOptions::Parse(text, resolved);
  PrepareTorch(options.threads);
  return std::make_unique<PpoLearner>(spec, seed, options, resolved);
}

std::unique_ptr<Policy> MakePpoPolicy(const Checkpoint& checkpoint, const EnvironmentSpec& spec) {
  std::string resolved;
  PrepareTorch(PpoOptions::Parse(checkpoint.options, resolved).threads);
  return MakePpoPolicyWithoutTorch(checkpoint, spec);
}

}  // namespace aquafarm::agents
