// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Computes the orders, the outcomes of the devices and the losses for given trips.

#include <vector>

#include "aquafarm/agents/rescue/rescue_outcome.h"
#include "rescue/trip_model.h"
#include "rescue/trip_search.h"

namespace aquafarm::agents {

/// The stops of one ship.
struct ShipTrips {
  std::size_t ship{};
  std::vector<TripStop> stops;
};

/// Follows the trips in every member of the ensemble. Does not set bound, averse_gap or
/// is_exhaustive of the plan.
/// @param trips at most one element for each ship; a ship without an element stays
RescuePlan FollowTrips(const TripModel& model, const std::vector<ShipTrips>& trips);

/// Returns the trips of FetchInOrder (rescue_plan.h), which ignore storms.
std::vector<ShipTrips> SimpleTrips(const TripModel& model, FetchRule rule);

}  // namespace aquafarm::agents
