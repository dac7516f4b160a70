// SPDX-License-Identifier: BSD-3-Clause
#include "rescue/follow_trips.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace aquafarm::agents {
namespace {

// Follows trips and computes the routes and outcomes of a plan.
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

  void Follow(const ShipTrips& trips) {
    ship_ = trips.ship;
    const RescueShip& own = model_.problem().ships[ship_];
    time_s_ = own.ready_s;
    place_ = model_.PlaceOfShip(ship_);
    alive_.assign(plan_.loss.size(), 1);
    model_.Stay(own.cell, time_s_, alive_);
    ShipRoute route;
    route.ship = static_cast<std::int32_t>(ship_);
    aboard_ = own.aboard;
    for (const std::int32_t device : aboard_) {
      plan_.devices[static_cast<std::size_t>(device)].fetch_s = time_s_;
    }
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
    route.kwh += order.kwh;
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

  // Moves the ship to `to`, an end point in TripModel. Sets distance and energy of `order`.
  void Sail(std::size_t to, ShipRoute& route, RescueOrder& order) {
    const SeaRoute& way = model_.routes().Between(place_, to);
    for (std::size_t i = 0; i < way.cells.size(); ++i) {
      route.path.push_back({way.cells[i], time_s_ + way.length[i] * model_.Pace(ship_)});
    }
    const TripEffort effort = model_.Effort(ship_, place_, to, aboard_.size());
    model_.Move(ship_, place_, to, time_s_, alive_);
    place_ = to;
    order.km = way.length.back() * model_.problem().cell_size_km;
    order.kwh = effort.kwh;
    route.hours += effort.hours;
    plan_.cost += model_.Cost(effort);
  }

  void Fetch(std::size_t device, ShipRoute& route) {
    RescueOrder order;
    order.kind = OrderKind::kFetch;
    order.device = static_cast<std::int32_t>(device);
    Sail(model_.PlaceOfDevice(device), route, order);
    order.cell = model_.problem().devices[device].cell;
    plan_.devices[device].fetch_s = time_s_;
    aboard_.push_back(order.device);
    Add(std::move(order), route);
  }

  void Deliver(std::size_t port, ShipRoute& route) {
    RescueOrder order;
    order.kind = OrderKind::kDeliver;
    order.port = static_cast<std::int32_t>(port);
    Sail(model_.PlaceOfPort(port), route, order);
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
    plan_.saved += saved;
    outcome.mean_loss = std::max(0.0, outcome.mean_loss_idle - saved);
    const float* idle = model_.LossIdle(device);
    const float* until = model_.LossUntil(device, time_s_);
    for (std::size_t member = 0; member < alive_.size(); ++member) {
      if (alive_[member] == 0) continue;
      plan_.loss[member] = std::max(0.0F, plan_.loss[member] - (idle[member] - until[member]));
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

// Assigns the devices to the ships by a rule, one device at a time.
class SimpleRule {
 public:
  SimpleRule(const TripModel& model, FetchRule rule) : model_(model), rule_(rule) {
    const RescueProblem& problem = model.problem();
    for (std::size_t ship = 0; ship < problem.ships.size(); ++ship) {
      const RescueShip& own = problem.ships[ship];
      ships_.push_back({{ship, {}},
                        model.PlaceOfShip(ship),
                        own.ready_s,
                        static_cast<std::int32_t>(own.aboard.size())});
    }
    for (std::size_t d = 0; d < problem.devices.size(); ++d) {
      if (problem.CarrierOf(d) == kNone) waiting_.push_back(d);
    }
  }

  std::vector<ShipTrips> Take() {
    for (Ship* next = Next(); next != nullptr; next = Next()) Order(*next);
    std::vector<ShipTrips> trips;
    for (Ship& ship : ships_) {
      if (!ship.trips.stops.empty()) trips.push_back(std::move(ship.trips));
    }
    return trips;
  }

 private:
  struct Ship {
    ShipTrips trips;
    std::size_t place{};
    double time_s{};
    std::int32_t aboard{};
    bool is_done{};
  };

  Ship* Next() {
    Ship* next = nullptr;
    for (Ship& ship : ships_) {
      if (!ship.is_done && (next == nullptr || ship.time_s < next->time_s)) next = &ship;
    }
    return next;
  }

  void Order(Ship& ship) {
    const std::int32_t capacity = model_.problem().ships[ship.trips.ship].capacity;
    const std::size_t best = ship.aboard < capacity ? Choose(ship) : waiting_.size();
    if (best < waiting_.size()) {
      Go(ship, model_.PlaceOfDevice(waiting_[best]), {OrderKind::kFetch, waiting_[best]});
      waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(best));
      ++ship.aboard;
      return;
    }
    const std::int32_t port = ship.aboard > 0 ? model_.NearestPort(ship.place) : kNone;
    ship.is_done = port == kNone;
    if (ship.is_done) return;
    const auto target = static_cast<std::size_t>(port);
    Go(ship, model_.PlaceOfPort(target), {OrderKind::kDeliver, target});
    ship.aboard = 0;
  }

  // Returns the index in `waiting_` of the next device; waiting_.size() if no device is reachable.
  std::size_t Choose(const Ship& ship) const {
    std::size_t best = waiting_.size();
    double best_score = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
      const double length = model_.routes().Length(ship.place, model_.PlaceOfDevice(waiting_[i]));
      const double score =
          rule_ == FetchRule::kValue ? model_.problem().devices[waiting_[i]].value : -length;
      if (length == std::numeric_limits<double>::infinity() || score <= best_score) continue;
      best_score = score;
      best = i;
    }
    return best;
  }

  void Go(Ship& ship, std::size_t place, TripStop stop) {
    const double way_s = model_.routes().Length(ship.place, place) * model_.Pace(ship.trips.ship);
    ship.time_s += way_s + model_.problem().handling_s;
    ship.place = place;
    ship.trips.stops.push_back(stop);
  }

  const TripModel& model_;
  FetchRule rule_;
  std::vector<Ship> ships_;
  std::vector<std::size_t> waiting_;
};

}  // namespace

RescuePlan FollowTrips(const TripModel& model, const std::vector<ShipTrips>& trips) {
  RescuePlan plan;
  Follower follower(model, plan);
  for (const ShipTrips& of_ship : trips) follower.Follow(of_ship);
  return plan;
}

std::vector<ShipTrips> SimpleTrips(const TripModel& model, FetchRule rule) {
  return SimpleRule(model, rule).Take();
}

}  // namespace aquafarm::agents
