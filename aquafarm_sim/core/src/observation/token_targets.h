// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The devices and ports that have a token, and the lengths of the routes between them.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "aquafarm/farm/route_table.h"
#include "aquafarm/observation/view.h"

namespace aquafarm {

/// Keeps at most `slots` ids, in id order. If more are added, keeps those with the smallest
/// distance; at equal distance the lower id.
template <std::size_t slots>
class Kept {
 public:
  /// Adds an id. Ids must be added in ascending order.
  void Add(std::int32_t id, float distance) {
    if (count_ < slots) {
      Put(count_++, id, distance);
      return;
    }
    std::size_t farthest = 0;
    for (std::size_t i = 1; i < slots; ++i) {
      if (distance_[i] >= distance_[farthest]) farthest = i;
    }
    if (distance >= distance_[farthest]) return;
    for (std::size_t i = farthest; i + 1 < slots; ++i) Put(i, id_[i + 1], distance_[i + 1]);
    Put(slots - 1, id, distance);
  }
  std::size_t size() const { return count_; }
  std::size_t operator[](std::size_t slot) const { return static_cast<std::size_t>(id_[slot]); }

 private:
  void Put(std::size_t slot, std::int32_t id, float distance) {
    id_[slot] = id;
    distance_[slot] = distance;
  }
  std::array<std::int32_t, slots> id_{};
  std::array<float, slots> distance_{};
  std::size_t count_{};
};

/// Returns the routes from a cell in Layout::routes, [Layout::route_count()]: the routes to all
/// ports and then those to all fetchable devices.
inline const RouteEntry* RoutesFrom(const View& view, Cell cell) {
  const auto index = static_cast<std::size_t>(LinearIndex(cell, view.scenario->width));
  return view.layout->routes.data() + index * view.layout->route_count();
}

/// The targets of a ship that have a slot: ports, and fetchable devices that are deployed or aboard
/// the ship. If there are more targets than slots, the nearest ones by water are kept. Devices
/// aboard count as nearest.
/// @tparam kDevices slots for devices
/// @tparam kPorts slots for ports
template <std::size_t kDevices, std::size_t kPorts>
class TargetsOf {
 public:
  explicit TargetsOf(const View& view) : view_(view) {
    const RouteEntry* const routes = RoutesFrom(view, view.self);
    for (std::size_t id = 0; id < view.layout->ports.size(); ++id) {
      ports_.Add(static_cast<std::int32_t>(id), static_cast<float>(routes[id].steps));
    }
    std::size_t route = view.layout->ports.size();
    for (std::size_t id = 0; id < view.devices.size(); ++id) {
      const KnownDevice& device = view.devices[id];
      if (device.self_propelled) continue;
      const std::size_t own_route = route++;
      if (device.aboard_self) devices_.Add(static_cast<std::int32_t>(id), -1.0F);
      if (device.status != DeviceStatus::kDeployed) continue;
      devices_.Add(static_cast<std::int32_t>(id), static_cast<float>(routes[own_route].steps));
    }
    for (std::size_t slot = 0; slot < devices(); ++slot) routes_[slot] = RouteOf(device(slot));
  }

  std::size_t devices() const { return devices_.size(); }
  std::size_t ports() const { return ports_.size(); }
  std::size_t device(std::size_t slot) const { return devices_[slot]; }  ///< id
  std::size_t port(std::size_t slot) const { return ports_[slot]; }      ///< id
  /// Returns the index of the route to the device of a slot in the result of RoutesFrom.
  std::size_t route(std::size_t slot) const { return routes_[slot]; }

  // FromPort and ToNextDevice consider only deployed devices that have a slot. They return 0 if
  // there is no such device to go to, and kUnreachable if no route leads to one. ToNextDeviceByPort
  // returns kUnreachable if it finds no route.

  /// Returns the number of moves from the port of a slot to the nearest deployed device.
  std::int32_t FromPort(std::size_t slot) const {
    return ToDevice(view_.layout->ports[port(slot)], kNoDevice);
  }
  /// Returns the number of moves from the device of a slot to the nearest other deployed device.
  std::int32_t ToNextDevice(std::size_t slot) const {
    return ToDevice(view_.devices[device(slot)].cell, slot);
  }
  /// Returns the number of moves of the shortest route from the device of a slot to a port with a
  /// slot and then to another deployed device. Without another deployed device, returns the number
  /// of moves to the nearest such port.
  std::int32_t ToNextDeviceByPort(std::size_t slot) const {
    const RouteEntry* const routes = RoutesFrom(view_, view_.devices[device(slot)].cell);
    std::int32_t best = kUnreachable;
    for (std::size_t i = 0; i < ports(); ++i) {
      const std::int32_t steps = routes[port(i)].steps;
      if (steps >= best) continue;
      best = std::min(best, steps + ToDevice(view_.layout->ports[port(i)], slot));
    }
    return best;
  }

 private:
  static constexpr std::size_t kNoDevice = kDevices;

  std::size_t RouteOf(std::size_t id) const {
    std::size_t route = view_.layout->ports.size();
    for (std::size_t i = 0; i < id; ++i) route += view_.devices[i].self_propelled ? 0 : 1;
    return route;
  }

  // Returns the number of moves to the nearest deployed device except the one of slot `except`.
  std::int32_t ToDevice(Cell from, std::size_t except) const {
    const RouteEntry* const routes = RoutesFrom(view_, from);
    std::int32_t best = kUnreachable;
    bool has_device = false;
    for (std::size_t slot = 0; slot < devices(); ++slot) {
      const bool is_deployed = view_.devices[device(slot)].status == DeviceStatus::kDeployed;
      if (slot == except || !is_deployed) continue;
      has_device = true;
      best = std::min(best, routes[routes_[slot]].steps);
    }
    return has_device ? best : 0;
  }

  const View& view_;
  Kept<kDevices> devices_;
  Kept<kPorts> ports_;
  std::array<std::size_t, kDevices> routes_{};
};

}  // namespace aquafarm
