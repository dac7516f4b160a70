// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/rescue/rescue_plan.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "aquafarm/base/check.h"
#include "rescue/trip_search.h"

namespace aquafarm::agents {
namespace {

// Sets of trips of several ships that the combination keeps.
constexpr std::size_t kMostTeams = 3000;
// Plans per set of devices among which a risk-averse plan is chosen.
constexpr std::size_t kAlternatives = 8;

// Trips of the ships so far.
struct Team {
  DeviceSet devices{};
  double saved{};
  std::vector<const TripPlan*> trips;  // by ship; nullptr: it stays
};

void RequireValid(const RescueProblem& problem) {
  const auto require = [](bool ok, const std::string& name, const std::string& what) {
    if (!ok) throw InputError(name + ": " + what);
  };
  require(problem.devices.size() <= kMaxRescueDevices, "devices",
          "got " + std::to_string(problem.devices.size()) + ", expected at most " +
              std::to_string(kMaxRescueDevices));
  require(!problem.ports.empty(), "ports", "got none, expected at least one");
  require(problem.risk_averse >= 0.0 && problem.risk_averse <= 1.0, "risk averse",
          "expected a share in [0, 1]");
  for (const RescueDevice& device : problem.devices) {
    require(std::isfinite(device.value) && device.value >= 0.0, device.name,
            "value: expected a number of at least 0");
    require(device.damage_before >= 0.0 && device.damage_before <= 1.0, device.name,
            "damaged: expected a share in [0, 1]");
  }
  for (const RescueShip& ship : problem.ships) {
    require(ship.speed_kn > 0.0 && std::isfinite(ship.speed_kn), ship.name,
            "speed: expected more than 0 knots");
    require(ship.capacity >= 1, ship.name, "capacity: expected at least 1");
    require(ship.ready_s >= 0.0, ship.name, "ready: expected a time after the start of the plan");
  }
}

// Follows the trips of a plan and computes what they mean for ships and devices.
class Follower {
 public:
  Follower(const TripModel& model, RescuePlan& plan) : model_(model), plan_(plan) {
    const auto members = static_cast<std::size_t>(model.ensemble().members());
    const auto& devices = model.problem().devices;
    plan_.loss_idle.assign(members, 0.0F);
    plan_.home_count.assign(members, 0);
    plan_.devices.resize(devices.size());
    for (std::size_t d = 0; d < devices.size(); ++d) {
      const float* idle = model.LossIdle(d);
      double sum = 0.0;
      for (std::size_t member = 0; member < members; ++member) {
        plan_.loss_idle[member] += idle[member];
        sum += static_cast<double>(idle[member]);
      }
      DeviceOutcome& outcome = plan_.devices[d];
      outcome.mean_loss_idle = outcome.mean_loss = sum / static_cast<double>(members);
      outcome.home_before.assign(static_cast<std::size_t>(model.ensemble().rings()), 0.0);
    }
    plan_.loss = plan_.loss_idle;
  }

  void Follow(std::size_t ship, const TripPlan& trips) {
    ship_ = ship;
    const RescueShip& own = model_.problem().ships[ship];
    time_s_ = own.ready_s;
    place_ = model_.PlaceOfShip(ship);
    alive_.assign(plan_.loss.size(), 1);
    model_.Stay(own.cell, time_s_, alive_);
    ShipRoute route;
    route.ship = static_cast<std::int32_t>(ship);
    aboard_.clear();
    bool in_port = true;
    for (const TripStop& stop : trips.stops) {
      if (in_port) Leave(route);
      stop.kind == OrderKind::kFetch ? Fetch(stop.target, route) : Deliver(stop.target, route);
      in_port = stop.kind == OrderKind::kDeliver;
    }
    plan_.routes.push_back(std::move(route));
  }

 private:
  double Share(std::int32_t count) const {
    return static_cast<double>(count) / static_cast<double>(alive_.size());
  }
  void Add(RescueOrder order, ShipRoute& route) const {
    order.time_s = time_s_;
    order.probability = Share(CountAlive(alive_));
    route.km += order.km;
    route.orders.push_back(std::move(order));
  }

