// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The complete result of a rescue plan, as text for people and as JSON for programs
/// (aquafarm_bringup/python/aquafarm_plan/plan.schema.json).

#include <string>
#include <vector>

#include "aquafarm/agents/rescue/rescue_case.h"
#include "aquafarm/agents/rescue/what_if.h"

namespace aquafarm::agents {

/// Outcome of a plan, and the exit code of aquafarm_plan.
enum class PlanResult : std::uint8_t {
  kPlan = 0,             ///< ships leave
  kNothingSaved = 10,    ///< winds come, and no ship can save anything worth its cost
  kStormStaysAway = 11,  ///< no member of the ensemble reaches a device in the known time
  kStormUnknown = 12,    ///< wind and radii are unknown while the storm is near, or the forecast
                         ///< ended before the present time
  kBulletinOld = 13,     ///< the bulletin is older than 12 hours; kStormUnknown comes before it
};

/// How and from which files a plan was made.
struct PlanProvenance {
  std::string command;
  std::int64_t computed_at{};  ///< UTC [s since 1970]
  double compute_s{};
  std::vector<std::pair<std::string, std::string>> inputs;  ///< role and path of the files
};

/// A case with its plan.
struct PlanReport {
  PlanResult result{};  ///< what the bulletin states, whatever its age
  bool is_old{};        ///< the bulletin is older than 12 hours
  std::string text;     ///< the result in one sentence
  RescuePlan plan;
  std::vector<std::vector<Deadline>> deadlines;  ///< by device, for kDeadlineShares
  std::vector<WhatIf> what_if;

  /// Returns the result, or kBulletinOld if the bulletin is old and the result is known.
  PlanResult ExitCode() const {
    return is_old && result != PlanResult::kStormUnknown ? PlanResult::kBulletinOld : result;
  }
};
/// Chances for which deadlines are given.
inline constexpr std::array<double, 3> kDeadlineShares{0.95, 0.8, 0.5};

/// Plans a case. May add warnings to it.
PlanReport MakeReport(RescueCase& rescue, const Ensemble& ensemble);

/// End of the departures that are worth a try. At most one of the two times is set.
struct LastDeparture {
  std::optional<double> none_after_s;        ///< after it no ship should leave
  std::optional<double> not_known_beyond_s;  ///< ships may leave until then; after it the known
                                             ///< time is too short for a trip
};
/// Returns the latest deadline of all devices at their sites with a chance of at least 50 %; if one
/// of these deadlines is open, it is not known after which time no ship should leave. Devices
/// aboard do not count: their ships come home, they do not leave.
/// @returns neither time if there is no such deadline, if no winds come, or if the winds are
/// unknown
LastDeparture LastDepartureOf(const RescueProblem& problem, const PlanReport& report);

/// Returns the plan as text of about a page, in local time and UTC.
std::string ToText(const RescueCase& rescue, const PlanReport& report);
/// Returns the plan as JSON (aquafarm_bringup/python/aquafarm_plan/plan.schema.json).
std::string ToJson(const RescueCase& rescue, const Ensemble& ensemble, const PlanReport& report,
                   const PlanProvenance& provenance);

}  // namespace aquafarm::agents
