// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "aquafarm/agents/rescue/rescue_plan.h"
#include "rescue/trip_model.h"

namespace aquafarm::agents {
namespace {

// Returns, for each member, the time before which a ship must depart. The times are sorted in
// decreasing order, so they are not in the order of the members.
std::vector<double> LatestDepartures(const TripModel& model, const std::vector<TimedCell>& trip) {
  const Ensemble& ensemble = model.ensemble();
  const double step_s = ensemble.options().step_s;
  const double known_s = ensemble.steps() * step_s;
  std::vector<double> latest(static_cast<std::size_t>(ensemble.members()),
                             known_s - trip.back().time_s);
  for (const TimedCell& left : trip) {
    const std::int16_t* arrival = ensemble.Arrival(model.problem().abort_ring, left.cell);
    for (std::size_t member = 0; member < latest.size(); ++member) {
      if (arrival[member] == Ensemble::kNoArrival) continue;
      latest[member] = std::min(latest[member], arrival[member] * step_s - left.time_s);
    }
  }
  std::sort(latest.begin(), latest.end(), std::greater<>());
  return latest;
}

}  // namespace

std::vector<std::vector<Deadline>> Deadlines(const RescueProblem& problem, const Ensemble& ensemble,
                                             const std::vector<double>& probabilities) {
  const TripModel model(problem, ensemble);
  std::vector<std::vector<Deadline>> deadlines;
  for (std::size_t device = 0; device < problem.devices.size(); ++device) {
    std::vector<Deadline> of_device;
    for (const double probability : probabilities)
      of_device.push_back({probability, {}, false, kNone});
    for (std::size_t ship = 0; ship < problem.ships.size(); ++ship) {
      const std::vector<TimedCell> trip = model.FirstTrip(ship, device);
      if (trip.empty()) continue;
      const std::vector<double> latest = LatestDepartures(model, trip);
      const double open_s = ensemble.steps() * ensemble.options().step_s - trip.back().time_s;
      for (Deadline& deadline : of_device) {
        const double wanted = deadline.probability * static_cast<double>(latest.size());
        const auto rank = static_cast<std::size_t>(std::max(1.0, std::ceil(wanted - 1e-9)));
        const double before_s = latest[rank - 1];
        // The last whole second before before_s.
        const double leave_s = std::ceil(before_s) - 1.0;
        if (leave_s < problem.ships[ship].ready_s) continue;
        if (deadline.leave_s && *deadline.leave_s >= leave_s) continue;
        deadline.leave_s = leave_s;
        deadline.is_open = before_s >= open_s;
        deadline.ship = static_cast<std::int32_t>(ship);
      }
    }
    deadlines.push_back(std::move(of_device));
  }
  return deadlines;
}

}  // namespace aquafarm::agents
