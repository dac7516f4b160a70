// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "aquafarm/agents/learning/agent_rng.h"
#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// RANDOM of §4: a uniform choice among all actions, legal or not, independent of the observation.
class RandomPolicy final : public Policy {
 public:
  explicit RandomPolicy(std::int32_t agents) : agents_(agents) {}
  std::uint8_t encodings() const override { return 0; }
  void Begin(std::uint64_t seed, std::int32_t farms) override;
  void Act(const Results& results, std::vector<std::uint8_t>& actions) override;

  const EntryStreams& streams() const { return streams_; }
  EntryStreams& streams() { return streams_; }

 private:
  std::int32_t agents_;
  EntryStreams streams_;
};

/// RANDOM behind the Learner interface. It acts uniformly and does not learn.
class RandomLearner final : public Learner {
 public:
  /// @throws InputError unless `options` is empty
  RandomLearner(const EnvironmentSpec& spec, std::uint64_t seed, const std::string& options);
  std::uint8_t encodings() const override { return 0; }
  std::string options() const override { return ""; }
  void Step(const Results& results, double progress, std::vector<std::uint8_t>& actions) override;
  LearnerStatus status() const override;
  std::unique_ptr<Policy> GreedyPolicy() const override;
  void SavePolicy(Checkpoint&) const override {}
  void Save(Checkpoint& checkpoint) const override;
  void Load(const Checkpoint& checkpoint) override;

 private:
  std::int32_t agents_;
  RandomPolicy policy_;
};

}  // namespace aquafarm::agents
