// SPDX-License-Identifier: BSD-3-Clause
#include "rescue/trip_search.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace aquafarm::agents {
namespace {

// Max number of partial sequences with the same number of stops that the search keeps.
constexpr std::size_t kWidth = 6000;

constexpr DeviceSet Bit(std::size_t device) { return DeviceSet{1} << device; }

class TripSearch {
 public:
  TripSearch(const TripModel& model, std::size_t ship, std::size_t alternatives,
             const MemberWeights& weights)
      : model_(model), ship_(ship), alternatives_(alternatives), weights_(weights) {
    for (std::size_t d = 0; d < Devices(); ++d) bound_.push_back(model.BoundOf(d, weights));
    std::vector<Node> layer(1);
    Node& start = layer[0];
    for (const std::int32_t device : Ship().aboard) {
      start.aboard |= Bit(static_cast<std::size_t>(device));
    }
    start.taken = start.aboard;
    for (std::size_t d = 0; d < Devices(); ++d) {
      const bool is_fetchable =
          model.problem().CarrierOf(d) == kNone || (start.taken & Bit(d)) != 0;
      if (!is_fetchable) bound_[d] = 0.0;  // another ship carries it
    }
    start.place = model.PlaceOfShip(ship);
    start.time_s = Ship().ready_s;
    start.alive.assign(static_cast<std::size_t>(model.ensemble().members()), 1);
    model.Stay(Ship().cell, start.time_s, start.alive);
    while (!layer.empty()) {
      std::vector<Node> next;
      for (const Node& node : layer) Expand(node, next);
      Narrow(next);
      layer = std::move(next);
    }
  }
  TripTable Take() { return std::move(table_); }

 private:
  struct Node {
    std::size_t place{};
    double time_s{};
    double net{};       // value saved minus cost so far
    double settled{};   // net value after the last delivery
    DeviceSet taken{};  // devices aboard or delivered
    DeviceSet aboard{};
    std::vector<TripStop> stops;
    Alive alive;
  };

  const RescueShip& Ship() const { return model_.problem().ships[ship_]; }
  std::size_t Devices() const { return model_.problem().devices.size(); }
  bool IsInPort() const {
    const auto& ports = model_.problem().ports;
    return std::any_of(ports.begin(), ports.end(),
                       [this](const RescuePort& port) { return port.cell == Ship().cell; });
  }
  static std::int32_t Count(DeviceSet set) {
    std::int32_t count = 0;
    for (; set != 0; set &= set - 1) ++count;
    return count;
  }

  void Expand(const Node& node, std::vector<Node>& next) {
    if (Count(node.aboard) < Ship().capacity) {
      for (std::size_t d = 0; d < Devices(); ++d) {
        if ((node.taken & Bit(d)) == 0 && bound_[d] > 0.0) Fetch(node, d, next);
      }
    }
    if (node.aboard == 0) return;
    const std::vector<std::size_t> ports = node.stops.empty() ? OpenPorts(node) : PortsAfter(node);
    for (const std::size_t port : ports) Deliver(node, port, next);
  }

  // Returns all open ports, the nearest one first.
  std::vector<std::size_t> OpenPorts(const Node& node) const {
    std::vector<std::size_t> ports;
    for (std::size_t port = 0; port < model_.problem().ports.size(); ++port) {
      if (model_.problem().ports[port].is_open) ports.push_back(port);
    }
    const auto length = [&](std::size_t port) {
      return model_.routes().Length(node.place, model_.PlaceOfPort(port));
    };
    std::stable_sort(ports.begin(), ports.end(),
                     [&](std::size_t a, std::size_t b) { return length(a) < length(b); });
    return ports;
  }

  // Returns the nearest open port and, for each remaining device, the open port through which the
  // route of the ship to this device is shortest.
  std::vector<std::size_t> PortsAfter(const Node& node) const {
    const std::int32_t nearest = model_.NearestPort(node.place);
    if (nearest == kNone) return {};
    std::vector<std::size_t> ports{static_cast<std::size_t>(nearest)};
    const SeaRoutes& routes = model_.routes();
    for (std::size_t d = 0; d < Devices(); ++d) {
      if ((node.taken & Bit(d)) != 0) continue;
      std::size_t best = ports[0];
      const auto length = [&](std::size_t port) {
        return routes.Length(node.place, model_.PlaceOfPort(port)) +
               routes.Length(model_.PlaceOfPort(port), model_.PlaceOfDevice(d));
      };
      for (std::size_t port = 0; port < model_.problem().ports.size(); ++port) {
        if (model_.problem().ports[port].is_open && length(port) < length(best)) best = port;
      }
      if (std::find(ports.begin(), ports.end(), best) == ports.end()) ports.push_back(best);
    }
    return ports;
  }

