// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "aquafarm/agents/environment/environment.h"

namespace aquafarm::agents {

/// Chooses actions for all agents of all farms and learns nothing.
class Policy {
 public:
  virtual ~Policy() = default;

  /// What it reads of Results; EncodingBits.
  virtual std::uint8_t encodings() const = 0;

  /// Begins to play anew: forgets what it carried from step to step.
  /// @param seed of its own chance, if it uses any
  virtual void Begin(std::uint64_t seed, std::int32_t farms) = 0;

  /// Chooses for the step after `results`. @param actions is resized to [N, S]
  virtual void Act(const Results& results, std::vector<std::uint8_t>& actions) = 0;

  /// V_π as it learnt it: what each action that Act chose last is expected to bring from then on
  /// (discounted), [N, S]; empty: it holds no values.
  const std::vector<float>& values() const { return values_; }

 protected:
  std::vector<float> values_;
};

}  // namespace aquafarm::agents
