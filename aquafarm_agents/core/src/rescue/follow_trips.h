// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What given trips of the ships mean for orders, devices and losses.

#include <vector>

#include "aquafarm/agents/rescue/rescue_outcome.h"
#include "rescue/trip_model.h"
#include "rescue/trip_search.h"

namespace aquafarm::agents {

/// The stops of a ship that leaves.
struct ShipTrips {
  std::size_t ship{};
  std::vector<TripStop> stops;
};

/// Follows the trips in every member. `saved` is the mean; bound and is_exhaustive are not set.
RescuePlan FollowTrips(const TripModel& model, const std::vector<ShipTrips>& trips);

/// Returns the trips that fetch device after device by a rule: the ship that is free first takes
/// the next device. No storm matters.
std::vector<ShipTrips> SimpleTrips(const TripModel& model, FetchRule rule);

}  // namespace aquafarm::agents
