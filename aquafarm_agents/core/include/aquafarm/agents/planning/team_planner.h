// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Cooperative planning, the classical baseline for several agents (cooperative A*, Silver 2005,
/// after an assignment step):
///
///   1. assign the devices to ships so that the last ship finishes as early as possible
///   2. ship by ship, compute the best plan for its devices (planner.h) that avoids the ships
///      planned before
///   3. repeat both if a disaster changes its heading, or if a ship deviates from its plan or has
///      completed it
///
/// Self-propelled devices plan their own routes. Step 1 considers distances only: neither energy
/// nor the kinds and damage of devices; step 2 considers all of them. The result is not optimal;
/// team_bound.h bounds it, with energy, kinds and damage.

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
  /// @throws InputError as Planner
  TeamPlanner(const Scenario& scenario, Foresight foresight);
  ~TeamPlanner();
  TeamPlanner(TeamPlanner&&) noexcept;

  /// Plans of one farm from step `start` on.
  struct PlanState {
    std::vector<std::vector<std::uint8_t>> actions;  ///< by agent, from step `start` on
    std::vector<std::vector<std::int32_t>> path;     ///< by agent: its cell before each action
    std::uint64_t seed{};
    std::uint64_t episode{};
    std::int32_t start{};
    std::vector<Disaster> disasters;  ///< expected state at step `foreseen`
    std::vector<Track> tracks;        ///< assumed tracks of the disasters
    std::int32_t foreseen{};
  };

  /// Chooses the actions of the next step of a farm whose episode is active. Plans again if
  /// necessary.
  /// @param actions [agents]
  void Act(const Farm& farm, PlanState& course, std::uint8_t* actions);

  /// Assigns devices: for each agent the ids of those that it fetches, carries or is.
  std::vector<std::vector<std::int32_t>> Assign(const Farm& farm) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The team planner as a Policy. It sees the complete farm, as PlannerPolicy does.
class TeamPlannerPolicy final : public Policy {
 public:
  /// @throws InputError if the farm is too large or not supported (see Planner)
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
