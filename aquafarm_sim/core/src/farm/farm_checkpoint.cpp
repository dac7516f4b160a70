// SPDX-License-Identifier: BSD-3-Clause
// Hashes, saved states and copies of an episode in progress, and disasters that arrive during it.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "aquafarm/base/cbor.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/hash.h"
#include "aquafarm/base/version.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/scenario/validate.h"
#include "aquafarm/storms/draw_storm.h"
#include "farm/farm_records.h"

namespace aquafarm {
namespace {

using internal::DisasterFrom;
using internal::ForecastsFromJson;
using internal::ForecastsToJson;
using internal::Int;
using internal::Read;
using internal::RingsMayHaveChanged;
using internal::TrackFromJson;
using internal::TrackToJson;
using internal::Written;
using nlohmann::json;

constexpr int kStateFormat = 1;

void HashDisaster(const Disaster& disaster, const Bulletin& bulletin, Hasher& hasher) {
  hasher.Add(Int(disaster.kind), disaster.grade);
  hasher.Add(disaster.x, disaster.y);
  hasher.Add(disaster.dx, disaster.dy);
  hasher.Add(disaster.heading_deg, disaster.steps_left);
  hasher.Add(disaster.waypoint, disaster.rings);
  hasher.Add(static_cast<std::int32_t>(disaster.turn_threshold), Int(disaster.border));
  hasher.Add(disaster.radius_growth, disaster.margin);
  for (std::size_t k = 0; k < static_cast<std::size_t>(disaster.rings); ++k) {
    hasher.Add(disaster.radius[k], disaster.risk[k]);
  }
  for (std::size_t q = 0; disaster.by_quadrant && q < disaster.quadrant.size(); ++q) {
    for (const float radius : disaster.quadrant[q]) hasher.Add(radius, 0.0F);
  }
  hasher.Add(bulletin.x, bulletin.y);
  hasher.Add(bulletin.heading_deg, bulletin.step);
  if (!RingsMayHaveChanged(disaster, bulletin)) return;
  for (std::size_t k = 0; k < static_cast<std::size_t>(disaster.rings); ++k) {
    hasher.Add(bulletin.radius[k], bulletin.speed);
    for (std::size_t q = 0; disaster.by_quadrant && q < bulletin.quadrant.size(); ++q) {
      hasher.Add(bulletin.quadrant[q][k], 0.0F);
    }
  }
}

void HashTrack(const std::vector<Waypoint>& track, Hasher& hasher) {
  hasher.Add(static_cast<std::uint64_t>(track.size()));
  for (const Waypoint& point : track) {
    hasher.Add(point.step, point.x);
    hasher.Add(point.y, static_cast<float>(point.grade));
    for (std::size_t k = 0; k < point.radii.size(); ++k) {
      hasher.Add(point.radii[k], point.risks[k]);
    }
    for (const QuadrantRadii& ring : point.quadrants) {
      hasher.Add(ring[0], ring[1]);
      hasher.Add(ring[2], ring[3]);
    }
  }
}

// Adds nothing for a disaster without forecasts, so that hashes of older versions stay valid.
void HashForecasts(const std::vector<Forecasts>& forecasts, Hasher& hasher) {
  for (std::size_t id = 0; id < forecasts.size(); ++id) {
    if (forecasts[id] == nullptr) continue;
    for (const IssuedForecast& forecast : *forecasts[id]) {
      hasher.Add(static_cast<float>(id), forecast.step);
      HashTrack(forecast.points, hasher);
    }
  }
}

bool IsSame(const std::vector<Waypoint>& a, const std::vector<Waypoint>& b) {
  const auto all = [](const Waypoint& w) {
    return std::tie(w.step, w.x, w.y, w.grade, w.radii, w.risks, w.quadrants);
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&all](const Waypoint& p, const Waypoint& q) { return all(p) == all(q); });
}

template <typename T>
void RequireSame(const char* what, const T& got, const T& expected) {
  if (got == expected) return;
  std::ostringstream text;
  text << "state: " << what << ": got " << got << ", expected " << expected;
  throw InputError(text.str());
}

// Reads the ships of a saved state. @param ships the ships at the start of the episode; replaced
void ReadShips(const json& list, std::vector<Ship>& ships) {
  RequireSame("ships", list.size(), ships.size());
  for (std::size_t i = 0; i < ships.size(); ++i) {
    const std::int32_t own_device = ships[i].own_device;
    ships[i] = Read<Ship>(list[i]);
    RequireSame("own_device", ships[i].own_device, own_device);
  }
}

// Reads the devices of a saved state. @param devices the devices at the start of the episode;
// replaced
// @returns the number of devices not yet delivered
std::int32_t ReadDevices(const json& list, std::vector<Device>& devices) {
  RequireSame("devices", list.size(), devices.size());
  std::int32_t remaining = 0;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const bool self_propelled = devices[i].self_propelled;
    devices[i] = Read<Device>(list[i]);
    RequireSame("self_propelled", devices[i].self_propelled, self_propelled);
    remaining += devices[i].status == DeviceStatus::kDelivered ? 0 : 1;
  }
  return remaining;
}

