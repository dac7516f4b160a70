// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Model of trips, which plans, deadlines and trials use.

#include <cstdint>
#include <vector>

#include "aquafarm/agents/rescue/rescue_order.h"
#include "aquafarm/agents/rescue/rescue_problem.h"
#include "rescue/sea_routes.h"

namespace aquafarm::agents {

/// By member: 1 while the ship works, 0 after winds have stopped it. The elements have the same
/// size as those of Ensemble::Arrival, so that loops over both arrays are vectorized.
using Alive = std::vector<std::int16_t>;

/// Weights of the members. They sum to 1. Empty: all members have equal weights.
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
  /// @param problem must outlive the model
  /// @param ensemble must outlive the model; made for the cells of the problem's devices
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

  /// Time in which a ship moves by the length of one cell [s].
  double Pace(std::size_t ship) const;
  /// Moves a ship along a route and adds the handling time at its end.
  /// @param from, to end points of the route, which must exist
  /// @param time_s departure; is set to the end of the handling
  /// @param alive is cleared for members in which winds stop the ship during the move or handling
  void Move(std::size_t ship, std::size_t from, std::size_t to, double& time_s, Alive& alive) const;
  /// Clears the members in which winds of `abort_ring` have reached a cell by the time `until_s`.
  /// Clears all members if this time is after the last step of the ensemble.
  void Stay(Cell cell, double until_s, Alive& alive) const;

  /// Loss of a device that stays at its site until a time, [members].
  const float* LossUntil(std::size_t device, double time_s) const;
  /// Loss of a device that is never delivered, [members].
  const float* LossIdle(std::size_t device) const;
  /// Returns the weighted mean over all members of the value that is saved if a device is delivered
  /// at a time. A member in which the ship has stopped counts with 0.
  double Saved(std::size_t device, double time_s, const Alive& alive,
               const MemberWeights& weights = {}) const;
  /// Returns the effort of a route and of the handling at its end; 0 kWh and 0 h if
  /// RescueProblem::energy is not set.
  /// @param aboard number of devices aboard on the route
  TripEffort Effort(std::size_t ship, std::size_t from, std::size_t to, std::size_t aboard) const;
  /// Returns the cost of an effort.
  double Cost(const TripEffort& effort) const;

  /// Returns the open port nearest to an end point; kNone if no open port is reachable.
  std::int32_t NearestPort(std::size_t place) const;
  /// Returns an upper bound of the value that the delivery of a device by any ship can save.
  double BoundOf(std::size_t device, const MemberWeights& weights = {}) const;
  /// Returns the cells of a trip that starts at the ship's cell and delivers a device at the
  /// nearest open port. A ship with devices aboard delivers these first. Here, TimedCell::time_s is
  /// the time at which the ship leaves the cell, relative to the departure. In the last element it
  /// is the end of the delivery. Returns an empty vector if there is no route, or if another ship
  /// carries the device.
  std::vector<TimedCell> FirstTrip(std::size_t ship, std::size_t device) const;

 private:
  std::int32_t StepOf(double time_s) const;

  const RescueProblem& problem_;
  const Ensemble& ensemble_;
  SeaRoutes routes_;
  std::vector<float> loss_;  // [devices, steps, members] loss until each step
};

}  // namespace aquafarm::agents
