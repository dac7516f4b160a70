// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Searches the sequences of trips of one ship.

#include <cstdint>
#include <map>
#include <vector>

#include "rescue/trip_model.h"

namespace aquafarm::agents {

/// A set of devices, one bit each.
using DeviceSet = std::uint64_t;
inline constexpr std::size_t kMaxRescueDevices = 64;

/// A stop of a ship: fetch a device, or deliver in a port.
struct TripStop {
  OrderKind kind{};
  std::size_t target{};  ///< index of the device or port
};

/// The stops of one ship with their value.
struct TripPlan {
  DeviceSet devices{};  ///< those delivered
  double net{};         ///< mean value saved, less the cost
  std::vector<TripStop> stops;
};

/// Best trip plans of one ship, by set of devices.
struct TripTable {
  std::map<DeviceSet, std::vector<TripPlan>> plans;  ///< by decreasing net value
  bool is_exhaustive{true};
};

/// @param alternatives max number of plans per set of devices @param weights of the mean
TripTable SearchTrips(const TripModel& model, std::size_t ship, std::size_t alternatives,
                      const MemberWeights& weights = {});

}  // namespace aquafarm::agents
