// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Cooperative planning for several agents: an assignment step, then cooperative A* (Silver 2005).
///
///   1. Assign the devices to ships. A local search minimizes the estimated time at which the last
///      ship finishes.
///   2. For one ship after the other, compute the best plan for its devices (planner.h) that avoids
///      the ships that already have a plan.
///   3. Repeat both steps if a disaster differs from the assumed future, if a ship deviates from
///      its plan, or if a ship has completed its plan.
///
/// A self-propelled device is an agent with its own plan in step 2. Step 1 considers only distances
/// and the capacity. Step 2 also considers risks, damage, the kinds of devices, and energy. The
/// result may be worse than the optimum; team_bound.h has an upper bound of the return.

#include <cstdint>
#include <memory>
#include <vector>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/agents/planning/planner.h"

namespace aquafarm::agents {

/// Plans for all agents of a farm.
class TeamPlanner {
 public:
  /// @param scenario must outlive the planner
  /// @throws InputError in the same cases as the constructor of Planner with the max number of
  ///   devices of one ship (see Assign) as `max_devices`
  TeamPlanner(const Scenario& scenario, Foresight foresight);
  ~TeamPlanner();
  TeamPlanner(TeamPlanner&&) noexcept;

  /// Plans of all agents of one farm, and the future that they assume.
  struct PlanState {
    std::vector<std::vector<std::uint8_t>> actions;  ///< by agent: actions from step `start` on
    std::vector<std::vector<std::int32_t>> path;     ///< by agent: linear cells from `start` on
    std::uint64_t seed{};
    std::uint64_t episode{};
    std::int32_t start{};
    std::vector<Disaster> disasters;  ///< expected state at step `foreseen`
    std::vector<Track> tracks;        ///< assumed tracks of the disasters
    std::int32_t foreseen{};
  };

  /// Chooses the actions of the next step, and plans again if necessary. The episode must not be
  /// over.
  /// @param course plans of this farm; empty before the first call
  /// @param actions [agents]
  void Act(const Farm& farm, PlanState& course, std::uint8_t* actions);

  /// Assigns the undelivered devices to agents. The devices of a ship are those that it carries and
  /// those that it fetches next. Their max number is the average per ship, rounded up, plus two. A
  /// self-propelled device is assigned to itself.
  /// @returns ids of devices, by agent. A device is left out if all ships that could take it have
  ///   their max number
  std::vector<std::vector<std::int32_t>> Assign(const Farm& farm) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// TeamPlanner as a Policy. It reads the complete state of the farm, even if the scenario limits
/// what ships observe.
class TeamPlannerPolicy final : public Policy {
 public:
  /// @throws InputError in the same cases as the constructor of TeamPlanner
  TeamPlannerPolicy(const EnvironmentSpec& spec, Foresight foresight);
  std::uint8_t observation_types() const override { return kStatesBit; }
  void Begin(std::uint64_t seed, std::int32_t farms) override;
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override;

 private:
  std::shared_ptr<const Scenario> scenario_;
  TeamPlanner planner_;
  std::vector<TeamPlanner::PlanState> plans_;
};

}  // namespace aquafarm::agents
