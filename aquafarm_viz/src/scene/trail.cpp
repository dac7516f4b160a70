// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/scene/trail.h"

#include <cstdlib>

#include "aquafarm_viz/base/palette.h"

namespace aquafarm_viz {
namespace {

std::optional<std::int64_t> TimeIn(const std::map<std::int32_t, std::int64_t>& times,
                                   std::int32_t device) {
  const auto found = times.find(device);
  return found == times.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace

void Trail::Update(const aquafarm_msgs::FarmState& state) {
  if (state.seed != seed_ || state.episode != episode_ || state.step < step_) {
    ships_.clear();
    statuses_.clear();
    changed_at_.clear();
    fetched_at_.clear();
  }
  seed_ = state.seed;
  episode_ = state.episode;
  step_ = state.step;
  for (const auto& device : state.devices) {
    const auto [known, is_new] = statuses_.emplace(device.id, device.status);
    if (is_new || known->second == device.status) continue;
    if (known->second == aquafarm_msgs::DeviceState::DEPLOYED) {
      fetched_at_[device.id] = state.world_time.sec;
    }
    known->second = device.status;
    changed_at_[device.id] = state.world_time.sec;
  }
  for (const auto& ship : state.ships) {
    if (!ship.visible) {
      ships_.erase(ship.id);
      continue;
    }
    ShipTrail& trail = ships_[ship.id];
    if (const int bearing = MoveBearingDeg(ship.action); bearing >= 0) trail.bearing_deg = bearing;
    const cv::Point place(ship.x, ship.y);
    if (!trail.places.empty()) {
      const cv::Point last = trail.places.back();
      if (last == place) continue;
      if (IsGap(last, place) && length_ < kWhole) {
        trail.places.clear();
        trail.loaded.clear();
      }
    }
    trail.places.push_back(place);
    trail.loaded.push_back(ship.own_device >= 0 || !ship.aboard.empty());
    if (trail.places.size() <= length_) continue;
    trail.places.pop_front();
    trail.loaded.pop_front();
  }
}

bool Trail::IsGap(cv::Point from, cv::Point to) {
  return std::abs(double(from.x) - to.x) > kMaxJump || std::abs(double(from.y) - to.y) > kMaxJump;
}

std::size_t ShipTrail::UnbrokenFrom() const {
  std::size_t first = places.empty() ? 0 : places.size() - 1;
  while (first > 0 && !Trail::IsGap(places[first - 1], places[first])) --first;
  return first;
}

std::optional<std::int64_t> Trail::ChangedAt(std::int32_t device) const {
  return TimeIn(changed_at_, device);
}

std::optional<std::int64_t> Trail::FetchedAt(std::int32_t device) const {
  return TimeIn(fetched_at_, device);
}

const ShipTrail* Trail::Find(std::int32_t ship) const {
  const auto found = ships_.find(ship);
  return found == ships_.end() ? nullptr : &found->second;
}

int ShipBearingDeg(const aquafarm_msgs::ShipState& ship, const Trail* trail) {
  if (const int bearing = MoveBearingDeg(ship.action); bearing >= 0) return bearing;
  const ShipTrail* known = trail == nullptr ? nullptr : trail->Find(ship.id);
  return known == nullptr ? 0 : known->bearing_deg;
}

}  // namespace aquafarm_viz
