// SPDX-License-Identifier: BSD-3-Clause
// Hashing, saving and loading of an episode in progress, and disasters that arrive during it.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/base/hash.h"
#include "aquafarm/base/version.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/scenario/validate.h"
#include "base/cbor.h"

namespace aquafarm {
namespace {

using nlohmann::json;

constexpr int kStateFormat = 1;

template <typename Enum>
std::int32_t Int(Enum value) {
  return static_cast<std::int32_t>(value);
}

// Returns whether the rings may have changed since the last bulletin was issued.
bool TellsRings(const Disaster& disaster) {
  return disaster.radius_growth != 0.0F && disaster.bulletin.step != kNone;
}

void HashDisaster(const Disaster& disaster, Hasher& hasher) {
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
  const Bulletin& bulletin = disaster.bulletin;
  hasher.Add(bulletin.x, bulletin.y);
  hasher.Add(bulletin.heading_deg, bulletin.step);
  if (!TellsRings(disaster)) return;
  for (std::size_t k = 0; k < static_cast<std::size_t>(disaster.rings); ++k) {
    hasher.Add(bulletin.radius[k], bulletin.speed);
    for (std::size_t q = 0; disaster.by_quadrant && q < bulletin.quadrant.size(); ++q) {
      hasher.Add(bulletin.quadrant[q][k], 0.0F);
    }
  }
}

void HashTracks(const std::vector<Track>& tracks, Hasher& hasher) {
  for (const Track& track : tracks) {
    hasher.Add(static_cast<std::uint64_t>(track->size()));
    for (const Waypoint& point : *track) {
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
}

json CellToJson(Cell cell) { return json::array({cell.x, cell.y}); }
Cell CellFromJson(const json& j) {
  return {j.at(0).get<std::int32_t>(), j.at(1).get<std::int32_t>()};
}

template <typename Enum>
Enum EnumFromJson(const json& j, int count) {
  const int value = j.get<int>();
  if (value < 0 || value >= count) throw InputError("state: an enumeration value out of range");
  return static_cast<Enum>(value);
}

json ShipToJson(const Ship& ship) {
  const RewardTerms& t = ship.terms;
  return {{"cell", CellToJson(ship.cell)},
          {"own_device", ship.own_device},
          {"aboard", ship.aboard},
          {"in_play", ship.in_play},
          {"action", Int(ship.action)},
          {"outcome", Int(ship.outcome)},
          {"terms", {t.crash, t.disaster, t.pickup, t.drop_off, t.illegal, t.collision, t.step}},
          {"reward", ship.reward},
          {"return", ship.episode_return}};
}

Ship ShipFromJson(const json& j) {
  Ship ship;
  ship.cell = CellFromJson(j.at("cell"));
  ship.own_device = j.at("own_device").get<std::int32_t>();
  ship.aboard = j.at("aboard").get<std::int32_t>();
  ship.in_play = j.at("in_play").get<bool>();
  ship.action = EnumFromJson<Action>(j.at("action"), kActionCount + 1);
  ship.outcome = EnumFromJson<Outcome>(j.at("outcome"), kOutcomeCount);
  const auto terms = j.at("terms").get<std::array<float, kRewardTermCount>>();
  ship.terms = {terms[0], terms[1], terms[2], terms[3], terms[4], terms[5], terms[6]};
  ship.reward = j.at("reward").get<float>();
  ship.episode_return = j.at("return").get<float>();
  return ship;
}

json DeviceToJson(const Device& device) {
  return {{"cell", CellToJson(device.cell)},
          {"value", device.value},
          {"health", device.health},
          {"carrier", device.carrier},
          {"kind", Int(device.kind)},
          {"status", Int(device.status)},
          {"self_propelled", device.self_propelled}};
}

Device DeviceFromJson(const json& j) {
  Device device;
  device.cell = CellFromJson(j.at("cell"));
  device.value = j.at("value").get<float>();
  device.health = j.at("health").get<float>();
  device.carrier = j.at("carrier").get<std::int32_t>();
  device.kind = EnumFromJson<DeviceKind>(j.at("kind"), kDeviceKindCount);
  device.status = EnumFromJson<DeviceStatus>(j.at("status"), kDeviceStatusCount);
  device.self_propelled = j.at("self_propelled").get<bool>();
  return device;
}

json DisasterToJson(const Disaster& d) {
  const Bulletin& b = d.bulletin;
  json j{{"kind", Int(d.kind)},
         {"border", Int(d.border)},
         {"grade", d.grade},
         {"rings", d.rings},
         {"radius", d.radius},
         {"radius_squared", d.radius_squared},
         {"risk", d.risk},
         {"centre", {d.x, d.y}},
         {"motion", {d.dx, d.dy}},
         {"speed", d.speed},
         {"heading_deg", d.heading_deg},
         {"turn_threshold", d.turn_threshold},
         {"radius_growth", d.radius_growth},
         {"margin", d.margin},
         {"steps_left", d.steps_left},
         {"waypoint", d.waypoint},
         {"draws", d.draws},
         {"bulletin", {b.x, b.y, b.speed}},
         {"bulletin_when", {b.heading_deg, b.step}}};
  if (d.by_quadrant) j["quadrants"] = d.quadrant;
  if (TellsRings(d)) j["bulletin_rings"] = {b.radius, b.quadrant};
  return j;
}

Disaster DisasterFromJson(const json& j) {
  Disaster d;
  d.kind = EnumFromJson<DisasterKind>(j.at("kind"), kDisasterKindCount);
  d.border = EnumFromJson<Border>(j.at("border"), Int(Border::kLeave) + 1);
  j.at("grade").get_to(d.grade);
  j.at("rings").get_to(d.rings);
  if (d.rings < 0 || d.rings > kMaxRings) throw InputError("state: disaster rings out of range");
  j.at("radius").get_to(d.radius);
  j.at("radius_squared").get_to(d.radius_squared);
  j.at("risk").get_to(d.risk);
  j.at("centre").at(0).get_to(d.x);
  j.at("centre").at(1).get_to(d.y);
  j.at("motion").at(0).get_to(d.dx);
  j.at("motion").at(1).get_to(d.dy);
  j.at("speed").get_to(d.speed);
  j.at("heading_deg").get_to(d.heading_deg);
  if (d.heading_deg < 0 || d.heading_deg > 359) throw InputError("state: heading out of range");
  j.at("turn_threshold").get_to(d.turn_threshold);
  j.at("radius_growth").get_to(d.radius_growth);
  j.at("margin").get_to(d.margin);
  j.at("steps_left").get_to(d.steps_left);
  j.at("waypoint").get_to(d.waypoint);
  j.at("draws").get_to(d.draws);
  j.at("bulletin").at(0).get_to(d.bulletin.x);
  j.at("bulletin").at(1).get_to(d.bulletin.y);
  j.at("bulletin").at(2).get_to(d.bulletin.speed);
  j.at("bulletin_when").at(0).get_to(d.bulletin.heading_deg);
  j.at("bulletin_when").at(1).get_to(d.bulletin.step);
  if (d.bulletin.heading_deg < 0 || d.bulletin.heading_deg > 359) {
    throw InputError("state: bulletin heading out of range");
  }
  d.by_quadrant = j.contains("quadrants");
  bool finite = true;
  for (std::size_t k = 0; d.by_quadrant && k < static_cast<std::size_t>(kMaxRings); ++k) {
    QuadrantRadii ring{};
    for (std::size_t q = 0; q < ring.size(); ++q) {
      j.at("quadrants").at(q).at(k).get_to(ring[q]);
      finite = finite && std::isfinite(ring[q]);
    }
    if (k < static_cast<std::size_t>(d.rings)) SetRing(d, k, ring);
  }
  d.SnapshotRings();
  if (j.contains("bulletin_rings")) {
    j["bulletin_rings"].at(0).get_to(d.bulletin.radius);
    j["bulletin_rings"].at(1).get_to(d.bulletin.quadrant);
    for (std::size_t k = 0; k < d.radius.size(); ++k) {
      finite = finite && std::isfinite(d.bulletin.radius[k]);
      for (const auto& side : d.bulletin.quadrant) finite = finite && std::isfinite(side[k]);
    }
  } else if (TellsRings(d)) {
    throw InputError(
        "state: disaster: bulletin_rings: missing, expected the rings as the last bulletin told "
        "them, which states saved by older versions lack");
  }
  for (const float value : {d.x, d.y, d.dx, d.dy, d.speed, d.radius_growth, d.margin, d.bulletin.x,
                            d.bulletin.y, d.bulletin.speed}) {
    finite = finite && std::isfinite(value);
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(kMaxRings); ++k) {
    finite = finite && std::isfinite(d.radius[k]) && std::isfinite(d.radius_squared[k]) &&
             std::isfinite(d.risk[k]);
  }
  if (!finite) throw InputError("state: a disaster's number is not finite");
  return d;
}

json TrackToJson(const std::vector<Waypoint>& track) {
  json points = json::array();
  for (const Waypoint& point : track) {
    points.push_back({point.step, point.x, point.y, point.grade, point.radii, point.risks});
    if (!point.quadrants.empty()) points.back().push_back(point.quadrants);
  }
  return points;
}

std::vector<Waypoint> TrackFromJson(const json& points) {
  std::vector<Waypoint> track;
  for (const json& point : points) {
    track.push_back({point.at(0).get<float>(), point.at(1).get<float>(), point.at(2).get<float>(),
                     point.at(3).get<std::int32_t>(), point.at(4).get<std::vector<float>>(),
                     point.at(5).get<std::vector<float>>(),
                     point.size() > 6 ? point.at(6).get<std::vector<QuadrantRadii>>()
                                      : std::vector<QuadrantRadii>()});
  }
  return track;
}

bool IsSame(const std::vector<Waypoint>& a, const std::vector<Waypoint>& b) {
  const auto all = [](const Waypoint& w) {
    return std::tie(w.step, w.x, w.y, w.grade, w.radii, w.risks, w.quadrants);
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&all](const Waypoint& p, const Waypoint& q) { return all(p) == all(q); });
}

json RecordToJson(const EpisodeRecord& r) {
  return {{"seed", r.seed},
          {"episode", r.episode},
          {"steps", r.steps},
          {"return", r.episode_return},
          {"delivered", r.delivered},
          {"devices", r.devices},
          {"delivered_health", r.delivered_health},
          {"crashes", r.crashes},
          {"collisions", r.collisions},
          {"steps_in_disaster", r.steps_in_disaster},
          {"reason", Int(r.reason)}};
}

EpisodeRecord RecordFromJson(const json& j) {
  EpisodeRecord r;
  j.at("seed").get_to(r.seed);
  j.at("episode").get_to(r.episode);
  j.at("steps").get_to(r.steps);
  j.at("return").get_to(r.episode_return);
  j.at("delivered").get_to(r.delivered);
  j.at("devices").get_to(r.devices);
  j.at("delivered_health").get_to(r.delivered_health);
  j.at("crashes").get_to(r.crashes);
  j.at("collisions").get_to(r.collisions);
  j.at("steps_in_disaster").get_to(r.steps_in_disaster);
  r.reason = EnumFromJson<EndReason>(j.at("reason"), kEndReasonCount);
  return r;
}

template <typename T>
void RequireSame(const char* what, const T& got, const T& expected) {
  if (got == expected) return;
  std::ostringstream text;
  text << "state: " << what << ": got " << got << ", expected " << expected;
  throw InputError(text.str());
}

}  // namespace

std::uint64_t Farm::Hash() const {
  Hasher hasher;
  hasher.Add(scenario_->hash);
  hasher.Add(record_.seed);
  hasher.Add(record_.episode);
  hasher.Add(record_.steps, Int(record_.reason));
  for (const Ship& ship : ships_) {
    hasher.Add(ship.cell.x, ship.cell.y);
    hasher.Add(ship.own_device, ship.aboard);
    hasher.Add(ship.reward, ship.episode_return);
    hasher.Add(Int(ship.outcome), ship.in_play ? 1 : 0);
  }
  for (const Device& device : devices_) {
    hasher.Add(device.cell.x, device.cell.y);
    hasher.Add(device.value, device.health);
    hasher.Add(device.carrier, Int(device.status));
  }
  for (const Disaster& disaster : disasters_) HashDisaster(disaster, hasher);
  if (tracks_changed_) HashTracks(tracks_, hasher);  // else they are those of the scenario
  return hasher.value();
}

std::string Farm::Save() const {
  json state{{"format", kStateFormat},
             {"version", kVersion},
             {"scenario", scenario_->name},
             {"scenario_hash", scenario_->hash},
             {"record", RecordToJson(record_)},
             {"ships", json::array()},
             {"devices", json::array()},
             {"disasters", json::array()},
             {"hash", Hash()}};
  for (const Ship& ship : ships_) state["ships"].push_back(ShipToJson(ship));
  for (const Device& device : devices_) state["devices"].push_back(DeviceToJson(device));
  for (const Disaster& disaster : disasters_) {
    state["disasters"].push_back(DisasterToJson(disaster));
  }
  if (tracks_changed_) {
    for (const Track& track : tracks_) state["tracks"].push_back(TrackToJson(*track));
  }
  std::string payload;
  json::to_cbor(state, payload);
  const json sealed{{"checksum", HashBytes(payload)},
                    {"state", json::binary({payload.begin(), payload.end()})}};
  std::string bytes;
  json::to_cbor(sealed, bytes);
  return bytes;
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
    const EpisodeRecord record = RecordFromJson(state.at("record"));
    loaded.Reset(record.seed, record.episode);
    loaded.record_ = record;
    RequireSame("ships", state.at("ships").size(), loaded.ships_.size());
    RequireSame("devices", state.at("devices").size(), loaded.devices_.size());
    const std::size_t disasters = state.at("disasters").size();
    if (disasters < scenario_->disasters.size() ||
        disasters > static_cast<std::size_t>(kMaxDisasters)) {
      throw InputError("state: disasters: got " + std::to_string(disasters) + ", expected [" +
                       std::to_string(scenario_->disasters.size()) + ", " +
                       std::to_string(kMaxDisasters) + "]");
    }
    for (std::size_t i = 0; i < loaded.ships_.size(); ++i) {
      const std::int32_t own_device = loaded.ships_[i].own_device;
      loaded.ships_[i] = ShipFromJson(state["ships"][i]);
      RequireSame("own_device", loaded.ships_[i].own_device, own_device);
    }
    for (std::size_t i = 0; i < loaded.devices_.size(); ++i) {
      const bool self_propelled = loaded.devices_[i].self_propelled;
      loaded.devices_[i] = DeviceFromJson(state["devices"][i]);
      RequireSame("self_propelled", loaded.devices_[i].self_propelled, self_propelled);
    }
    loaded.remaining_ = 0;
    for (const Device& device : loaded.devices_) {
      loaded.remaining_ += device.status == DeviceStatus::kDelivered ? 0 : 1;
    }
    loaded.disasters_.clear();
    for (const json& disaster : state.at("disasters")) {
      loaded.disasters_.push_back(DisasterFromJson(disaster));
    }
    if (state.contains("tracks")) {
      loaded.tracks_changed_ = true;
      loaded.tracks_.clear();
      for (const json& track : state["tracks"]) {
        loaded.tracks_.push_back(loaded.Owned(loaded.tracks_.size(), TrackFromJson(track)));
      }
    }
    RequireSame("tracks", loaded.tracks_.size(), disasters);
    loaded.CheckConsistent();
    loaded.IndexShips();
    RequireSame("hash", loaded.Hash(), state.at("hash").get<std::uint64_t>());
  } catch (const json::exception& error) {
    throw InputError(std::string("state: damaged bytes: ") + error.what());
  }
  *this = std::move(loaded);
}

// The hash detects damaged bytes. Forged bytes must not cause out-of-bounds access either.
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
           std::isfinite(ship.episode_return);
  }
  fits = fits && record_.steps >= 0 && record_.steps <= scenario_->step_limit &&
         record_.devices == static_cast<std::int32_t>(devices_.size());
  for (std::size_t i = 0; i < disasters_.size(); ++i) {
    const std::vector<Waypoint>& track = *tracks_[i];
    fits = fits && in_list(disasters_[i].waypoint, track.size());
    for (const Waypoint& point : track) {
      fits = fits && point.radii.size() == static_cast<std::size_t>(disasters_[i].rings) &&
             point.risks.size() == point.radii.size() &&
             (disasters_[i].by_quadrant ? point.quadrants.size() == point.radii.size()
                                        : point.quadrants.empty());
    }
  }
  if (!fits) throw InputError("state: its parts do not fit together");
}

