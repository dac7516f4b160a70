// SPDX-License-Identifier: BSD-3-Clause
#include "rescue/reacting_trial.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/energy.h"
#include "aquafarm/tracks/track.h"

namespace aquafarm::agents {
namespace {

std::shared_ptr<const Scenario> WithoutDisasters(const Scenario& scenario) {
  Scenario calm = scenario;
  calm.disasters.clear();
  return std::make_shared<const Scenario>(std::move(calm));
}

// Returns the central forecast in steps of `step_s`.
CentralForecast InStepsOf(double step_s, const RescueCase& rescue) {
  CentralForecast forecast = rescue.forecast;
  for (StormPoint& point : forecast.path.points) point.step *= rescue.ensemble.step_s / step_s;
  forecast.path.step_duration_s = step_s;
  return forecast;
}

// Returns the risks of the central forecast in steps of a farm, from the farm's present step on.
RiskField RisksOf(const RescueCase& rescue, const Farm& farm) {
  const Scenario& scenario = farm.scenario();
  EnsembleOptions options = rescue.ensemble;
  options.members = 1;
  options.errors.scale = 0.0;
  options.step_s = scenario.step_duration_s;
  options.steps =
      static_cast<std::int32_t>(rescue.ensemble.steps * rescue.ensemble.step_s / options.step_s) +
      1;
  const Ensemble central(InStepsOf(options.step_s, rescue), options, rescue.Sites());
  RiskField risks = central.MeanRisk(0, scenario.rewards.step);
  constexpr auto kTyphoon = static_cast<std::size_t>(DisasterKind::kTyphoon);
  const std::vector<DeviceKind> kinds = KindsThatMatter(farm);
  std::vector<RiskLayers> layers;
  for (std::int32_t step = 0; step <= risks.last_step(); ++step) {
    layers.push_back(risks.At(step));
    for (const DeviceKind kind : kinds) {
      layers.back().by_kind[static_cast<std::size_t>(kind)] =
          layers.back().risk * scenario.damage.FactorsOf(kind)[kTyphoon];
    }
  }
  return {farm.step(), std::move(layers)};
}

}  // namespace

void PlanAgain::Plan(RescueCase known, const TrialFleet& fleet) {
  acts_.clear();
  RescueProblem& problem = known.problem;
  AQUAFARM_CHECK_EQ(problem.ships.size(), std::size_t{1});
  RescueShip& ship = problem.ships[0];
  ship.cell = fleet.cell;
  ship.ready_s = fleet.time_s;
  std::vector<std::size_t> ids;
  std::vector<RescueDevice> left;
  for (std::size_t d = 0; d < problem.devices.size(); ++d) {
    if (fleet.is_delivered[d]) continue;
    left.push_back(problem.devices[d]);
    left.back().damage_before = std::min(1.0, left.back().damage_before + fleet.lost[d]);
    if (std::count(fleet.aboard.begin(), fleet.aboard.end(), d) > 0) {
      left.back().cell = fleet.cell;
      ship.aboard.push_back(static_cast<std::int32_t>(ids.size()));
    }
    ids.push_back(d);
  }
  problem.devices = std::move(left);
  if (ids.empty()) return;
  const RescuePlan plan =
      PlanRescue(problem, Ensemble(known.forecast, known.ensemble, known.Sites()));
  if (plan.routes.empty()) return;
  const ShipRoute& route = plan.routes[0];
  double time_s = fleet.time_s;
  std::size_t at = 0;
  for (const RescueOrder& order : route.orders) {
    if (order.kind == OrderKind::kLeave) continue;
    constexpr double kSame_s = 1e-3;
    for (; at < route.path.size() && route.path[at].time_s < order.time_s - kSame_s; ++at) {
      const double seconds = route.path[at].time_s - time_s;
      if (seconds > kSame_s) acts_.push_back({route.path[at].cell, seconds, std::nullopt, 0});
      time_s = std::max(time_s, route.path[at].time_s);
    }
    const bool is_fetch = order.kind == OrderKind::kFetch;
    acts_.push_back({order.cell, order.time_s - time_s, order.kind,
                     is_fetch ? ids[static_cast<std::size_t>(order.device)] : 0});
    time_s = order.time_s;
  }
}

std::optional<TrialAct> PlanAgain::Next() {
  if (acts_.empty()) return std::nullopt;
  const TrialAct act = acts_.front();
  acts_.pop_front();
  return act;
}

PlannerSkipper::PlannerSkipper(const RescueCase& rescue)
    : calm_(WithoutDisasters(*rescue.scenario)),
      farm_(calm_),
      planner_(*calm_),
      handling_s_(rescue.problem.handling_s) {
  AQUAFARM_CHECK_EQ(rescue.problem.ships.size(), std::size_t{1});
  AQUAFARM_CHECK_EQ(farm_.ships().size(), std::size_t{1});
  AQUAFARM_CHECK_EQ(farm_.devices().size(), rescue.problem.devices.size());
  const RescueShip& ship = rescue.problem.ships[0];
  pace_s_ = rescue.problem.cell_size_km * 1000.0 / (ship.speed_kn * kMpsPerKnot);
  farm_.PlaceShip(0, ship.cell);
}

void PlannerSkipper::Plan(RescueCase known, const TrialFleet&) {
  actions_.clear();
  if (farm_.over()) return;
  RiskField risks = RisksOf(known, farm_);
  Task task;
  for (std::size_t id = 0; id < farm_.devices().size(); ++id) {
    task.devices.push_back(static_cast<std::int32_t>(id));
  }
  const agents::Plan plan = planner_.Solve(farm_, risks, task);
  actions_.assign(plan.actions.begin(), plan.actions.end());
}

std::optional<TrialAct> PlannerSkipper::Next() {
  if (actions_.empty() || farm_.over()) return std::nullopt;
  const std::uint8_t action = actions_.front();
  actions_.pop_front();
  const Cell from = farm_.ships()[0].cell;
  std::vector<DeviceStatus> before;
  for (const Device& device : farm_.devices()) before.push_back(device.status);
  farm_.Step(&action);
  TrialAct act{farm_.ships()[0].cell, handling_s_, std::nullopt, 0};
  if (act.cell != from) {
    act.seconds = pace_s_ * MoveLength(static_cast<Action>(action));
    return act;
  }
  for (std::size_t d = 0; d < before.size(); ++d) {
    const DeviceStatus now = farm_.devices()[d].status;
    if (now == before[d]) continue;
    act.kind = now == DeviceStatus::kAboard ? OrderKind::kFetch : OrderKind::kDeliver;
    act.device = d;
  }
  return act;
}

double PlayReacting(const TripModel& model, const std::vector<TrialBulletin>& bulletins,
                    Skipper& skipper) {
  const std::vector<RescueDevice>& devices = model.problem().devices;
  const RescueShip& ship = model.problem().ships.at(0);
  TrialFleet fleet{ship.cell, ship.ready_s, {}, std::vector<bool>(devices.size(), false), {}};
  Alive alive(1, 1);
  double saved = 0.0;
  for (std::size_t next = 0; alive[0] != 0;) {
    std::size_t due = next;
    while (due < bulletins.size() && bulletins[due].time_s <= fleet.time_s) ++due;
    if (due > next) {
      fleet.lost.clear();
      for (std::size_t d = 0; d < devices.size(); ++d) {
        const auto lost = static_cast<double>(model.LossUntil(d, fleet.time_s)[0]);
        fleet.lost.push_back(devices[d].value > 0.0 ? lost / devices[d].value : 0.0);
      }
      TrialFleet seen = fleet;
      seen.time_s -= bulletins[due - 1].time_s;
      skipper.Plan(bulletins[due - 1].known(), seen);
      next = due;
    }
    const std::optional<TrialAct> act = skipper.Next();
    if (!act && next == bulletins.size()) break;
    // During a move a ship counts as being in the cell that it leaves.
    fleet.time_s = act ? fleet.time_s + act->seconds : bulletins[next].time_s;
    model.Stay(fleet.cell, fleet.time_s, alive);
    if (!act || alive[0] == 0) continue;
    fleet.cell = act->cell;
    if (act->kind == OrderKind::kFetch) fleet.aboard.push_back(act->device);
    if (act->kind != OrderKind::kDeliver) continue;
    for (const std::size_t d : fleet.aboard) {
      fleet.is_delivered[d] = true;
      saved += static_cast<double>(model.LossIdle(d)[0] - model.LossUntil(d, fleet.time_s)[0]);
    }
    fleet.aboard.clear();
  }
  return saved;
}

}  // namespace aquafarm::agents
