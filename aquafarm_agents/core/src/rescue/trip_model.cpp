// SPDX-License-Identifier: BSD-3-Clause
#include "rescue/trip_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "aquafarm/base/check.h"
#include "aquafarm/base/widest.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/tracks/track.h"

namespace aquafarm::agents {
namespace {

std::vector<Cell> PlacesOf(const RescueProblem& problem) {
  std::vector<Cell> places;
  const auto add = [&](const std::string& name, Cell cell) {
    const bool on_map = cell.x >= 0 && cell.y >= 0 && cell.x < problem.water.cols() &&
                        cell.y < problem.water.rows();
    if (!on_map || problem.water(cell.y, cell.x) == 0) {
      throw InputError(name + ": got cell (" + std::to_string(cell.x) + ", " +
                       std::to_string(cell.y) + "), expected water on the map");
    }
    places.push_back(cell);
  };
  for (const RescueDevice& device : problem.devices) add(device.name, device.cell);
  for (const RescuePort& port : problem.ports) add(port.name, port.cell);
  for (const RescueShip& ship : problem.ships) add(ship.name, ship.cell);
  return places;
}

// Clears the members in which the winds have arrived by step `now`.
AQUAFARM_WIDEST
void ClearFrom(const std::int16_t* arrival, std::int16_t now, std::size_t count,
               std::int16_t* works) {
  for (std::size_t member = 0; member < count; ++member) {
    const auto calm = static_cast<std::int16_t>(arrival[member] > now ? 1 : 0);
    works[member] = static_cast<std::int16_t>(works[member] & calm);
  }
}

// Number of partial sums in SumOf. They are independent, so the processor can add them in parallel.
constexpr std::size_t kLanes = 16;

template <typename Term>
double SumOf(std::size_t count, const Term& term) {
  std::array<float, kLanes> sums{};
  std::size_t first = 0;
  for (; first + kLanes <= count; first += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += term(first + lane);
  }
  for (; first < count; ++first) sums[0] += term(first);
  return static_cast<double>(std::accumulate(sums.begin(), sums.end(), 0.0F));
}

}  // namespace

std::int32_t CountAlive(const Alive& alive) {
  return std::accumulate(alive.begin(), alive.end(), std::int32_t{0});
}

TripModel::TripModel(const RescueProblem& problem, const Ensemble& ensemble)
    : problem_(problem), ensemble_(ensemble), routes_(problem.water, PlacesOf(problem)) {
  AQUAFARM_CHECK_LT(problem.abort_ring, ensemble.rings());
  const auto members = static_cast<std::size_t>(ensemble.members());
  loss_.resize(problem.devices.size() * static_cast<std::size_t>(ensemble.steps()) * members);
  float* loss = loss_.data();
  for (std::size_t device = 0; device < problem.devices.size(); ++device) {
    const RescueDevice& one = problem.devices[device];
    const auto value = static_cast<float>(one.value);
    const auto left = static_cast<float>(1.0 - one.damage_before);
    const auto rate = static_cast<float>(problem.exposure_damage * one.damage_factor);
    for (std::int32_t step = 0; step < ensemble.steps(); ++step) {
      const float* exposure = ensemble.Exposure(device, step);
      for (std::size_t member = 0; member < members; ++member) {
        *loss++ = value * std::min(left, rate * exposure[member]);
      }
    }
  }
}

double TripModel::Pace(std::size_t ship) const {
  return problem_.cell_size_km * 1000.0 / (problem_.ships[ship].speed_kn * kMpsPerKnot);
}

// Returns the last step that starts at or before a time; after the end of the last step of the
// ensemble, the number of steps.
std::int32_t TripModel::StepOf(double time_s) const {
  const double step = std::floor(std::max(0.0, time_s) / ensemble_.options().step_s);
  return static_cast<std::int32_t>(std::min(step, static_cast<double>(ensemble_.steps())));
}

void TripModel::Stay(Cell cell, double until_s, Alive& alive) const {
  const std::int32_t step = StepOf(until_s);
  if (step >= ensemble_.steps()) {
    std::fill(alive.begin(), alive.end(), std::int16_t{0});
    return;
  }
  const std::int16_t* arrival = ensemble_.Arrival(problem_.abort_ring, cell);
  const auto now = static_cast<std::int16_t>(step);
  ClearFrom(arrival, now, alive.size(), alive.data());
}

void TripModel::Move(std::size_t ship, std::size_t from, std::size_t to, double& time_s,
                     Alive& alive) const {
  const SeaRoute& route = routes_.Between(from, to);
  const double pace = Pace(ship);
  for (std::size_t i = 0; i + 1 < route.cells.size(); ++i) {
    Stay(route.cells[i], time_s + route.length[i + 1] * pace, alive);
  }
  time_s += route.length.back() * pace + problem_.handling_s;
  Stay(route.cells.back(), time_s, alive);
}

const float* TripModel::LossUntil(std::size_t device, double time_s) const {
  const auto step = static_cast<std::size_t>(std::min(StepOf(time_s), ensemble_.steps() - 1));
  return loss_.data() + (device * static_cast<std::size_t>(ensemble_.steps()) + step) *
                            static_cast<std::size_t>(ensemble_.members());
}

const float* TripModel::LossIdle(std::size_t device) const {
  return LossUntil(device, std::numeric_limits<double>::max());
}

double TripModel::Saved(std::size_t device, double time_s, const Alive& alive,
                        const MemberWeights& weights) const {
  const float* idle = LossIdle(device);
  const float* until = LossUntil(device, time_s);
  const std::int16_t* works = alive.data();
  const auto gain = [&](std::size_t member) {
    return static_cast<float>(works[member]) * (idle[member] - until[member]);
  };
  if (weights.empty()) return SumOf(alive.size(), gain) / static_cast<double>(alive.size());
  const auto* weight = weights.data();
  return SumOf(alive.size(), [&](std::size_t member) { return weight[member] * gain(member); });
}

TripEffort TripModel::Effort(std::size_t ship, std::size_t from, std::size_t to,
                             std::size_t aboard) const {
  if (!problem_.energy) return {};
  const RescueEnergy& energy = *problem_.energy;
  const double length = routes_.Length(from, to);
  TripEffort effort;
  effort.hours = (length * Pace(ship) + problem_.handling_s) / 3600.0;
  effort.kwh = energy.per_km * length * problem_.cell_size_km *
                   (1.0 + energy.per_device * static_cast<double>(aboard)) +
               energy.idle_kw * effort.hours;
  return effort;
}

double TripModel::Cost(const TripEffort& effort) const {
  if (!problem_.energy) return 0.0;
  return problem_.energy->per_kwh * effort.kwh + problem_.energy->per_hour * effort.hours;
}

std::int32_t TripModel::NearestPort(std::size_t place) const {
  std::int32_t best = kNone;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t port = 0; port < problem_.ports.size(); ++port) {
    const double length = routes_.Length(place, PlaceOfPort(port));
    if (!problem_.ports[port].is_open || length >= nearest) continue;
    nearest = length;
    best = static_cast<std::int32_t>(port);
  }
  return best;
}