  void Leave(ShipRoute& route) const {
    RescueOrder order;
    order.kind = OrderKind::kLeave;
    const RescueProblem& problem = model_.problem();
    order.cell = route.path.empty() ? problem.ships[ship_].cell : route.path.back().cell;
    for (std::size_t port = 0; port < problem.ports.size(); ++port) {
      if (problem.ports[port].cell == order.cell) order.port = static_cast<std::int32_t>(port);
    }
    Add(std::move(order), route);
  }

  // Returns the distance [km].
  double Sail(std::size_t to, ShipRoute& route) {
    const SeaRoute& way = model_.routes().Between(place_, to);
    for (std::size_t i = 0; i < way.cells.size(); ++i) {
      route.path.push_back({way.cells[i], time_s_ + way.length[i] * model_.Pace(ship_)});
    }
    model_.Move(ship_, place_, to, time_s_, alive_);
    place_ = to;
    return way.length.back() * model_.problem().cell_size_km;
  }

  void Fetch(std::size_t device, ShipRoute& route) {
    RescueOrder order;
    order.kind = OrderKind::kFetch;
    order.device = static_cast<std::int32_t>(device);
    order.km = Sail(model_.PlaceOfDevice(device), route);
    order.cell = model_.problem().devices[device].cell;
    plan_.devices[device].fetch_s = time_s_;
    aboard_.push_back(order.device);
    Add(std::move(order), route);
  }

  void Deliver(std::size_t port, ShipRoute& route) {
    RescueOrder order;
    order.kind = OrderKind::kDeliver;
    order.port = static_cast<std::int32_t>(port);
    order.km = Sail(model_.PlaceOfPort(port), route);
    order.cell = model_.problem().ports[port].cell;
    order.devices = aboard_;
    for (const std::int32_t device : aboard_) Save(static_cast<std::size_t>(device), order.port);
    aboard_.clear();
    Add(std::move(order), route);
  }

  void Save(std::size_t device, std::int32_t port) {
    DeviceOutcome& outcome = plan_.devices[device];
    outcome.ship = static_cast<std::int32_t>(ship_);
    outcome.port = port;
    outcome.deliver_s = time_s_;
    outcome.home = Share(CountAlive(alive_));
    const double saved = model_.Saved(device, time_s_, alive_);
    outcome.mean_loss = outcome.mean_loss_idle - saved;
    const float* idle = model_.LossIdle(device);
    const float* until = model_.LossUntil(device, time_s_);
    for (std::size_t member = 0; member < alive_.size(); ++member) {
      if (alive_[member] == 0) continue;
      plan_.loss[member] -= idle[member] - until[member];
      ++plan_.home_count[member];
    }
    const Ensemble& ensemble = model_.ensemble();
    const Cell site = model_.problem().devices[device].cell;
    for (std::int32_t ring = 0; ring < ensemble.rings(); ++ring) {
      const std::int16_t* arrival = ensemble.Arrival(ring, site);
      std::int32_t before = 0;
      for (std::size_t member = 0; member < alive_.size(); ++member) {
        const bool is_first = arrival[member] == Ensemble::kNoArrival ||
                              arrival[member] * ensemble.options().step_s > time_s_;
        before += alive_[member] != 0 && is_first ? 1 : 0;
      }
      outcome.home_before[static_cast<std::size_t>(ring)] = Share(before);
    }
  }

