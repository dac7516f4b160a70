// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Makes rescue plans from the present inputs and keeps the last good one.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/agents/rescue/fleet_state.h"
#include "aquafarm_agents/plan/plan_files.h"
#include "aquafarm_agents/plan/plan_messages.h"

namespace aquafarm_agents {

/// All that a plan is made from, at one moment.
struct PlanInputs {
  std::shared_ptr<const aquafarm::Scenario> scenario;  ///< null: no ranch is known yet
  aquafarm::agents::RescueRequest request;             ///< without bulletin
  std::vector<StampedFile> bulletins;                  ///< newest first; empty with request.storm
  std::vector<StampedFile> files;                      ///< devices and ships
  std::optional<aquafarm::agents::FleetState> fleet;   ///< if the plan follows a ranch
  std::uint64_t step{};                                ///< of that ranch
  std::int64_t refresh{};  ///< another number plans again even if nothing else changed
  std::string command;
  std::string fault;  ///< why the inputs are incomplete or outdated; empty: they are not
};

/// Compares all inputs but the fault: plans of equal inputs are equal.
bool SamePlan(const PlanInputs& a, const PlanInputs& b);

/// Makes a plan with one bulletin.
/// @throws InputError as MakeRescueCase
PlanMessages MakePlan(const PlanInputs& inputs, const std::string& bulletin);

/// Keeps the last plan. A bulletin that is refused leaves the one before it in use.
class PlanKeeper {
 public:
  /// Plans again if the inputs changed. Never throws: what is wrong is in `fault` of the plan.
  /// @returns whether plan() changed
  bool Update(const PlanInputs& inputs);
  /// Returns the last plan; before the first one `result` is NONE.
  const PlanMessages& plan() const { return plan_; }

 private:
  std::string TryAll(const PlanInputs& inputs);
  void Use(PlanMessages plan, const PlanInputs& inputs);

  PlanMessages plan_;
  std::optional<PlanInputs> inputs_;  // of the last attempt
  std::string refused_;               // why the newest inputs were refused
  std::string good_;                  // last bulletin that was planned with
};

}  // namespace aquafarm_agents
