// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Helpers that convert values to JSON for plan.json.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "aquafarm/agents/rescue/plan_report.h"
#include "aquafarm/grid/cell.h"
#include "aquafarm/grid/geo_frame.h"

namespace aquafarm::agents {

using Json = nlohmann::ordered_json;

/// Rounds to a multiple of `unit`.
double Rounded(double value, double unit);
/// Rounds a probability to 0.0001 and clamps it to [0, 1].
double Share(double value);
/// Rounds to 0.01.
double Money(double value);
/// Rounds to 0.001.
double Km(double value);
/// Returns [x, y].
Json OfCell(Cell cell);
/// Returns the id; null for kNone.
Json OfId(std::int32_t id);
/// Returns latitude and longitude, rounded to 0.000001 degrees.
Json OfPlace(GeoPoint place);
/// Returns 16 hexadecimal digits.
std::string Hex(std::uint64_t value);
/// Returns a summary and the exceedance curve of losses. @param losses by member, at least one
Json LossOf(std::vector<float> losses);
/// Returns a summary of unknown losses: all numbers are null.
Json UnknownLoss();
/// Returns why a plan with PlanResult::kStormUnknown contains no numbers.
std::string WhyUnknown(const RescueCase& rescue);
/// Returns in words what the plan maximizes or minimizes.
std::string ObjectiveOf(const RescueProblem& problem);
/// Returns in words how the plan was found.
std::string MethodOf(const RescueProblem& problem, const RescuePlan& plan);
/// Returns the devices that no ship delivers, each with the reason.
Json LeftBehindOf(const RescueCase& rescue, const PlanReport& report);
Json WarningsOf(const RescueCase& rescue);
Json AssumptionsOf(const RescueCase& rescue);

}  // namespace aquafarm::agents