std::vector<SavedDisaster> ReadDisasters(const json& list, std::size_t min) {
  if (list.size() < min || list.size() > static_cast<std::size_t>(kMaxDisasters)) {
    throw InputError("state: disasters: got " + std::to_string(list.size()) + ", expected [" +
                     std::to_string(min) + ", " + std::to_string(kMaxDisasters) + "]");
  }
  std::vector<SavedDisaster> disasters;
  disasters.reserve(list.size());
  for (const json& disaster : list) disasters.push_back(DisasterFrom(disaster));
  return disasters;
}

}  // namespace

std::uint64_t Farm::Hash() const {
  Hasher hasher;
  hasher.Add(scenario_->hash);
  hasher.Add(record_.seed);
  hasher.Add(record_.episode);
  hasher.Add(record_.steps, Int(record_.reason));
  HashState(hasher);
  return hasher.value();
}

std::uint64_t Farm::StartHash() const {
  Hasher hasher;
  for (std::int32_t y = 0; y < scenario_->height; ++y) {
    for (std::int32_t x = 0; x < scenario_->width; ++x) {
      hasher.Add(static_cast<std::int32_t>(layout_->bits({x, y})), 0);
      hasher.Add(layout_->crash_reward(y, x), 0.0F);
    }
  }
  for (const Device& device : devices_) hasher.Add(Int(device.kind), 0);
  HashState(hasher);
  return hasher.value();
}

void Farm::HashState(Hasher& hasher) const {
  for (const Ship& ship : ships_) {
    hasher.Add(ship.cell.x, ship.cell.y);
    hasher.Add(ship.own_device, ship.aboard);
    hasher.Add(ship.reward, ship.episode_return);
    hasher.Add(Int(ship.outcome), ship.active ? 1 : 0);
    if (scenario_->energy) {  // features contain the energy
      hasher.Add(static_cast<float>(ship.energy), static_cast<float>(ship.episode_energy));
    }
  }
  for (const Device& device : devices_) {
    hasher.Add(device.cell.x, device.cell.y);
    hasher.Add(device.value, device.health);
    hasher.Add(device.carrier, Int(device.status));
  }
  for (std::size_t id = 0; id < disasters_.size(); ++id) {
    HashDisaster(disasters_[id], BulletinOf(id), hasher);
  }
  // If no track was set or drawn, the hash of the scenario covers the tracks.
  if (tracks_changed_ || drawn_ != nullptr) {
    for (const Track& track : tracks_) HashTrack(*track, hasher);
  }
  HashForecasts(forecasts_, hasher);
}

