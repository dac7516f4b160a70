// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Values of plan.json.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "aquafarm/agents/rescue/plan_report.h"
#include "aquafarm/grid/cell.h"
#include "aquafarm/grid/geo_frame.h"

namespace aquafarm::agents {

using Json = nlohmann::ordered_json;

double Rounded(double value, double unit);
/// A probability, to four digits.
double Share(double value);
double Money(double value);
double Km(double value);
Json OfCell(Cell cell);
/// null for kNone.
Json OfId(std::int32_t id);
Json OfPlace(GeoPoint place);
std::string Hex(std::uint64_t value);
/// Summary and exceedance curve. @param losses one per member, at least one
Json LossOf(std::vector<float> losses);
/// A loss that is not known: null.
Json UnknownLoss();
/// Why a plan with PlanResult::kStormUnknown has no numbers.
std::string WhyUnknown(const RescueCase& rescue);
/// What the plan maximises or minimises, in words.
std::string ObjectiveOf(const RescueProblem& problem);
/// How the plan was found, in words.
std::string MethodOf(const RescueProblem& problem, const RescuePlan& plan);
/// Devices without an order, each with the reason.
Json LeftBehindOf(const RescueCase& rescue, const PlanReport& report);
Json WarningsOf(const RescueCase& rescue);
Json AssumptionsOf(const RescueCase& rescue);

}  // namespace aquafarm::agents
