// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "aquafarm/agents/environment/environment.h"

namespace aquafarm::agents {

/// Chooses actions for all agents of all farms. Does not learn.
class Policy {
 public:
  virtual ~Policy() = default;

  /// Returns the observation types that the policy requires, a mask of ObservationTypeBits.
  virtual std::uint8_t observation_types() const = 0;

  /// Prepares for new episodes on `farms` farms: resets state such as the recurrent state, the
  /// plans and the random streams.
  /// @param seed seed of the policy's random numbers, if it draws any
  virtual void Begin(std::uint64_t seed, std::int32_t farms) = 0;

  /// Chooses the actions for the step that follows `results`.
  /// @param actions is resized to [N, S]
  virtual void Act(const StepResults& results, std::vector<std::uint8_t>& actions) = 0;

  /// Returns the learned values of the states at the last Act, [N, S], in the unit of the rewards:
  /// V(s) of a critic, or Q(s, a) of the greedy action. Empty if the policy has no value estimates.
  const std::vector<float>& values() const { return values_; }

 protected:
  std::vector<float> values_;
};

}  // namespace aquafarm::agents