// Keeps the scenario's own track if the tracks are equal, so that its forecasts stay available.
Track Farm::Owned(std::size_t id, std::vector<Waypoint> track) const {
  const auto& specs = scenario_->disasters;
  if (id < specs.size() && IsSame(specs[id].track, track)) return {scenario_, &specs[id].track};
  return std::make_shared<const std::vector<Waypoint>>(std::move(track));
}

void Farm::SetDisaster(std::int32_t id, const DisasterSpec& spec) {
  const auto count = static_cast<std::int32_t>(disasters_.size());
  if (id < 0 || id > count || id >= kMaxDisasters) {
    throw InputError("disaster: got " + std::to_string(id) + ", expected [0, " +
                     std::to_string(std::min(count, kMaxDisasters - 1)) + "]");
  }
  ValidateDisaster(spec);
  if (!spec.forecasts.empty()) {
    throw InputError("forecasts: got " + std::to_string(spec.forecasts.size()) +
                     ", expected none: agents are told those of the scenario alone");
  }
  const bool added = id == count;
  if (added && !spec.start && spec.track.empty()) {
    throw InputError("start: a new disaster needs a start or a track");
  }
  Disaster disaster =
      SpawnDisaster(spec, id, record_.seed, record_.episode, scenario_->width, scenario_->height);
  const auto k = static_cast<std::size_t>(id);
  Track track = Owned(k, spec.track);
  if (added) {
    disasters_.push_back(disaster);
    tracks_.push_back(std::move(track));
  } else {
    const Disaster& present = disasters_[k];
    if (!spec.start && spec.track.empty()) {
      disaster.x = present.x;
      disaster.y = present.y;
    }
    disaster.bulletin = present.bulletin;
    disaster.SnapshotRings();  // ring sizes of the replaced disaster do not apply to the new one
    disasters_[k] = disaster;
    tracks_[k] = std::move(track);
  }
  // Turn draws come in blocks of four steps; the current block is not drawn yet.
  Disaster& placed = disasters_[k];
  placed.draws = Draw(
      {record_.seed, record_.episode, RngStream::kDisasterTurn, static_cast<std::uint32_t>(id)},
      static_cast<std::uint32_t>(record_.steps) / 4);
  if (placed.waypoint != kNone) FollowTrack(placed, *tracks_[k], record_.steps);
  tracks_changed_ = true;
}

}  // namespace aquafarm