std::string Farm::Save() const {
  std::vector<SavedDisaster> disasters;
  for (std::size_t id = 0; id < disasters_.size(); ++id) {
    disasters.push_back({disasters_[id], BulletinOf(id)});
  }
  json state{{"format", kStateFormat},
             {"version", kVersion},
             {"scenario", scenario_->name},
             {"scenario_hash", scenario_->hash},
             {"record", Written(record_)},
             {"ships", Written(ships_)},
             {"devices", Written(devices_)},
             {"disasters", Written(disasters)},
             {"hash", Hash()}};
  if (tracks_changed_ || drawn_ != nullptr) {
    for (const Track& track : tracks_) state["tracks"].push_back(TrackToJson(*track));
  }
  const auto issued = [](const Forecasts& forecasts) { return forecasts != nullptr; };
  if (std::any_of(forecasts_.begin(), forecasts_.end(), issued)) {
    for (const Forecasts& forecasts : forecasts_) {
      state["forecasts"].push_back(ForecastsToJson(forecasts));
    }
  }
  std::string payload;
  json::to_cbor(state, payload);
  const json sealed{{"checksum", HashBytes(payload)},
                    {"state", json::binary({payload.begin(), payload.end()})}};
  std::string bytes;
  json::to_cbor(sealed, bytes);
  return bytes;
}

void Farm::LoadDisasters(std::vector<SavedDisaster> saved) {
  disasters_.assign(saved.begin(), saved.end());
  bulletins_.clear();
  for (const SavedDisaster& disaster : saved) bulletins_.push_back(disaster.bulletin);
}

void Farm::Load(const std::string& bytes) {
  // The state is loaded into a separate farm, which replaces this one only if all parts are
  // consistent and the hash equals the saved hash.
  Farm loaded(scenario_, own_layout_ == nullptr ? layout_ : nullptr);
  try {
    const json sealed = ParseCbor(bytes);
    const auto& binary = sealed.at("state").get_binary();
    const std::string payload(binary.begin(), binary.end());
    RequireSame("checksum", HashBytes(payload), sealed.at("checksum").get<std::uint64_t>());
    const json state = ParseCbor(payload);
    RequireSame("format", state.at("format").get<int>(), kStateFormat);
    RequireSame("version", state.at("version").get<std::string>(), std::string(kVersion));
    RequireSame("scenario", state.at("scenario").get<std::string>(), scenario_->name);
    RequireSame("scenario_hash", state.at("scenario_hash").get<std::uint64_t>(), scenario_->hash);
    const EpisodeRecord record = Read<EpisodeRecord>(state.at("record"));
    loaded.Reset(record.seed, record.episode);
    loaded.record_ = record;
    ReadShips(state.at("ships"), loaded.ships_);
    loaded.remaining_ = ReadDevices(state.at("devices"), loaded.devices_);
    loaded.LoadDisasters(ReadDisasters(state.at("disasters"), scenario_->disasters.size()));
    const std::size_t disasters = loaded.disasters_.size();
    if (state.contains("tracks")) {
      loaded.tracks_changed_ = true;
      loaded.tracks_.clear();
      for (const json& track : state["tracks"]) {
        loaded.tracks_.push_back(loaded.Owned(loaded.tracks_.size(), TrackFromJson(track)));
      }
    }
    RequireSame("tracks", loaded.tracks_.size(), disasters);
    loaded.forecasts_.resize(disasters);
    if (state.contains("forecasts")) {
      RequireSame("forecasts", state["forecasts"].size(), disasters);
      for (std::size_t id = 0; id < disasters; ++id) {
        loaded.forecasts_[id] = ForecastsFromJson(state["forecasts"][id]);
      }
    }
    loaded.CheckConsistent();
    loaded.IndexShips();
    RequireSame("hash", loaded.Hash(), state.at("hash").get<std::uint64_t>());
  } catch (const json::exception& error) {
    throw InputError(std::string("state: damaged bytes: ") + error.what());
  }
  *this = std::move(loaded);
}

