// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The complete result of a rescue plan, as text for operators and as JSON for programs
/// (aquafarm_bringup/python/aquafarm_plan/plan.schema.json).

#include <string>
#include <vector>

#include "aquafarm/agents/rescue/rescue_case.h"
#include "aquafarm/agents/rescue/what_if.h"

namespace aquafarm::agents {

/// Outcome of a plan, and the exit code of aquafarm_plan.
enum class PlanResult : std::uint8_t {
  kPlan = 0,             ///< the plan saves something
  kNothingSaved = 10,    ///< winds come, and no trip saves more than it costs
  kStormStaysAway = 11,  ///< no winds reach a device or a route in the known time in any member
  kStormUnknown = 12,    ///< wind and radii are unknown while the storm is near; or no winds are
                         ///< expected, but the bulletin is old and its forecast has ended
  kBulletinOld = 13,     ///< exit code only: the bulletin is at least 12 hours old. Replaces every
                         ///< result except kStormUnknown
};

/// How a plan was made, and from which files.
struct PlanProvenance {
  std::string command;                                      ///< command line
  std::int64_t computed_at{};                               ///< UTC [s since 1970]
  double compute_s{};                                       ///< duration of the computation
  std::vector<std::pair<std::string, std::string>> inputs;  ///< role and path of each input file
};

/// The plan of a case, with its result, deadlines and comparisons.
struct PlanReport {
  PlanResult result{};  ///< never kBulletinOld
  bool is_old{};        ///< the bulletin is at least 12 hours old
  std::string text;     ///< the result in one or two sentences
  RescuePlan plan;
  std::vector<std::vector<Deadline>> deadlines;  ///< by device and by kDeadlineShares
  std::vector<WhatIf> what_if;

  /// Returns `result`, or kBulletinOld if the bulletin is old and `result` is not kStormUnknown.
  PlanResult ExitCode() const {
    return is_old && result != PlanResult::kStormUnknown ? PlanResult::kBulletinOld : result;
  }
};
/// Chances for which a report has deadlines.
inline constexpr std::array<double, 3> kDeadlineShares{0.95, 0.8, 0.5};

/// Makes the plan of a case and its report. May add or remove warnings of the case, and sorts them
/// by severity.
/// @param ensemble made from the case
PlanReport MakeReport(RescueCase& rescue, const Ensemble& ensemble);

/// Time until which ships may leave [s after the start of the plan]. At most one member is set.
struct LastDeparture {
  std::optional<double> none_after_s;        ///< no ship should leave after this time
  std::optional<double> not_known_beyond_s;  ///< ships may leave until this time; later trips would
                                             ///< end after the known time
};
/// Returns the latest of the devices' deadlines with a chance of 50 %. This time is stored in
/// not_known_beyond_s if any of these deadlines is open (Deadline::is_open), else in none_after_s.
/// Devices aboard do not count, because their ships do not leave to fetch them. Neither member is
/// set if there is no such deadline, if no winds come, or if the winds are unknown.
LastDeparture LastDepartureOf(const RescueProblem& problem, const PlanReport& report);

/// Returns the plan as a text of about one page. Times are in local time and UTC.
std::string ToText(const RescueCase& rescue, const PlanReport& report);
/// Returns the plan as JSON (aquafarm_bringup/python/aquafarm_plan/plan.schema.json).
/// @throws InputError if an input file, whose hash is part of the JSON, cannot be read
std::string ToJson(const RescueCase& rescue, const Ensemble& ensemble, const PlanReport& report,
                   const PlanProvenance& provenance);

}  // namespace aquafarm::agents
