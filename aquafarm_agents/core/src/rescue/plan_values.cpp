// SPDX-License-Identifier: BSD-3-Clause
#include "rescue/plan_values.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "aquafarm/agents/rescue/rescue_plan.h"
#include "rescue/case_parts.h"

namespace aquafarm::agents {

double Rounded(double value, double unit) {
  return std::round(value / unit) * unit + 0.0;  // -0.0 becomes 0.0
}
double Share(double value) { return std::clamp(Rounded(value, 1e-4), 0.0, 1.0); }
double Money(double value) { return Rounded(value, 0.01); }
double Km(double value) { return Rounded(value, 0.001); }
Json OfCell(Cell cell) { return Json::array({cell.x, cell.y}); }
Json OfId(std::int32_t id) { return id == kNone ? Json(nullptr) : Json(id); }
Json OfPlace(GeoPoint place) {
  return {{"latitude", Rounded(place.latitude, 1e-6)},
          {"longitude", Rounded(place.longitude, 1e-6)}};
}
std::string Hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof(text), "%016llx", static_cast<unsigned long long>(value));
  return text;
}

Json LossOf(std::vector<float> losses) {
  const LossSummary summary = Summarize(losses);
  std::sort(losses.begin(), losses.end());
  Json exceedance = Json::array();
  const std::size_t count = losses.size();
  const std::size_t points = std::min<std::size_t>(count, 100);
  for (std::size_t k = 0; k < points; ++k) {
    const double loss =
        static_cast<double>(losses[k * (count - 1) / std::max<std::size_t>(1, points - 1)]);
    const auto above =
        losses.end() - std::upper_bound(losses.begin(), losses.end(), static_cast<float>(loss));
    Json point{Money(loss), Share(static_cast<double>(above) / static_cast<double>(count))};
    if (exceedance.empty() || exceedance.back() != point) exceedance.push_back(std::move(point));
  }
  return {{"mean", Money(summary.mean)}, {"standard_error", summary.standard_error},
          {"q05", Money(summary.q05)},   {"q50", Money(summary.q50)},
          {"q95", Money(summary.q95)},   {"cvar05", Money(summary.cvar05)},
          {"exceedance", exceedance}};
}

Json UnknownLoss() {
  return {{"mean", nullptr},
          {"standard_error", nullptr},
          {"q05", nullptr},
          {"q50", nullptr},
          {"q95", nullptr},
          {"cvar05", nullptr},
          {"exceedance", Json::array()}};
}

std::string WhyUnknown(const RescueCase& rescue) {
  const std::int64_t from = rescue.storm.passage.unknown[0];
  const bool has_ended = from == 0 && rescue.storm.age_h >= kOldBulletin_h;
  return (has_ended ? "The bulletin's forecast ended at " + FormatUtc(*rescue.storm.known_until)
                    : "The storm's winds are unknown from " + FormatUtc(from) + " on") +
         ": chances, arrivals, losses, deadlines and comparisons are unknown, which does not mean "
         "0.";
}

std::string ObjectiveOf(const RescueProblem& problem) {
  const bool is_averse = problem.risk_averse > 0.0;
  const std::string text = is_averse
                               ? "least mean loss of the worst " +
                                     Short(100.0 * problem.risk_averse, 1) + " % of the futures"
                               : "most value saved on average";
  if (!IsPriced(problem)) return text;
  return text + (is_averse ? ", plus" : ", less") + " the cost of energy and ship-hours";
}

std::string MethodOf(const RescueProblem& problem, const RescuePlan& plan) {
  std::string text = plan.is_exhaustive ? "exhaustive over sequences of direct trips"
                                        : "bounded search over sequences of direct trips";
  if (problem.risk_averse > 0.0 && std::isfinite(plan.averse_gap)) {
    text += "; no sequence has an objective that is lower by more than " +
            Short(plan.averse_gap, plan.averse_gap < 100.0 ? 2 : 0);
  }
  return text;
}

Json WarningsOf(const RescueCase& rescue) {
  Json list = Json::array();
  for (const RescueWarning& one : rescue.warnings) {
    list.push_back({{"code", one.code},
                    {"severity", one.severity},
                    {"text", one.text},
                    {"advice", one.advice},
                    {"ship", OfId(one.ship)}});
  }
  return list;
}

Json LeftBehindOf(const RescueCase& rescue, const PlanReport& report) {
  const RescueProblem& problem = rescue.problem;
  Json list = Json::array();
  for (std::size_t d = 0; d < problem.devices.size(); ++d) {
    const DeviceOutcome& outcome = report.plan.devices[d];
    if (outcome.ship != kNone) continue;
    const char* reason = "too_late";
    std::string text =
        "no ship can bring it to port before the winds with a chance of at least 50 %.";
    if (report.result == PlanResult::kStormUnknown) {
      reason = "winds_unknown";
      text = "the storm's winds are unknown, so that no trip can be judged.";
    } else if (problem.CarrierOf(d) != kNone) {
      reason = "unreachable";
      text = "it is aboard a ship that can bring it to no open port.";
    } else if (!HasValueLeft(problem.devices[d])) {
      reason = "not_worth_it";
      text = "it has no value left to save.";
    } else if (outcome.mean_loss_idle <= 0.0) {
      reason = "safe_in_place";
      text = "no winds reach it in any of the futures.";
    } else if (problem.ships.empty()) {
      reason = "no_ship";
      text = "there is no ship.";
    } else if (report.deadlines[d].back().leave_s) {
      reason = IsPriced(problem) ? "not_worth_it" : "no_ship";
      text = "the ships save more with other devices first";
      text += IsPriced(problem) ? ", or a trip to it costs more than it saves." : ".";
    }
    list.push_back(
        {{"device", d}, {"reason", reason}, {"text", problem.devices[d].name + ": " + text}});
  }
  return list;
}

Json AssumptionsOf(const RescueCase& rescue) {
  Json list = Json::array();
  for (const RescueAssumption& one : rescue.assumptions) {
    list.push_back(
        {{"what", one.what}, {"value", one.value}, {"basis", one.basis}, {"source", one.source}});
  }
  return list;
}

}  // namespace aquafarm::agents
