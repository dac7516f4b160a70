// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The planner as a Policy for farms with one agent. It reads the complete state of the farm, even
/// if the scenario limits what ships observe. It is therefore a reference, not a fair competitor of
/// learners with a limited view.

#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/agents/planning/planner.h"

namespace aquafarm::agents {

/// The *receding-horizon* policy (kPersistence) plans again at each step, from the newest forecast.
/// It assumes that a disaster without a forecast keeps its heading. The *clairvoyant* policy
/// (kOracle) uses the true future. It plans once per episode, and again if the ship deviates from
/// the plan or has completed it.
class PlannerPolicy final : public Policy {
 public:
  /// @throws InputError in the same cases as the constructor of Planner
  PlannerPolicy(const EnvironmentSpec& spec, Foresight foresight);
  std::uint8_t observation_types() const override { return kStatesBit; }
  void Begin(std::uint64_t seed, std::int32_t farms) override;
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override;

 private:
  /// Remaining plan of one farm.
  struct PlanState {
    Plan plan;
    std::size_t next{};  // index of the next action in plan.actions
    std::uint64_t seed{};
    std::uint64_t episode{};
    std::int32_t step{};  // expected step of the farm at the next Act
    Cell cell{};          // expected cell of the ship at that step
  };
  std::uint8_t Follow(const Farm& farm, PlanState& course);

  std::shared_ptr<const Scenario> scenario_;
  Foresight foresight_;
  Planner planner_;
  std::vector<PlanState> plans_;
};

}  // namespace aquafarm::agents
