// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Searches the best sequences of trips of one ship.

#include <cstdint>
#include <map>
#include <vector>

#include "rescue/trip_model.h"

namespace aquafarm::agents {

/// A set of devices: bit i is set if it contains device i.
using DeviceSet = std::uint64_t;
/// Max number of devices of a plan.
inline constexpr std::size_t kMaxRescueDevices = 64;

/// A stop of a ship: it fetches a device, or delivers all devices aboard at a port.
struct TripStop {
  OrderKind kind{};
  std::size_t target{};  ///< index of the device or port
};

/// All stops of one ship, and their value.
struct TripPlan {
  DeviceSet devices{};  ///< delivered devices
  double net{};         ///< weighted mean of the value saved, minus the cost
  std::vector<TripStop> stops;
};

/// The best plans of one ship.
struct TripTable {
  /// By set of delivered devices: plans by decreasing net value.
  std::map<DeviceSet, std::vector<TripPlan>> plans;
  bool is_exhaustive{true};  ///< false if the search dropped sequences to limit their number
};

/// Returns the best plans of a ship.
/// @param alternatives max number of plans for each set of devices
/// @param weights weights of the members in the mean
TripTable SearchTrips(const TripModel& model, std::size_t ship, std::size_t alternatives,
                      const MemberWeights& weights = {});

}  // namespace aquafarm::agents
