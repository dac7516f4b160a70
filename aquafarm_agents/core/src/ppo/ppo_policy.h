// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/agents/ppo/ppo_options.h"
#include "networks/repetition_penalty.h"
#include "ppo/actor.h"
#include "ppo/actor_critic.h"
#include "ppo/loop_guard.h"

namespace aquafarm::agents {

/// Acts with the weights of an ActorCritic, greedily or by sampling (PpoOptions::policy). values()
/// contains V(s) in units of the unscaled reward; for MAPPO it is empty. Inactive agents get action
/// 0 and value 0.
class PpoPolicy final : public Policy {
 public:
  /// @throws InputError if `weights` has another size than the network, or if the options do not
  ///   fit the features of `spec`
  PpoPolicy(const EnvironmentSpec& spec, const PpoOptions& options,
            const std::vector<float>& weights);

  std::uint8_t observation_types() const override { return kFeaturesBit; }
  void Begin(std::uint64_t seed, std::int32_t farms) override;
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override;

 private:
  void TakeBest(const StepResults& results, std::vector<std::uint8_t>& actions);
  void LeaveLoops(const StepResults& results, std::vector<std::uint8_t>& actions);

  const EnvironmentSpec spec_;
  const PpoOptions options_;
  std::unique_ptr<ActorCritic> network_;
  Actor actor_;
  RepetitionPenalty repetitions_;
  std::optional<LoopGuard> loops_;
  AgentRng rng_;
};

/// Makes the policy of a checkpoint without initializing libtorch, which acting does not need.
/// @throws InputError if the policy does not fit farms of `spec`, or if the checkpoint is damaged
std::unique_ptr<Policy> MakePpoPolicyWithoutTorch(const Checkpoint& checkpoint,
                                                  const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
