// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Computes times, survival and saved value of trips. Plans, deadlines and trials share it.

#include <cstdint>
#include <vector>

#include "aquafarm/agents/rescue/rescue_order.h"
#include "aquafarm/agents/rescue/rescue_problem.h"
#include "rescue/sea_routes.h"

namespace aquafarm::agents {

/// By member: 1 while the ship still works. As wide as the arrival steps, so that loops over both
/// vectorize.
using Alive = std::vector<std::int16_t>;

/// Weights of the members, which sum to 1; empty: all members have equal weights.
using MemberWeights = std::vector<float>;

/// Energy and duration of a part of a trip.
struct TripEffort {
  double kwh{};
  double hours{};

  TripEffort& operator+=(const TripEffort& other) {
    kwh += other.kwh;
    hours += other.hours;
    return *this;
  }
};

/// Returns the number of members in which a ship works.
std::int32_t CountAlive(const Alive& alive);

/// Computes times, survival and saved value of trips between ships, devices and ports.
class TripModel {
 public:
  /// @throws InputError if a device, a port or a ship is off the map or on land
  TripModel(const RescueProblem& problem, const Ensemble& ensemble);

  const RescueProblem& problem() const { return problem_; }
  const Ensemble& ensemble() const { return ensemble_; }

  // Indices of the end points of routes: devices, then ports, then ships.
  std::size_t PlaceOfDevice(std::size_t device) const { return device; }
  std::size_t PlaceOfPort(std::size_t port) const { return problem_.devices.size() + port; }
  std::size_t PlaceOfShip(std::size_t ship) const {
    return problem_.devices.size() + problem_.ports.size() + ship;
  }
  const SeaRoutes& routes() const { return routes_; }

  /// Seconds that a ship needs for one cell.
  double Pace(std::size_t ship) const;
  /// Moves a ship along a route and adds the handling time at its end.
  /// @param time_s departure; set to the time when handling is done
  /// @param alive cleared for members in which winds stop the ship on the way or during handling
  void Move(std::size_t ship, std::size_t from, std::size_t to, double& time_s, Alive& alive) const;
  /// Clears the members in which winds of `abort_ring` have reached a cell by a time; clears all
  /// members if the time is after the last step of the ensemble.
  void Stay(Cell cell, double until_s, Alive& alive) const;

  /// Loss of a device that is at its site until a time, [members].
  const float* LossUntil(std::size_t device, double time_s) const;
  /// Loss of a device that is never delivered, [members].
  const float* LossIdle(std::size_t device) const;
  /// Weighted mean over all members of the value that delivering a device at a time saves. A member
  /// in which the ship has stopped counts as 0.
  double Saved(std::size_t device, double time_s, const Alive& alive,
               const MemberWeights& weights = {}) const;
  /// Effort of a route and of the handling at its end; 0 kWh and 0 h if the problem has no energy.
  /// @param aboard number of devices aboard
  TripEffort Effort(std::size_t ship, std::size_t from, std::size_t to, std::size_t aboard) const;
  /// Cost of an effort.
  double Cost(const TripEffort& effort) const;

  /// Returns the open port nearest to an end point; kNone if no open port is reachable.
  std::int32_t NearestPort(std::size_t place) const;
  /// Upper bound on the value that delivering a device can save, whichever ship delivers it.
  double BoundOf(std::size_t device, const MemberWeights& weights = {}) const;
  /// Returns the cells of the trip on which a ship first delivers a device, each with the time at
  /// which the ship leaves it, relative to the departure; the last time is that of delivery. A ship
  /// with devices aboard delivers them first. Empty if no route exists or another ship has the
  /// device aboard.
  std::vector<TimedCell> FirstTrip(std::size_t ship, std::size_t device) const;

 private:
  std::int32_t StepOf(double time_s) const;

  const RescueProblem& problem_;
  const Ensemble& ensemble_;
  SeaRoutes routes_;
  std::vector<float> loss_;  // [devices, steps, members]
};

}  // namespace aquafarm::agents
