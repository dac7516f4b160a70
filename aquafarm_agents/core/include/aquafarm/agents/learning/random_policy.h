// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "aquafarm/agents/learning/agent_rng.h"
#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// The actions among which the policy RANDOM draws (paper §4.2, see docs/model.md).
enum class RandomActions : std::uint8_t {
  kAll,  ///< all actions except kHold, legal or not
  /// The legal actions, without moves onto a charted rock, onto an island or off the map. If every
  /// legal move is such a move, no move is excluded.
  kReachable,
};
inline constexpr int kRandomActionsCount = 2;
std::string_view ToString(RandomActions value);

/// Parses the options of RANDOM: "actions=all" (the default) or "actions=reachable".
/// @throws InputError on any other option or value
RandomActions ParseRandomActions(const std::string& options);
/// Returns the ObservationTypeBits that RANDOM requires with these options.
/// @throws InputError in the same cases as ParseRandomActions
std::uint8_t RandomObservationTypes(const std::string& options);

/// The policy RANDOM. It draws uniformly from the actions that its RandomActions selects.
class RandomPolicy final : public Policy {
 public:
  explicit RandomPolicy(const EnvironmentSpec& spec, RandomActions actions = RandomActions::kAll)
      : agents_(spec.agents), features_(spec.feature_count), actions_(actions) {}
  std::uint8_t observation_types() const override;
  void Begin(std::uint64_t seed, std::int32_t farms) override;
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override;

  const AgentRng& streams() const { return streams_; }
  AgentRng& streams() { return streams_; }

 private:
  std::int32_t agents_;
  std::int32_t features_;
  RandomActions actions_;
  AgentRng streams_;
};

/// RANDOM with the interface of a learner. It does not learn.
class RandomLearner final : public Learner {
 public:
  /// @throws InputError on an unknown option or value
  RandomLearner(const EnvironmentSpec& spec, std::uint64_t seed, const std::string& options);
  std::uint8_t observation_types() const override { return policy_.observation_types(); }
  /// Returns an empty text for actions=all, because checkpoints of earlier versions contain no
  /// options.
  std::string options() const override;
  void Step(const StepResults& results, double progress,
            std::vector<std::uint8_t>& actions) override;
  LearnerStatus status() const override;
  std::unique_ptr<Policy> GreedyPolicy() const override;
  void SavePolicy(Checkpoint&) const override {}
  void Save(Checkpoint& checkpoint) const override;
  void Load(const Checkpoint& checkpoint) override;

 private:
  EnvironmentSpec spec_;
  RandomActions actions_;
  RandomPolicy policy_;
};

}  // namespace aquafarm::agents