double TripModel::BoundOf(std::size_t device, const MemberWeights& weights) const {
  const std::int32_t port = NearestPort(PlaceOfDevice(device));
  if (port == kNone) return 0.0;
  const std::int32_t carrier = problem_.CarrierOf(device);
  double fetch_s = std::numeric_limits<double>::infinity();
  double deliver_s = fetch_s;
  const double back =
      routes_.Length(PlaceOfDevice(device), PlaceOfPort(static_cast<std::size_t>(port)));
  for (std::size_t ship = 0; ship < problem_.ships.size(); ++ship) {
    if (carrier != kNone && static_cast<std::size_t>(carrier) != ship) continue;
    const double out = routes_.Length(PlaceOfShip(ship), PlaceOfDevice(device));
    const double fetched = problem_.ships[ship].ready_s + out * Pace(ship) +
                           (carrier == kNone ? problem_.handling_s : 0.0);
    fetch_s = std::min(fetch_s, fetched);
    deliver_s = std::min(deliver_s, fetched + back * Pace(ship) + problem_.handling_s);
  }
  if (!std::isfinite(deliver_s)) return 0.0;
  Alive alive(static_cast<std::size_t>(ensemble_.members()), 1);
  Stay(problem_.devices[device].cell, fetch_s, alive);
  return Saved(device, deliver_s, alive, weights);
}

std::vector<TimedCell> TripModel::FirstTrip(std::size_t ship, std::size_t device) const {
  const std::int32_t carrier = problem_.CarrierOf(device);
  if (carrier != kNone && static_cast<std::size_t>(carrier) != ship) return {};
  std::vector<std::size_t> places{PlaceOfShip(ship)};
  const auto add_port = [&] {
    const std::int32_t port = NearestPort(places.back());
    if (port != kNone) places.push_back(PlaceOfPort(static_cast<std::size_t>(port)));
    return port != kNone;
  };
  if (!problem_.ships[ship].aboard.empty() && !add_port()) return {};
  if (carrier == kNone) {
    places.push_back(PlaceOfDevice(device));
    if (!add_port()) return {};
  }
  const double pace = Pace(ship);
  std::vector<TimedCell> left;
  double time_s = 0.0;
  for (std::size_t leg = 1; leg < places.size(); ++leg) {
    const SeaRoute& route = routes_.Between(places[leg - 1], places[leg]);
    if (route.cells.empty()) return {};
    for (std::size_t i = 0; i + 1 < route.cells.size(); ++i) {
      left.push_back({route.cells[i], time_s + route.length[i + 1] * pace});
    }
    time_s += route.length.back() * pace + problem_.handling_s;
    left.push_back({route.cells.back(), time_s});
  }
  return left;
}

}  // namespace aquafarm::agents
