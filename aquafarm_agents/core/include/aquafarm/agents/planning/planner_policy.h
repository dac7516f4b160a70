// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Planning as a policy like any other, on farms in this process or behind ROS: it reads the
/// farms' saved states into farms of its own and plans there. It sees all of a farm, in partial
/// view too: it is a yardstick, not a contender, where learners see less.

#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/agents/planning/planner.h"
#include "aquafarm/observation/farm_batch.h"

namespace aquafarm::agents {

/// *Receding-horizon* (kPersistence) plans anew at each step, as a good operator would who trusts
/// that a disaster holds its heading. *Clairvoyant* knows what will come: it plans once an episode,
/// and again when the farm is not where the plan put it.
class PlannerPolicy final : public Policy {
 public:
  /// @throws InputError when the farm is beyond the planner (see Planner)
  PlannerPolicy(const EnvironmentSpec& spec, Foresight foresight);
  std::uint8_t encodings() const override { return kStatesBit; }
  void Begin(std::uint64_t seed, std::int32_t farms) override;
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override;

 private:
  /// What is left of one farm's plan.
  struct PlanState {
    Plan plan;
    std::size_t next{};  // action of the plan
    std::uint64_t seed{};
    std::uint64_t episode{};
    std::int32_t step{};
    Cell cell{};  // where the ship should be then
  };
  std::uint8_t Follow(const Farm& farm, PlanState& course);

  std::shared_ptr<const Scenario> scenario_;
  Foresight foresight_;
  Planner planner_;
  std::unique_ptr<FarmBatch> farms_;
  std::vector<PlanState> courses_;
};

}  // namespace aquafarm::agents
