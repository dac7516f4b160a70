// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Makes rescue plans from the current inputs and keeps the last plan.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/agents/rescue/fleet_state.h"
#include "aquafarm_agents/plan/plan_files.h"
#include "aquafarm_agents/plan/plan_messages.h"

namespace aquafarm_agents {

/// All inputs of a plan at one time.
struct PlanInputs {
  std::shared_ptr<const aquafarm::Scenario> scenario;  ///< null: the ranch is not known yet
  aquafarm::agents::RescueRequest request;             ///< its `bulletin` is empty
  std::vector<StampedFile> bulletins;                  ///< newest first; empty with request.storm
  std::vector<StampedFile> files;                      ///< lists of devices and of ships
  std::optional<aquafarm::agents::FleetState> fleet;   ///< state of the ranch that the plan follows
  std::uint64_t step{};                                ///< step of this state
  std::int64_t refresh{};                              ///< number whose change causes a new plan
  std::string command;                                 ///< value of RescuePlan.command
  std::string fault;  ///< why the inputs are incomplete or outdated; empty: no fault
};

/// Returns false if the change from `a` to `b` requires a new plan. Compares scenario, bulletins,
/// files, request.at, refresh, the fleet and its step. Ignores request.now. Assumes that all
/// other fields of `request` are equal.
bool SamePlan(const PlanInputs& a, const PlanInputs& b);

/// Makes a plan with one bulletin.
/// @param inputs must contain a scenario
/// @param bulletin path; empty with request.storm
/// @throws InputError in the same cases as MakeRescueCase, UseFleet, Ensemble, PlanRescue, ToJson
///   and ReadPlan
PlanMessages MakePlan(const PlanInputs& inputs, const std::string& bulletin);

/// Makes plans with the newest bulletin, and keeps the last plan. If the newest bulletin cannot be
/// used, plans with the bulletin of the last plan; before the first plan, with the newest usable
/// bulletin. A newer file is not used if its bulletin was issued before the bulletin of the last
/// plan. A bulletin of another storm is not used before the end of the last plan.
class PlanKeeper {
 public:
  /// Plans again if the inputs have changed and include a scenario and a bulletin or storm. Never
  /// throws: errors are in `fault` of the plan.
  /// @returns true if plan() may have changed. The first call may return false although it sets
  ///          `result` and `text`
  bool Update(const PlanInputs& inputs);
  /// Returns the last plan. After the first Update and before the first plan, `result` is NONE.
  const PlanMessages& plan() const { return plan_; }

 private:
  std::string TryAll(const PlanInputs& inputs);
  void Use(PlanMessages plan, const PlanInputs& inputs);

  PlanMessages plan_;
  std::optional<PlanInputs> inputs_;  // of the last Update
  std::string refused_;               // why plan_ does not use the newest inputs; empty if it does
  std::string good_;  // bulletin of plan_; empty before the first plan and with request.storm
};

}  // namespace aquafarm_agents