void Farm::CopyStateFrom(const Farm& from) {
  AQUAFARM_CHECK_EQ(scenario_->hash, from.scenario_->hash);
  if (this == &from) return;
  if (own_layout_ != nullptr && scenario_->layout == LayoutMode::kPerEpisode) {
    if (scenario_->view.NeedsRoutes() == from.scenario_->view.NeedsRoutes()) {
      *own_layout_ = *from.layout_;
    } else {
      generator_->Generate(from.seed(), from.episode(), *own_layout_);
    }
  }
  ships_ = from.ships_;
  ship_index_ = from.ship_index_;
  devices_ = from.devices_;
  disasters_ = from.disasters_;
  bulletins_ = from.bulletins_;
  if (scenario_->view.mode == ViewMode::kPartial) bulletins_.resize(disasters_.size());
  CopyTracksFrom(from);
  forecasts_ = from.forecasts_;
  record_ = from.record_;
  remaining_ = from.remaining_;
}

// Copies the tracks of `from`. A track that points into the scenario of `from` is replaced by the
// same track of this farm's scenario, because the scenarios may be two objects.
void Farm::CopyTracksFrom(const Farm& from) {
  const std::vector<DisasterSpec>& specs = scenario_->disasters;
  tracks_ = from.tracks_;
  tracks_changed_ = from.tracks_changed_;
  for (std::size_t id = 0; id < specs.size(); ++id) {
    const DisasterSpec& theirs = from.scenario_->disasters[id];
    if (from.tracks_[id].get() == &theirs.track) tracks_[id] = {scenario_, &specs[id].track};
    if (!specs[id].storms) continue;
    const ArchivedStorm* const first = StormsOf(*theirs.storms, from.seed()).data();
    const auto index = static_cast<std::size_t>(from.drawn_->storms[id] - first);
    drawn_->storms[id] = &StormsOf(*specs[id].storms, from.seed())[index];
    const auto& track = from.drawn_->tracks[id];
    if (from.tracks_[id] == track) DrawnTrack(id) = *track;
  }
}

// Checks a loaded state. The hash detects damaged bytes; these checks prevent forged bytes from
// causing access out of bounds.
void Farm::CheckConsistent() const {
  const auto on_map = [this](Cell cell) {
    return cell.x >= 0 && cell.x < scenario_->width && cell.y >= 0 && cell.y < scenario_->height;
  };
  const auto in_list = [](std::int32_t id, std::size_t size) {
    return id >= kNone && id < static_cast<std::int32_t>(size);
  };
  bool fits = true;
  std::vector<std::int32_t> aboard(ships_.size());
  for (const Device& device : devices_) {
    fits = fits && on_map(device.cell) && in_list(device.carrier, ships_.size()) &&
           (device.carrier != kNone) == (device.status == DeviceStatus::kAboard) &&
           std::isfinite(device.value) && std::isfinite(device.health);
    if (fits && device.carrier != kNone) ++aboard[static_cast<std::size_t>(device.carrier)];
  }
  for (std::size_t i = 0; i < ships_.size(); ++i) {
    const Ship& ship = ships_[i];
    fits = fits && on_map(ship.cell) && ship.aboard == aboard[i] &&
           ship.aboard <= scenario_->ships.capacity && std::isfinite(ship.reward) &&
           std::isfinite(ship.episode_return) && std::isfinite(ship.energy + ship.distance) &&
           std::isfinite(ship.episode_energy + ship.episode_distance);
  }
  fits = fits && record_.steps >= 0 && record_.steps <= scenario_->step_limit &&
         record_.devices == static_cast<std::int32_t>(devices_.size()) && record_.ship_steps >= 0 &&
         record_.ship_steps <= record_.steps * scenario_->ships.count;
  for (std::size_t i = 0; i < disasters_.size(); ++i) {
    const std::vector<Waypoint>& track = *tracks_[i];
    fits = fits && in_list(disasters_[i].waypoint, track.size());
    const auto has_rings = [&disaster = disasters_[i]](const Waypoint& point) {
      return point.radii.size() == static_cast<std::size_t>(disaster.rings) &&
             point.risks.size() == point.radii.size() &&
             point.quadrants.size() == (disaster.by_quadrant ? point.radii.size() : 0);
    };
    for (const Waypoint& point : track) fits = fits && has_rings(point);
    if (forecasts_[i] == nullptr) continue;
    for (const IssuedForecast& forecast : *forecasts_[i]) {
      fits = fits && !forecast.points.empty() && std::isfinite(forecast.step);
      for (const Waypoint& point : forecast.points) {
        const bool ringed = !forecast.points[0].radii.empty();
        fits = fits && (ringed ? has_rings(point) : point.radii.empty());
      }
    }
  }
  if (!fits) throw InputError("state: inconsistent; use another saved state");
}

