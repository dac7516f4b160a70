// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Cooperative planning, the classical baseline of several agents (after cooperative A*, Silver
/// 2005, with an assignment before it):
///
///   1. devices are shared out so that the last ship is done as early as can be
///   2. ship by ship, the best plan for its share in time (planner.h), out of the way of those that
///      have planned already
///   3. all of it again when a disaster does not hold its heading, a ship is not where its plan put
///      it, or one has done its share
///
/// Self-propelled devices plan their own way home. Not an optimum: team_bound.h bounds it.

#include <cstdint>
#include <memory>
#include <vector>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/agents/planning/planner.h"
#include "aquafarm/observation/farm_batch.h"

namespace aquafarm::agents {

/// Plans for all agents of a farm.
class TeamPlanner {
 public:
  /// @param scenario must outlive the planner
  /// @throws InputError of Planner
  TeamPlanner(const Scenario& scenario, Foresight foresight);
  ~TeamPlanner();
  TeamPlanner(TeamPlanner&&) noexcept;

  /// One farm's plans, as far as they go.
  struct PlanState {
    std::vector<std::vector<std::uint8_t>> actions;  ///< by agent, from `start` on
    std::vector<std::vector<std::int32_t>> path;     ///< by agent: its cell before each action
    std::uint64_t seed{};
    std::uint64_t episode{};
    std::int32_t start{};
    std::vector<Disaster> disasters;  ///< as they should be at `foreseen`
    std::vector<Track> tracks;        ///< that they are thought to follow
    std::int32_t foreseen{};
  };

  /// Chooses for the next step of a farm that is not over, planning anew where it must.
  /// @param actions [agents]
  void Act(const Farm& farm, PlanState& course, std::uint8_t* actions);

  /// Who fetches what: ids of devices for each agent, what it holds or is included.
  std::vector<std::vector<std::int32_t>> Assign(const Farm& farm) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The team planner as a policy; sees all of a farm, like PlannerPolicy.
class TeamPlannerPolicy final : public Policy {
 public:
  /// @throws InputError when the farm is beyond the planner (see Planner)
  TeamPlannerPolicy(const EnvironmentSpec& spec, Foresight foresight);
  std::uint8_t encodings() const override { return kStatesBit; }
  void Begin(std::uint64_t seed, std::int32_t farms) override;
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override;

 private:
  std::shared_ptr<const Scenario> scenario_;
  TeamPlanner planner_;
  std::unique_ptr<FarmBatch> farms_;
  std::vector<TeamPlanner::PlanState> courses_;
};

}  // namespace aquafarm::agents
