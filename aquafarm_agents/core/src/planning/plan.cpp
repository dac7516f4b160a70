// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/planning/plan.h"

#include <algorithm>
#include <memory>

#include "aquafarm/farm/disaster.h"
#include "aquafarm/farm/forecast.h"

namespace aquafarm::agents {

std::vector<Track> Foresee(const Farm& farm, Foresight foresight,
                           std::vector<Disaster>& disasters) {
  std::vector<Track> tracks = farm.tracks();
  if (foresight == Foresight::kOracle) return tracks;
  for (std::size_t id = 0; id < disasters.size(); ++id) {
    const auto disaster = static_cast<std::int32_t>(id);
    disasters[id].turn_threshold = 0;
    disasters[id].waypoint = kNone;
    // A disaster with a track may be far outside the map. Its border must not affect its motion.
    if (!tracks[id]->empty()) disasters[id].border = Border::kLeave;
    if (!HasForecast(farm, disaster, farm.step())) continue;
    disasters[id].waypoint = 0;
    tracks[id] =
        std::make_shared<const std::vector<Waypoint>>(ForecastTrack(farm, disaster, farm.step()));
  }
  return tracks;
}

void Reservations::Add(std::int32_t id, std::int32_t first, const std::vector<std::int32_t>& path) {
  for (std::size_t k = 0; k < path.size(); ++k) {
    const std::int32_t step = first + static_cast<std::int32_t>(k);
    taken_[Key(step, path[k])].push_back({id, 0});
    // Ships move in id order. When this ship enters a cell, ships with higher ids are still in
    // their previous cells. When a ship with a lower id moves, this ship is still in its previous
    // cell.
    taken_[Key(step - 1, path[k])].push_back({id, 1});
    taken_[Key(step + 1, path[k])].push_back({id, -1});
  }
}

bool Reservations::IsTaken(std::int32_t id, std::int32_t step, std::int32_t cell) const {
  const auto found = taken_.find(Key(step, cell));
  if (found == taken_.end()) return false;
  return std::any_of(found->second.begin(), found->second.end(), [id](const Visit& visit) {
    if (visit.ship == id) return false;
    if (visit.offset == 0) return true;
    return visit.offset > 0 ? visit.ship < id : visit.ship > id;
  });
}

}  // namespace aquafarm::agents