// Returns a track as a shared pointer. For a disaster with DisasterSpec::storms, a track equal to
// the drawn track gets the pointer of the drawn track. For every other disaster of the scenario, a
// track equal to that in the scenario gets a pointer into the scenario. NewestForecast then still
// finds the forecasts of the scenario.
Track Farm::Owned(std::size_t id, std::vector<Waypoint> track) const {
  const auto& specs = scenario_->disasters;
  const bool drawn = id < specs.size() && specs[id].storms;
  if (drawn && IsSame(*drawn_->tracks[id], track)) return drawn_->tracks[id];
  if (!drawn && id < specs.size() && IsSame(specs[id].track, track)) {
    return {scenario_, &specs[id].track};
  }
  return std::make_shared<const std::vector<Waypoint>>(std::move(track));
}

void Farm::SetDisaster(std::int32_t id, const DisasterSpec& spec) {
  const auto count = static_cast<std::int32_t>(disasters_.size());
  if (id < 0 || id > count || id >= kMaxDisasters) {
    throw InputError("disaster: got " + std::to_string(id) + ", expected [0, " +
                     std::to_string(std::min(count, kMaxDisasters - 1)) + "]");
  }
  ValidateDisaster(spec);
  const bool added = id == count;
  if (added && !spec.start && spec.track.empty()) {
    throw InputError("start: got nothing, expected a start or a track for a new disaster");
  }
  if (spec.storms) {
    throw InputError(
        "storms: got an archive, expected a disaster with a track; only a scenario can draw "
        "storms from an archive");
  }
  Disaster disaster =
      SpawnDisaster(spec, id, record_.seed, record_.episode, scenario_->width, scenario_->height);
  const auto k = static_cast<std::size_t>(id);
  Track track = Owned(k, spec.track);
  if (added) {
    disasters_.push_back(disaster);
    if (scenario_->view.mode == ViewMode::kPartial || !bulletins_.empty()) {
      bulletins_.resize(disasters_.size());
    }
    tracks_.push_back(std::move(track));
    forecasts_.emplace_back();
  } else {
    const Disaster& present = disasters_[k];
    if (!spec.start && spec.track.empty()) {
      disaster.x = present.x;
      disaster.y = present.y;
    }
    // The rings in the old bulletin belong to the replaced disaster.
    if (!bulletins_.empty()) CopyRings(disaster, bulletins_[k]);
    disasters_[k] = disaster;
    tracks_[k] = std::move(track);
  }
  // Random turns are drawn in blocks of four steps, and the disaster does not have the current
  // block yet.
  Disaster& placed = disasters_[k];
  placed.draws = Draw(
      {record_.seed, record_.episode, RngStream::kDisasterTurn, static_cast<std::uint32_t>(id)},
      static_cast<std::uint32_t>(record_.steps) / 4);
  if (placed.waypoint != kNone) FollowTrack(placed, *tracks_[k], record_.steps);
  tracks_changed_ = true;
  forecasts_[k].reset();
  if (spec.forecasts.empty()) return;
  forecasts_[k] = std::make_shared<const std::vector<IssuedForecast>>(spec.forecasts);
  if (scenario_->view.mode == ViewMode::kPartial) IssueBulletin(k);
}

}  // namespace aquafarm
