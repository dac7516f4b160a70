// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Trips of ships, stored for several searches.

#include <map>
#include <tuple>
#include <vector>

#include "aquafarm/agents/rescue/rescue_outcome.h"
#include "aquafarm/agents/rescue/rescue_problem.h"
#include "rescue/trip_search.h"

namespace aquafarm::agents {

/// Stores the trips of ships. Ships with equal cell, speed, ready time, capacity and devices aboard
/// have the same trips. All problems for which a cache is used must be equal, except that they may
/// differ in ships without devices aboard.
class TripCache {
 public:
  /// Returns the trips of a ship. The reference stays valid as long as the cache exists.
  /// @param weights must be the same in all calls
  const TripTable& Of(const TripModel& model, std::size_t ship, std::size_t alternatives,
                      const MemberWeights& weights) {
    const RescueProblem& problem = model.problem();
    const RescueShip& one = problem.ships[ship];
    const auto cell = static_cast<std::size_t>(one.cell.y * problem.water.cols() + one.cell.x);
    const Kind kind{cell, one.speed_kn, one.ready_s, one.capacity, one.aboard, alternatives};
    const auto found = tables_.find(kind);
    if (found != tables_.end()) return found->second;
    return tables_[kind] = SearchTrips(model, ship, alternatives, weights);
  }

 private:
  using Kind =
      std::tuple<std::size_t, double, double, std::int32_t, std::vector<std::int32_t>, std::size_t>;
  std::map<Kind, TripTable> tables_;
};

/// As PlanRescue of rescue_plan.h, with a cache for several calls.
/// @param ensemble must be the same for all problems of the cache
RescuePlan PlanRescue(const RescueProblem& problem, const Ensemble& ensemble, int averse_rounds,
                      TripCache& cache);

}  // namespace aquafarm::agents