  bool Go(const Node& node, std::size_t place, TripStop stop, Node& child) const {
    if (model_.routes().Between(node.place, place).cells.empty()) return false;
    child = node;
    child.place = place;
    child.stops.push_back(stop);
    const auto aboard = static_cast<std::size_t>(Count(node.aboard));
    child.net -= model_.Cost(model_.Effort(ship_, node.place, place, aboard));
    model_.Move(ship_, node.place, place, child.time_s, child.alive);
    return true;
  }

  void Fetch(const Node& node, std::size_t device, std::vector<Node>& next) const {
    Node child;
    if (!Go(node, model_.PlaceOfDevice(device), {OrderKind::kFetch, device}, child)) return;
    if (CountAlive(child.alive) == 0) return;
    child.taken |= Bit(device);
    child.aboard |= Bit(device);
    next.push_back(std::move(child));
  }

  void Deliver(const Node& node, std::size_t port, std::vector<Node>& next) {
    Node child;
    if (!Go(node, model_.PlaceOfPort(port), {OrderKind::kDeliver, port}, child)) return;
    for (std::size_t d = 0; d < Devices(); ++d) {
      if ((child.aboard & Bit(d)) == 0) continue;
      child.net += model_.Saved(d, child.time_s, child.alive, weights_);
    }
    // A delivery that does not increase the net value is left out. If it is the first stop, it is
    // kept, because a ship that starts with devices aboard must deliver them. Such a ship stays
    // only if it is in a port and winds stop it in all members.
    if (child.net <= node.settled && !node.stops.empty()) return;
    if (node.stops.empty() && IsInPort() && CountAlive(child.alive) == 0) return;
    child.aboard = 0;
    child.settled = child.net;
    Record(child);
    if (CountAlive(child.alive) > 0) next.push_back(std::move(child));
  }

  void Record(const Node& node) {
    std::vector<TripPlan>& plans = table_.plans[node.taken];
    const auto at = std::find_if(plans.begin(), plans.end(),
                                 [&](const TripPlan& plan) { return plan.net < node.net; });
    if (at == plans.end() && plans.size() >= alternatives_) return;
    plans.insert(at, {node.taken, node.net, node.stops});
    if (plans.size() > alternatives_) plans.pop_back();
  }

  double Promise(const Node& node) const {
    double promise = node.net;
    for (std::size_t d = 0; d < Devices(); ++d) {
      if ((node.taken & Bit(d)) == 0 || (node.aboard & Bit(d)) != 0) promise += bound_[d];
    }
    return promise - 1e-9 * node.time_s;  // prefers the earlier one of two equal promises
  }

  void Narrow(std::vector<Node>& layer) {
    if (layer.size() <= kWidth) return;
    table_.is_exhaustive = false;
    std::vector<double> promises;
    for (const Node& node : layer) promises.push_back(Promise(node));
    std::vector<std::size_t> order(layer.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::nth_element(order.begin(), order.begin() + kWidth, order.end(),
                     [&](std::size_t a, std::size_t b) {
                       return promises[a] != promises[b] ? promises[a] > promises[b] : a < b;
                     });
    std::vector<Node> kept;
    for (std::size_t i = 0; i < kWidth; ++i) kept.push_back(std::move(layer[order[i]]));
    layer = std::move(kept);
  }

  const TripModel& model_;
  std::size_t ship_;
  std::size_t alternatives_;
  const MemberWeights& weights_;
  std::vector<double> bound_;  // by device
  TripTable table_;
};

}  // namespace

TripTable SearchTrips(const TripModel& model, std::size_t ship, std::size_t alternatives,
                      const MemberWeights& weights) {
  return TripSearch(model, ship, alternatives, weights).Take();
}

}  // namespace aquafarm::agents