  const TripModel& model_;
  RescuePlan& plan_;
  std::size_t ship_{};
  std::size_t place_{};
  double time_s_{};
  Alive alive_;
  std::vector<std::int32_t> aboard_;
};

RescuePlan PlanOf(const TripModel& model, const Team& team) {
  RescuePlan plan;
  Follower follower(model, plan);
  for (std::size_t ship = 0; ship < team.trips.size(); ++ship) {
    if (team.trips[ship] != nullptr) follower.Follow(ship, *team.trips[ship]);
  }
  plan.saved = team.saved;
  return plan;
}

// Keeps the best teams of each set of devices, and of all sets.
bool Narrow(std::vector<Team>& teams, std::size_t alternatives) {
  std::stable_sort(teams.begin(), teams.end(),
                   [](const Team& a, const Team& b) { return a.saved > b.saved; });
  std::map<DeviceSet, std::size_t> count;
  const auto is_spare = [&](const Team& team) { return ++count[team.devices] > alternatives; };
  teams.erase(std::remove_if(teams.begin(), teams.end(), is_spare), teams.end());
  if (teams.size() <= kMostTeams) return false;
  teams.resize(kMostTeams);
  return true;
}

}  // namespace

double MeanOfWorst(std::vector<float> losses, double share) {
  AQUAFARM_CHECK_LT(std::size_t{0}, losses.size());
  std::sort(losses.begin(), losses.end(), std::greater<>());
  const double wanted = std::max(1e-9, share * static_cast<double>(losses.size()));
  double sum = 0.0;
  double rest = wanted;
  for (std::size_t i = 0; i < losses.size() && rest > 0.0; ++i, rest -= 1.0) {
    sum += static_cast<double>(losses[i]) * std::min(1.0, rest);
  }
  return sum / wanted;
}

LossSummary Summarize(std::vector<float> losses) {
  AQUAFARM_CHECK_LT(std::size_t{0}, losses.size());
  std::sort(losses.begin(), losses.end());
  const auto count = static_cast<double>(losses.size());
  LossSummary summary;
  for (const float loss : losses) summary.mean += static_cast<double>(loss) / count;
  double squares = 0.0;
  for (const float loss : losses) {
    squares += std::pow(static_cast<double>(loss) - summary.mean, 2.0);
  }
  summary.standard_error = losses.size() < 2 ? 0.0 : std::sqrt(squares / (count - 1.0) / count);
  const auto quantile = [&](double share) {
    return static_cast<double>(losses[static_cast<std::size_t>(share * (count - 1.0) + 0.5)]);
  };
  summary.q05 = quantile(0.05);
  summary.q50 = quantile(0.5);
  summary.q95 = quantile(0.95);
  summary.cvar05 = MeanOfWorst(losses, 0.05);
  return summary;
}

RescuePlan PlanRescue(const RescueProblem& problem, const Ensemble& ensemble) {
  RequireValid(problem);
  const TripModel model(problem, ensemble);
  const std::size_t alternatives = problem.risk_averse > 0.0 ? kAlternatives : 1;
  // Ships of one kind in one place have the same trips.
  using Kind = std::tuple<std::size_t, double, double, std::int32_t>;
  std::map<Kind, TripTable> tables;
  std::vector<Team> teams(1);
  bool is_exhaustive = true;
  for (std::size_t ship = 0; ship < problem.ships.size(); ++ship) {
    const RescueShip& one = problem.ships[ship];
    const auto cell = static_cast<std::size_t>(one.cell.y * problem.water.cols() + one.cell.x);
    const Kind kind{cell, one.speed_kn, one.ready_s, one.capacity};
    if (tables.count(kind) == 0) tables[kind] = SearchTrips(model, ship, alternatives);
    const TripTable& table = tables[kind];
    is_exhaustive = is_exhaustive && table.is_exhaustive;
    std::vector<Team> next;
    for (const Team& team : teams) {
      next.push_back(team);
      next.back().trips.push_back(nullptr);
      for (const auto& [devices, plans] : table.plans) {
        if ((team.devices & devices) != 0) continue;
        for (const TripPlan& trips : plans) {
          next.push_back({team.devices | devices, team.saved + trips.saved, team.trips});
          next.back().trips.push_back(&trips);
        }
      }
    }
    if (Narrow(next, alternatives)) is_exhaustive = false;
    teams = std::move(next);
  }
  RescuePlan best = PlanOf(model, teams.front());  // the best mean
  for (std::size_t i = 1; i < teams.size() && problem.risk_averse > 0.0; ++i) {
    RescuePlan other = PlanOf(model, teams[i]);
    if (MeanOfWorst(other.loss, problem.risk_averse) <
        MeanOfWorst(best.loss, problem.risk_averse)) {
      best = std::move(other);
    }
  }
  for (std::size_t d = 0; d < problem.devices.size(); ++d) best.bound += model.BoundOf(d);
  best.is_exhaustive = is_exhaustive;
  return best;
}

}  // namespace aquafarm::agents
