// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/learning/random_policy.h"

#include <array>
#include <cmath>

#include "aquafarm/agents/base/options.h"
#include "base/option_words.h"
#include "learning/action_mask.h"

namespace aquafarm::agents {
namespace {

constexpr std::array<std::string_view, kRandomActionsCount> kNames{"all", "reachable"};

// The options with which LegalMask allows exactly the reachable actions.
struct Reachable {
  bool mask_illegal{true};
  bool mask_blocked{true};
};

}  // namespace

std::string_view ToString(RandomActions value) { return kNames[static_cast<std::size_t>(value)]; }

RandomActions ParseRandomActions(const std::string& options) {
  OptionReader reader(options);
  const RandomActions actions = ReadWord(reader, "actions", RandomActions::kAll, kNames);
  reader.Finish();
  return actions;
}

std::uint8_t RandomObservationTypes(const std::string& options) {
  return ParseRandomActions(options) == RandomActions::kReachable ? kFeaturesBit : 0;
}

std::uint8_t RandomPolicy::observation_types() const {
  return actions_ == RandomActions::kReachable ? kFeaturesBit : 0;
}

void RandomPolicy::Begin(std::uint64_t seed, std::int32_t farms) {
  streams_ = AgentRng(seed, static_cast<std::size_t>(farms * agents_));
}

void RandomPolicy::Act(const StepResults& results, std::vector<std::uint8_t>& actions) {
  actions.resize(streams_.size());
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    if (actions_ == RandomActions::kAll) {
      actions[i] = static_cast<std::uint8_t>(streams_[i].Below(kActionCount));
      continue;
    }
    const float* const seen = results.features.data() + i * static_cast<std::size_t>(features_);
    actions[i] = DrawAction(LegalMask(results.legal[i], seen, Reachable{}), streams_[i]);
  }
}

RandomLearner::RandomLearner(const EnvironmentSpec& spec, std::uint64_t seed,
                             const std::string& options)
    : spec_(spec), actions_(ParseRandomActions(options)), policy_(spec, actions_) {
  policy_.Begin(seed, spec.farms);
}

std::string RandomLearner::options() const {
  if (actions_ == RandomActions::kAll) return "";
  return "actions=" + std::string(ToString(actions_));
}

void RandomLearner::Step(const StepResults& results, double, std::vector<std::uint8_t>& actions) {
  policy_.Act(results, actions);
}

LearnerStatus RandomLearner::status() const { return {std::nanf(""), 1.0F, 0.0F}; }

std::unique_ptr<Policy> RandomLearner::GreedyPolicy() const {
  return std::make_unique<RandomPolicy>(spec_, actions_);
}

void RandomLearner::Save(Checkpoint& checkpoint) const { policy_.streams().Save(checkpoint); }

void RandomLearner::Load(const Checkpoint& checkpoint) { policy_.streams().Load(checkpoint); }

}  // namespace aquafarm::agents
