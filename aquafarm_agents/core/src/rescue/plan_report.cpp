// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/rescue/plan_report.h"

#include <algorithm>
#include <cmath>

#include "rescue/case_parts.h"

namespace aquafarm::agents {
namespace {

// Returns a share of the members as a text in percent. It is never 0 % or 100 %, because a sample
// gives no certainty.
std::string Percent(double share) {
  if (share >= 0.995) return "> 99 %";
  return share <= 0.005 ? "< 1 %" : Short(100.0 * share, 0) + " %";
}

std::string Money(const RescueCase& rescue, double value) {
  return Short(value, std::abs(value) < 1000.0 ? 1 : 0) +
         (rescue.currency.empty() ? "" : " " + rescue.currency);
}

// Returns a time as "07-24 20:30 (12:30Z)": local time, then UTC.
std::string Clock(const RescueCase& rescue, double time_s) {
  const std::int64_t utc = rescue.start + std::llround(time_s);
  const std::string local = FormatUtc(utc + 60 * rescue.utc_offset_min);
  return local.substr(5, 5) + " " + local.substr(11, 5) + " (" + FormatUtc(utc).substr(11, 5) +
         "Z)";
}

// Returns whether winds reach a device or the route of a ship in any member.
bool IsReached(const RescueCase& rescue, const Ensemble& ensemble, const RescuePlan& plan) {
  std::vector<Cell> cells = rescue.Sites();
  for (const ShipRoute& route : plan.routes) {
    for (const TimedCell& at : route.path) cells.push_back(at.cell);
  }
  return std::any_of(cells.begin(), cells.end(), [&](Cell cell) {
    const std::int16_t* arrival = ensemble.Arrival(ensemble.rings() - 1, cell);
    return std::any_of(arrival, arrival + ensemble.members(),
                       [](std::int16_t at) { return at != Ensemble::kNoArrival; });
  });
}

// Returns whether the plan contains a time at which the storm is near the ranch and its winds are
// unknown. The members then interpolate from a state without winds. Their winds reach devices too
// late or not at all, so no number of the plan is valid.
bool AreWindsUnknown(const RescueCase& rescue, const Ensemble& ensemble) {
  const double end_s = (ensemble.steps() - 1) * ensemble.options().step_s;
  const std::int64_t from = rescue.storm.passage.unknown[0];
  return from != 0 && from <= rescue.start + static_cast<std::int64_t>(end_s);
}

// Returns the problem with a value of 0 for all devices that are not aboard a ship at the start.
RescueProblem OnlyAboard(RescueProblem problem) {
  for (std::size_t d = 0; d < problem.devices.size(); ++d) {
    if (problem.CarrierOf(d) == kNone) problem.devices[d].value = 0.0;
  }
  return problem;
}

// Returns whether a plan that ignores costs and risk aversion saves anything.
bool SavesWithoutCosts(const RescueProblem& problem, const Ensemble& ensemble) {
  RescueProblem without = problem;
  without.energy.reset();
  without.risk_averse = 0.0;
  return PlanRescue(without, ensemble).saved > 0.0;
}

void Warn(const char* code, const char* severity, const std::string& advice, PlanReport& report,
          RescueCase& rescue) {
  rescue.warnings.push_back({code, severity, report.text, advice});
}

// Returns whether the bulletin is old and its forecast ended before the present time.
bool HasEnded(const RescueCase& rescue) {
  const StormRecord& storm = rescue.storm;
  const double present_s = static_cast<double>(storm.recorded_until) + storm.age_h * 3600.0;
  return !storm.is_hindcast && storm.age_h >= kOldBulletin_h &&
         present_s > static_cast<double>(*storm.known_until);
}

void SetEndedResult(RescueCase& rescue, PlanReport& report) {
  report.result = PlanResult::kStormUnknown;
  report.text =
      "It is unknown whether the storm reaches the devices: the bulletin's forecast "
      "ended at " +
      FormatUtc(*rescue.storm.known_until) + ", before the present time.";
  Warn("forecast_ended", "stop", "Get a newer bulletin. For a past storm give --storm and --at.",
       report, rescue);
}

void SetUnknownResult(RescueCase& rescue, const Ensemble& ensemble, PlanReport& report) {
  report.result = PlanResult::kStormUnknown;
  report.text = std::string("It is unknown ") +
                (IsReached(rescue, ensemble, report.plan) ? "when" : "whether") +
                " the storm reaches the devices: its wind and radii are unknown from " +
                FormatUtc(rescue.storm.passage.unknown[0]) + ".";
  Warn("storm_unknown", "stop", "Get the next bulletin.", report, rescue);
}

void SetNothingSavedResult(RescueCase& rescue, const Ensemble& ensemble, PlanReport& report) {
  report.result = PlanResult::kNothingSaved;
  const RescueProblem& problem = rescue.problem;
  const std::string advice = report.plan.routes.empty()
                                 ? "Keep the ships in port."
                                 : "For ships with devices aboard follow their own warnings; "
                                   "keep the other ships in port.";
  if (IsPriced(problem) && SavesWithoutCosts(problem, ensemble)) {
    report.text = problem.risk_averse > 0.0
                      ? "No trip saves more in the worst " + Short(100.0 * problem.risk_averse, 1) +
                            " % of the futures than it costs: no ship leaves to fetch a device."
                      : "No trip saves more than it costs: no ship leaves to fetch a device.";
    return Warn("not_worth_it", "warning",
                advice + " Ships could still save devices: check the values and prices.", report,
                rescue);
  }
  const bool has_value =
      std::any_of(problem.devices.begin(), problem.devices.end(),
                  [](const RescueDevice& device) { return HasValueLeft(device); });
  report.text = problem.ships.empty() ? "There is no ship, so nothing can be saved."
                : !has_value
                    ? "No device has value left: nothing can be saved."
                    : "No ship can bring a device to a port before the winds that stop ships: "
                      "nothing can be saved.";
  Warn("nothing_can_be_saved", "stop", advice, report, rescue);
}

void SetResult(RescueCase& rescue, const Ensemble& ensemble, PlanReport& report) {
  if (AreWindsUnknown(rescue, ensemble)) return SetUnknownResult(rescue, ensemble, report);
  if (!IsReached(rescue, ensemble, report.plan)) {
    if (HasEnded(rescue)) return SetEndedResult(rescue, report);
    const std::string until =
        FormatUtc(rescue.start +
                  static_cast<std::int64_t>((ensemble.steps() - 1) * ensemble.options().step_s));
    report.result = PlanResult::kStormStaysAway;
    report.text = "No winds of the storm reach a device or the route of a ship in any of " +
                  std::to_string(ensemble.members()) + " futures until " + until +
                  ". What follows is unknown: plan again with the next bulletin.";
    return Warn("storm_stays_away", "warning", "Get the next bulletin.", report, rescue);
  }
  if (report.plan.saved <= 0.0) return SetNothingSavedResult(rescue, ensemble, report);
  report.result = PlanResult::kPlan;
  report.text = std::to_string(report.plan.routes.size()) + " of " +
                std::to_string(rescue.problem.ships.size()) + " ships leave and save " +
                Money(rescue, report.plan.saved) + " of " +
                Money(rescue, Summarize(report.plan.loss_idle).mean) + " on average.";
}

// Returns a chance as text; "unknown" for kStormUnknown, because in this case the members' winds
// reach ships too late or not at all.
std::string Chance(const PlanReport& report, double share) {
  return report.result == PlanResult::kStormUnknown ? "unknown" : Percent(share);
}

void AddRoutes(const RescueCase& rescue, const PlanReport& report, std::string& text) {
  const RescueProblem& problem = rescue.problem;
  for (const ShipRoute& route : report.plan.routes) {
    const RescueShip& ship = problem.ships[static_cast<std::size_t>(route.ship)];
    text += "\n" + ship.name + ", " + Short(route.km, 1) + " km\n";
    for (const RescueOrder& order : route.orders) {
      text += "  " + Clock(rescue, order.time_s) + "  ";
      if (order.kind == OrderKind::kLeave) {
        text += "leave " + (order.port == kNone
                                ? std::string("its position")
                                : problem.ports[static_cast<std::size_t>(order.port)].name);
      } else if (order.kind == OrderKind::kFetch) {
        text += "fetch " + problem.devices[static_cast<std::size_t>(order.device)].name;
      } else {
        text += "deliver at " + problem.ports[static_cast<std::size_t>(order.port)].name;
      }
      text += "  [" + Chance(report, order.probability) + "]\n";
    }
  }
}

void AddDevices(const RescueCase& rescue, const PlanReport& report, std::string& text) {
  text += "\ndevice: chance to be in port; latest departure with 95, 80, 50 %; mean loss\n";
  for (std::size_t d = 0; d < rescue.problem.devices.size(); ++d) {
    const DeviceOutcome& outcome = report.plan.devices[d];
    text += "  " + rescue.problem.devices[d].name + ": ";
    if (report.result == PlanResult::kStormUnknown) {
      text += "unknown\n";
      continue;
    }
    text += (outcome.ship == kNone ? "left behind" : Percent(outcome.home)) + ";";
    for (const Deadline& deadline : report.deadlines[d]) {
      text += " " +
              (!deadline.leave_s  ? std::string("none")
               : deadline.is_open ? "not known beyond " + Clock(rescue, *deadline.leave_s)
                                  : Clock(rescue, *deadline.leave_s)) +
              (deadline.probability == kDeadlineShares.back() ? ";" : ",");
    }
    text += " " + Money(rescue, outcome.mean_loss) + " (" + Money(rescue, outcome.mean_loss_idle) +
            " if it stays)\n";
  }
}

// Adds a warning for each ship whose chance to deliver a device aboard is below 50 %, unless the
// ship already has the warning no_way_home. Also removes the note devices_aboard of these ships.
void WarnOfWaysHome(RescueCase& rescue, const PlanReport& report) {
  constexpr double kSafe = 0.5;
  const RescueProblem& problem = rescue.problem;
  for (std::size_t i = 0; i < problem.ships.size(); ++i) {
    const RescueShip& ship = problem.ships[i];
    const auto id = static_cast<std::int32_t>(i);
    if (ship.aboard.empty()) continue;
    const bool is_warned = std::any_of(
        rescue.warnings.begin(), rescue.warnings.end(),
        [id](const RescueWarning& one) { return one.code == "no_way_home" && one.ship == id; });
    std::string names;
    double home = 1.0;  // lowest chance of a device aboard to reach a port
    bool is_under_way = false;
    for (const std::int32_t device : ship.aboard) {
      const auto d = static_cast<std::size_t>(device);
      names += (names.empty() ? "" : ", ") + problem.devices[d].name;
      home = std::min(home, report.plan.devices[d].home);
      is_under_way = is_under_way || report.plan.devices[d].ship != kNone;
    }
    if (is_warned || home >= kSafe) continue;
    auto& warnings = rescue.warnings;
    // The note devices_aboard states that the orders of the ship deliver its devices.
    const auto promises = [id](const RescueWarning& one) {
      return one.code == "devices_aboard" && one.ship == id;
    };
    warnings.erase(std::remove_if(warnings.begin(), warnings.end(), promises), warnings.end());
    rescue.warnings.push_back(
        is_under_way
            ? RescueWarning{"winds_on_way_home", "stop",
                            ship.name + " has " + names +
                                " aboard, and winds stop it on its way home: the chance to deliver "
                                "is only " +
                                Percent(home) + ".",
                            "Seek shelter, unless its master judges the ordered way to be safer.",
                            id}
            : RescueWarning{"winds_on_way_home", "stop",
                            ship.name + " has " + names +
                                " aboard, and winds stop it before it can deliver: it stays in "
                                "port.",
                            "Keep it in port.", id});
  }
}

}  // namespace

LastDeparture LastDepartureOf(const RescueProblem& problem, const PlanReport& report) {
  const bool no_winds = report.result == PlanResult::kStormStaysAway;
  if (report.result == PlanResult::kStormUnknown || no_winds) return {};
  std::optional<double> latest;
  bool is_open = false;
  for (std::size_t d = 0; d < report.deadlines.size(); ++d) {
    if (problem.CarrierOf(d) != kNone) continue;
    const Deadline& deadline = report.deadlines[d].back();
    if (!deadline.leave_s) continue;
    latest = std::max(latest.value_or(*deadline.leave_s), *deadline.leave_s);
    is_open = is_open || deadline.is_open;
  }
  if (is_open) return {std::nullopt, latest};
  return {latest, std::nullopt};
}

PlanReport MakeReport(RescueCase& rescue, const Ensemble& ensemble) {
  PlanReport report;
  // With unknown winds the value of a trip is unknown. In this case only ships with devices aboard
  // get orders.
  const RescueProblem problem =
      AreWindsUnknown(rescue, ensemble) ? OnlyAboard(rescue.problem) : rescue.problem;
  report.plan = PlanRescue(problem, ensemble);
  report.deadlines = Deadlines(problem, ensemble, {kDeadlineShares.begin(), kDeadlineShares.end()});
  report.what_if = CompareChanges(problem, ensemble, report.plan);
  SetResult(rescue, ensemble, report);
  report.is_old = rescue.storm.age_h >= kOldBulletin_h;
  if (report.result != PlanResult::kStormUnknown) WarnOfWaysHome(rescue, report);
  const auto rank = [](const RescueWarning& one) {
    return one.severity == "stop" ? 0 : one.severity == "warning" ? 1 : 2;
  };
  std::stable_sort(
      rescue.warnings.begin(), rescue.warnings.end(),
      [&](const RescueWarning& a, const RescueWarning& b) { return rank(a) < rank(b); });
  return report;
}

std::string ToText(const RescueCase& rescue, const PlanReport& report) {
  std::string text = report.text + "\n";
  for (const RescueWarning& warning : rescue.warnings) {
    if (warning.text == report.text) continue;
    text += warning.severity + ": " + warning.text +
            (warning.advice.empty() ? "" : " " + warning.advice) + "\n";
  }
  AddRoutes(rescue, report, text);
  AddDevices(rescue, report, text);
  if (report.result == PlanResult::kStormUnknown) {
    return text + "\nDeadlines, losses and comparisons are unknown.\ntimes: local (UTC)\n";
  }
  const LossSummary loss = Summarize(report.plan.loss);
  text += "\nloss: mean " + Money(rescue, loss.mean) + ", 5 to 95 %: " + Money(rescue, loss.q05) +
          " to " + Money(rescue, loss.q95) +
          "; mean of the worst 5 %: " + Money(rescue, loss.cvar05) + "\n";
  const LastDeparture last = LastDepartureOf(rescue.problem, report);
  if (last.none_after_s) {
    text += "no ship should leave after " + Clock(rescue, *last.none_after_s) + "\n";
  }
  if (last.not_known_beyond_s) {
    text += "ships may leave at least until " + Clock(rescue, *last.not_known_beyond_s) +
            "; what follows is not known: plan again with the next bulletin\n";
  }
  text += "\nwhat if: mean loss, change\n";
  for (const WhatIf& row : report.what_if) {
    text +=
        "  " + row.text +
        (row.is_possible ? ": " + Money(rescue, row.loss.mean) + ", " +
                               (row.difference >= 0.05 ? "+" : "") + Money(rescue, row.difference)
                         : "") +
        "\n";
  }
  text += "times: local (UTC); chances: shares of " + std::to_string(report.plan.loss.size()) +
          " possible storms\n";
  return text;
}

}  // namespace aquafarm::agents
