// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/learning/random_policy.h"

#include <cmath>

#include "aquafarm/agents/base/options.h"

namespace aquafarm::agents {

void RandomPolicy::Begin(std::uint64_t seed, std::int32_t farms) {
  streams_ = EntryStreams(seed, static_cast<std::size_t>(farms * agents_));
}

void RandomPolicy::Act(const Results&, std::vector<std::uint8_t>& actions) {
  actions.resize(streams_.size());
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    actions[i] = static_cast<std::uint8_t>(streams_[i].Below(kActionCount));
  }
}

RandomLearner::RandomLearner(const EnvironmentSpec& spec, std::uint64_t seed,
                             const std::string& options)
    : agents_(spec.agents), policy_(spec.agents) {
  OptionReader(options).Finish();
  policy_.Begin(seed, spec.farms);
}

void RandomLearner::Step(const Results& results, double, std::vector<std::uint8_t>& actions) {
  policy_.Act(results, actions);
}

LearnerStatus RandomLearner::status() const { return {std::nanf(""), 1.0F, 0.0F}; }

std::unique_ptr<Policy> RandomLearner::GreedyPolicy() const {
  return std::make_unique<RandomPolicy>(agents_);
}

void RandomLearner::Save(Checkpoint& checkpoint) const { policy_.streams().Save(checkpoint); }

void RandomLearner::Load(const Checkpoint& checkpoint) { policy_.streams().Load(checkpoint); }

}  // namespace aquafarm::agents
