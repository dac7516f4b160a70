// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Makes rescue plans from the current inputs and keeps the last plan that could be made.

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
  std::shared_ptr<const aquafarm::Scenario> scenario;  ///< null: no ranch is known yet
  aquafarm::agents::RescueRequest request;             ///< without bulletin
  std::vector<StampedFile> bulletins;                  ///< newest first; empty with request.storm
  std::vector<StampedFile> files;                      ///< lists of devices and of ships
  std::optional<aquafarm::agents::FleetState> fleet;   ///< set if the plan follows a ranch
  std::uint64_t step{};                                ///< step of that ranch
  std::int64_t refresh{};                              ///< number whose change causes a new plan
  std::string command;                                 ///< command line that the plan records
  std::string fault;  ///< why the inputs are incomplete or outdated; empty: they are complete
};

/// Returns whether two inputs lead to the same plan. Compares scenario, bulletins, files,
/// request.at, refresh, the fleet and its step. All other fields of `request` must be equal.
bool SamePlan(const PlanInputs& a, const PlanInputs& b);

/// Makes a plan with one bulletin.
/// @param bulletin path; empty with request.storm
/// @throws InputError as MakeRescueCase and UseFleet
PlanMessages MakePlan(const PlanInputs& inputs, const std::string& bulletin);

/// Keeps the last plan. If the newest bulletin cannot be used, the previous one stays in use.
class PlanKeeper {
 public:
  /// Plans again if the inputs have changed. Never throws: errors are in `fault` of the plan.
  /// @returns whether plan() has changed
  bool Update(const PlanInputs& inputs);
  /// Returns the last plan; before the first one `result` is NONE.
  const PlanMessages& plan() const { return plan_; }

 private:
  std::string TryAll(const PlanInputs& inputs);
  void Use(PlanMessages plan, const PlanInputs& inputs);

  PlanMessages plan_;
  std::optional<PlanInputs> inputs_;  // of the last Update
  std::string refused_;               // why the newest inputs were refused; empty: they were not
  std::string good_;                  // bulletin of plan_; empty before the first plan
};

}  // namespace aquafarm_agents
