// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/grid/action.h"

namespace aquafarm::agents {

/// Policy that chooses kHold for every agent in every step. It is the baseline for the value that a
/// rescue saves.
class DoNothingPolicy final : public Policy {
 public:
  explicit DoNothingPolicy(const EnvironmentSpec& spec)
      : agents_(static_cast<std::size_t>(spec.agents)) {}
  std::uint8_t observation_types() const override { return 0; }
  void Begin(std::uint64_t, std::int32_t farms) override {
    slots_ = agents_ * static_cast<std::size_t>(farms);
  }
  void Act(const StepResults&, std::vector<std::uint8_t>& actions) override {
    actions.assign(slots_, static_cast<std::uint8_t>(Action::kHold));
  }

 private:
  std::size_t agents_;
  std::size_t slots_{};
};

}  // namespace aquafarm::agents
