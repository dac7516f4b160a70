// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Times, survival and value of trips; shared by the plan and the deadlines.

#include <cstdint>
#include <vector>

#include "aquafarm/agents/rescue/rescue_order.h"
#include "aquafarm/agents/rescue/rescue_problem.h"
#include "rescue/sea_routes.h"

namespace aquafarm::agents {

/// By member: 1 while the ship still works.
using Alive = std::vector<std::int16_t>;  // as wide as the steps of arrival, for vector code

/// Weight of each member, their sum is 1; empty: all are equal.
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

class TripModel {
 public:
  /// @throws InputError if a place is off the map or on land
  TripModel(const RescueProblem& problem, const Ensemble& ensemble);

  const RescueProblem& problem() const { return problem_; }
  const Ensemble& ensemble() const { return ensemble_; }

  // Places of the routes: devices, then ports, then ships.
  std::size_t PlaceOfDevice(std::size_t device) const { return device; }
  std::size_t PlaceOfPort(std::size_t port) const { return problem_.devices.size() + port; }
  std::size_t PlaceOfShip(std::size_t ship) const {
    return problem_.devices.size() + problem_.ports.size() + ship;
  }
  const SeaRoutes& routes() const { return routes_; }

  /// Seconds that a ship needs for one cell.
  double Pace(std::size_t ship) const;
  /// Moves a ship and lets it work at the end for the time of handling.
  /// @param time_s of departure; becomes the time when the work is done
  /// @param alive loses the members in which the ship stops on the way
  void Move(std::size_t ship, std::size_t from, std::size_t to, double& time_s, Alive& alive) const;
  /// Removes the members in which the winds have reached a cell by a time.
  void Stay(Cell cell, double until_s, Alive& alive) const;

  /// Loss of a device that is at its site until a time, [members].
  const float* LossUntil(std::size_t device, double time_s) const;
  /// Loss of a device that is never delivered, [members].
  const float* LossIdle(std::size_t device) const;
  /// Mean value that is saved by delivering a device at a time in the members of `alive`.
  double Saved(std::size_t device, double time_s, const Alive& alive,
               const MemberWeights& weights = {}) const;
  /// Effort of a way and the work at its end. @param aboard devices on the way
  TripEffort Effort(std::size_t ship, std::size_t from, std::size_t to, std::size_t aboard) const;
  /// Cost of an effort.
  double Cost(const TripEffort& effort) const;

  /// Returns the open port nearest to a place; kNone if there is none in reach.
  std::int32_t NearestPort(std::size_t place) const;
  /// Upper bound of the value that any ship can save of a device.
  double BoundOf(std::size_t device, const MemberWeights& weights = {}) const;
  /// Returns the times of a ship's first trip to a device, relative to its departure: for each cell
  /// the time when it leaves it, and the time of delivery at the end. A ship with devices aboard
  /// delivers them first. Empty if there is no way, or another ship has the device aboard.
  std::vector<TimedCell> FirstTrip(std::size_t ship, std::size_t device) const;

 private:
  std::int32_t StepOf(double time_s) const;

  const RescueProblem& problem_;
  const Ensemble& ensemble_;
  SeaRoutes routes_;
  std::vector<float> loss_;  // [devices, steps, members]
};

}  // namespace aquafarm::agents
