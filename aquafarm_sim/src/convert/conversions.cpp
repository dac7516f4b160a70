// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/convert/conversions.h"

#include <limits>
#include <memory>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/base/version.h"

namespace aquafarm_sim {
namespace {

using aquafarm::kNone;

void FillHeader(const MessageContext& context, std_msgs::Header& header) {
  header.stamp = context.stamp;
  header.frame_id = context.map_frame;
}

void FillShip(const aquafarm::Farm& farm, std::int32_t id, aquafarm_msgs::ShipState& message) {
  const aquafarm::Ship& ship = farm.ships()[static_cast<std::size_t>(id)];
  message.id = id;
  message.x = ship.cell.x;
  message.y = ship.cell.y;
  message.visible = true;
  message.own_device = ship.own_device;
  message.aboard.clear();
  const auto& devices = farm.devices();
  for (std::size_t i = 0; ship.aboard > 0 && i < devices.size(); ++i) {
    if (devices[i].carrier == id) message.aboard.push_back(static_cast<std::int32_t>(i));
  }
  message.capacity = ship.own_device == kNone ? farm.scenario().ships.capacity : 0;
  message.active = ship.active;
  message.action = static_cast<std::uint8_t>(ship.action);
  message.outcome = static_cast<std::uint8_t>(ship.outcome);
  message.terms = ToMsg(ship.terms);
  message.reward = ship.reward;
  message.episode_return = ship.episode_return;
  message.energy = ship.energy;
  message.distance = ship.distance;
  message.episode_energy = ship.episode_energy;
  message.episode_distance = ship.episode_distance;
  message.legal_actions = farm.LegalActions(id);
}

/// Fills the message of another ship for an observation in partial view.
void FillOtherShip(const aquafarm::Farm& farm, const aquafarm::KnownShip& known,
                   aquafarm_msgs::ShipState& message) {
  const aquafarm::Ship& ship = farm.ships()[static_cast<std::size_t>(known.id)];
  message = aquafarm_msgs::ShipState();
  message.id = known.id;
  message.visible = known.visible;
  message.x = known.visible ? known.cell.x : 0;
  message.y = known.visible ? known.cell.y : 0;
  message.own_device = ship.own_device;
  message.capacity = ship.own_device == kNone ? farm.scenario().ships.capacity : 0;
  message.active = ship.active;
  for (std::size_t i = 0; known.visible && i < farm.devices().size(); ++i) {
    if (farm.devices()[i].carrier == known.id) {
      message.aboard.push_back(static_cast<std::int32_t>(i));
    }
  }
  message.action = static_cast<std::uint8_t>(aquafarm::Action::kHold);
  message.outcome = static_cast<std::uint8_t>(aquafarm::Outcome::kHeld);
}

void FillKnownDevice(const aquafarm::Farm& farm, const aquafarm::View& view, std::size_t id,
                     aquafarm_msgs::DeviceState& message) {
  const aquafarm::KnownDevice& known = view.devices[id];
  message = ToMsg(farm, static_cast<std::int32_t>(id));
  message.status = static_cast<std::uint8_t>(known.status);
  message.x = known.cell.x;
  message.y = known.cell.y;
  message.value = known.value;
  message.health = known.health;
  message.health_known = known.health_known;
  message.carrier = known.aboard_self ? view.ship : kNone;
}

void FillKnownDisaster(const aquafarm::KnownDisaster& known, std::int32_t id,
                       aquafarm_msgs::DisasterState& message) {
  if (known.known) {
    ToMsg(known.belief, id, message);
  } else {
    message = aquafarm_msgs::DisasterState();
    message.id = id;
  }
  message.known = known.known;
  message.visible = known.visible;
  message.age = known.age;
}

void FillEpisode(const aquafarm::Farm& farm, const MessageContext& context,
                 aquafarm_msgs::FarmState& message) {
  FillHeader(context, message.header);
  message.observer = kNone;
  message.seed = farm.seed();
  message.episode = farm.episode();
  message.step = static_cast<std::uint64_t>(farm.step());
  message.world_time = WorldTime(farm.scenario(), farm.step());
  message.pace =
      context.paced ? aquafarm_msgs::FarmState::PACED : aquafarm_msgs::FarmState::LOCKSTEP;
  message.rate_hz = context.rate_hz;
  message.paused = context.paused;
  message.terminated = aquafarm::IsTerminated(farm.reason());
  message.truncated = aquafarm::IsTruncated(farm.reason());
  message.reason = static_cast<std::uint8_t>(farm.reason());
}

// Returns a farm at the start of the episode of `farm`, with the same layout.
aquafarm::Farm StartOf(const aquafarm::Farm& farm) {
  // The scenario outlives the returned farm, which exists only during the conversion.
  const std::shared_ptr<const aquafarm::Scenario> scenario(std::shared_ptr<void>(),
                                                           &farm.scenario());
  aquafarm::Farm start(scenario, farm.shared_layout());
  start.Reset(farm.seed(), farm.episode());
  return start;
}

void FillPlaces(const aquafarm::Farm& farm, aquafarm_msgs::FarmSpec& message) {
  const aquafarm::Scenario& scenario = farm.scenario();
  const aquafarm::Layout& layout = farm.layout();
  for (std::int32_t y = 0; y < scenario.height; ++y) {
    for (std::int32_t x = 0; x < scenario.width; ++x) {
      if ((layout.bits({x, y}) & aquafarm::kIslandBit) != 0) {
        message.islands.push_back(ToMsg(aquafarm::Cell{x, y}));
      }
    }
  }
  for (const aquafarm::Cell rock : layout.rocks) {
    message.rocks.emplace_back();
    message.rocks.back().cell = ToMsg(rock);
    message.rocks.back().reward = layout.crash_reward(rock.y, rock.x);
  }
  for (const aquafarm::Cell port : layout.ports) {
    message.ports.emplace_back();
    message.ports.back().id = static_cast<std::int32_t>(message.ports.size()) - 1;
    message.ports.back().cell = ToMsg(port);
  }
  for (std::size_t i = 0; i < farm.devices().size(); ++i) {
    message.devices.push_back(ToMsg(farm, static_cast<std::int32_t>(i)));
  }
  message.disasters.resize(farm.disasters().size());
  for (std::size_t i = 0; i < farm.disasters().size(); ++i) {
    ToMsg(farm.disasters()[i], static_cast<std::int32_t>(i), message.disasters[i]);
  }
}

// @param weight weight of energy: reward points that are subtracted per kWh
void FillRewards(const aquafarm::RewardSpec& rewards, double weight,
                 aquafarm_msgs::RewardTable& message) {
  aquafarm::VisitRewardWeights([](const aquafarm::RewardKey&, float from, float& to) { to = from; },
                               rewards, message);
  message.energy = static_cast<float>(weight);
  message.team = rewards.sharing == aquafarm::RewardSharing::kTeam;
}

template <typename T>
T ClosedSet(const char* name, std::uint8_t value, int count) {
  if (value >= count) {
    throw aquafarm::InputError(std::string(name) + ": got " + std::to_string(value) +
                               ", expected [0, " + std::to_string(count - 1) + "]");
  }
  return static_cast<T>(value);
}

void CheckSize(const std::string& name, std::size_t size, std::size_t max) {
  if (size <= max) return;
  throw aquafarm::InputError(name + ": got " + std::to_string(size) +
                             " entries, expected at most " + std::to_string(max));
}

std::vector<aquafarm::QuadrantRadii> QuadrantsOf(const std::string& name,
                                                 const std::vector<float>& flat) {
  CheckSize(name, flat.size(), 4 * aquafarm::kMaxRings);
  std::vector<aquafarm::QuadrantRadii> rings;
  if (flat.size() % 4 != 0) {
    throw aquafarm::InputError(name + ": got " + std::to_string(flat.size()) +
                               " entries, expected four per ring");
  }
  for (std::size_t i = 0; i < flat.size(); i += 4) {
    rings.push_back({flat[i], flat[i + 1], flat[i + 2], flat[i + 3]});
  }
  return rings;
}

std::vector<aquafarm::Waypoint> WaypointsFrom(
    const std::string& name, const std::vector<aquafarm_msgs::DisasterWaypoint>& messages) {
  CheckSize(name, messages.size(), kMaxWaypoints);
  std::vector<aquafarm::Waypoint> track;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const aquafarm_msgs::DisasterWaypoint& from = messages[i];
    const std::string here = name + "[" + std::to_string(i) + "]";
    CheckSize(here + ".radii", from.radii.size(), aquafarm::kMaxRings);
    CheckSize(here + ".risks", from.risks.size(), aquafarm::kMaxRings);
    aquafarm::Waypoint waypoint;
    waypoint.step = from.step;
    waypoint.x = from.x;
    waypoint.y = from.y;
    waypoint.grade = from.grade;
    waypoint.radii = from.radii;
    waypoint.risks = from.risks;
    waypoint.quadrants = QuadrantsOf(here + ".quadrants", from.quadrants);
    track.push_back(std::move(waypoint));
  }
  return track;
}

void FillAccounts(const aquafarm::Accounts& accounts, aquafarm_msgs::EpisodeSummary& message) {
  for (const aquafarm::Ledger& ledger : accounts.by_kind) {
    aquafarm_msgs::Ledger& one = message.ledgers.emplace_back();
    one.insured = ledger.insured;
    one.saved = ledger.saved;
    one.damaged = ledger.damaged;
    one.lost = ledger.lost;
  }
  message.ship_cost = accounts.ship_cost;
  message.energy_cost = accounts.energy_cost;
}

}  // namespace

aquafarm_msgs::Cell ToMsg(aquafarm::Cell cell) {
  aquafarm_msgs::Cell message;
  message.x = cell.x;
  message.y = cell.y;
  return message;
}

aquafarm_msgs::RewardTerms ToMsg(const aquafarm::RewardTerms& terms) {
  aquafarm_msgs::RewardTerms message;
  aquafarm::VisitRewardTerms([](const char*, float from, float& to) { to = from; }, terms, message);
  return message;
}

aquafarm_msgs::DeviceState ToMsg(const aquafarm::Farm& farm, std::int32_t id) {
  const aquafarm::Device& device = farm.devices()[static_cast<std::size_t>(id)];
  const aquafarm::Cell cell = farm.CellOf(id);
  aquafarm_msgs::DeviceState message;
  message.id = id;
  message.kind = static_cast<std::uint8_t>(device.kind);
  message.status = static_cast<std::uint8_t>(device.status);
  message.x = cell.x;
  message.y = cell.y;
  message.value = device.value;
  message.health = device.health;
  message.health_known = true;
  message.carrier = device.carrier;
  message.self_propelled = device.self_propelled;
  return message;
}

void ToMsg(const aquafarm::ObservableDisaster& disaster, std::int32_t id,
           aquafarm_msgs::DisasterState& message) {
  const auto rings = static_cast<std::ptrdiff_t>(disaster.rings);
  message.id = id;
  message.kind = static_cast<std::uint8_t>(disaster.kind);
  message.grade = static_cast<std::uint8_t>(disaster.grade);
  message.x = disaster.x;
  message.y = disaster.y;
  message.heading_deg = disaster.heading_deg;
  message.speed = disaster.speed;
  message.motion_x = disaster.dx;
  message.motion_y = disaster.dy;
  message.radii.assign(disaster.radius.begin(), disaster.radius.begin() + rings);
  message.risks.assign(disaster.risk.begin(), disaster.risk.begin() + rings);
  message.quadrants.clear();
  for (std::size_t k = 0; disaster.by_quadrant && k < message.radii.size(); ++k) {
    for (const auto& quadrant : disaster.quadrant) message.quadrants.push_back(quadrant[k]);
  }
  message.steps_left = disaster.steps_left;
  message.known = true;
  message.visible = true;
  message.age = 0;
}

void ToMsg(const aquafarm::Farm& farm, const MessageContext& context,
           aquafarm_msgs::FarmState& message) {
  FillEpisode(farm, context, message);
  message.ships.resize(farm.ships().size());
  message.joint_reward = 0.0F;
  message.joint_energy = message.joint_distance = 0.0;
  for (std::size_t i = 0; i < farm.ships().size(); ++i) {
    FillShip(farm, static_cast<std::int32_t>(i), message.ships[i]);
    message.joint_reward += farm.ships()[i].terms.Total();
    message.joint_energy += farm.ships()[i].energy;
    message.joint_distance += farm.ships()[i].distance;
  }
  message.joint_return = farm.record().episode_return;
  message.total_energy = farm.record().energy;
  message.total_distance = farm.record().distance;
  message.devices.resize(farm.devices().size());
  for (std::size_t i = 0; i < farm.devices().size(); ++i) {
    message.devices[i] = ToMsg(farm, static_cast<std::int32_t>(i));
  }
  message.disasters.resize(farm.disasters().size());
  for (std::size_t i = 0; i < farm.disasters().size(); ++i) {
    ToMsg(farm.disasters()[i], static_cast<std::int32_t>(i), message.disasters[i]);
  }
  message.hash = farm.Hash();
}

void ToMsg(const aquafarm::Farm& farm, const aquafarm::View& view, const MessageContext& context,
           aquafarm_msgs::FarmState& message) {
  const aquafarm::Ship& self = farm.ships()[static_cast<std::size_t>(view.ship)];
  if (farm.scenario().view.mode == aquafarm::ViewMode::kFull) {
    ToMsg(farm, context, message);
    for (std::size_t i = 0; i < view.disasters.size(); ++i) {
      message.disasters[i].motion_x = view.disasters[i].belief.dx;
      message.disasters[i].motion_y = view.disasters[i].belief.dy;
    }
  } else {
    FillEpisode(farm, context, message);
    message.ships.resize(farm.ships().size());
    FillShip(farm, view.ship, message.ships[static_cast<std::size_t>(view.ship)]);
    for (const aquafarm::KnownShip& known : view.others) {
      FillOtherShip(farm, known, message.ships[static_cast<std::size_t>(known.id)]);
    }
    message.devices.resize(view.devices.size());
    for (std::size_t i = 0; i < view.devices.size(); ++i) {
      FillKnownDevice(farm, view, i, message.devices[i]);
    }
    message.disasters.resize(view.disasters.size());
    for (std::size_t i = 0; i < view.disasters.size(); ++i) {
      FillKnownDisaster(view.disasters[i], static_cast<std::int32_t>(i), message.disasters[i]);
    }
    message.hash = 0;
  }
  message.observer = view.ship;
  message.joint_reward = self.reward;
  message.joint_return = self.episode_return;
  message.joint_energy = self.energy;
  message.joint_distance = self.distance;
  message.total_energy = self.episode_energy;
  message.total_distance = self.episode_distance;
}

void ToMsg(const aquafarm::Farm& farm, const aquafarm::Encoder& encoder, std::int32_t farms,
           const std::string& yaml, const MessageContext& context,
           aquafarm_msgs::FarmSpec& message) {
  const aquafarm::Scenario& scenario = farm.scenario();
  message = aquafarm_msgs::FarmSpec();
  FillHeader(context, message.header);
  message.version = aquafarm::kVersion;
  message.scenario_name = scenario.name;
  message.scenario_yaml = yaml;
  message.scenario_hash = scenario.hash;
  message.seed = farm.seed();
  message.episode = farm.episode();
  message.farms = farms;
  message.width = scenario.width;
  message.height = scenario.height;
  message.cell_size_m = scenario.cell_size_m;
  message.step_duration_s = scenario.step_duration_s;
  message.step_limit = scenario.step_limit;
  message.has_origin = scenario.origin.has_value();
  if (scenario.origin) {
    message.origin_latitude_deg = scenario.origin->latitude;
    message.origin_longitude_deg = scenario.origin->longitude;
  }
  message.has_start_time = scenario.start_time.has_value();
  if (scenario.start_time) message.start_time = WorldTime(scenario, 0);
  message.view_mode = scenario.view.mode == aquafarm::ViewMode::kFull
                          ? aquafarm_msgs::FarmSpec::FULL
                          : aquafarm_msgs::FarmSpec::PARTIAL;
  message.sensor_radius = scenario.view.sensor_radius;
  message.bulletin_period = scenario.view.bulletin_period;
  message.ships = scenario.ships.count;
  message.agents = static_cast<std::int32_t>(farm.ships().size());
  message.capacity = scenario.ships.capacity;
  FillPlaces(StartOf(farm), message);
  FillRewards(scenario.rewards, scenario.energy ? scenario.energy->weight : 0.0, message.rewards);
  message.state_count = encoder.state_count();
  message.feature_count = encoder.feature_count();
  message.feature_names = encoder.feature_names();
  message.plane_count = encoder.plane_count();
  message.plane_names = aquafarm::Encoder::plane_names();
}

aquafarm_msgs::EpisodeSummary ToMsg(const aquafarm::EpisodeRecord& record,
                                    const std::optional<aquafarm::Accounts>& accounts,
                                    std::int32_t farm, const MessageContext& context) {
  aquafarm_msgs::EpisodeSummary message;
  FillHeader(context, message.header);
  message.farm = farm;
  aquafarm::CopyEpisodeFields(aquafarm::SummaryOf(record, farm), message);
  message.terminated = aquafarm::IsTerminated(record.reason);
  message.truncated = aquafarm::IsTruncated(record.reason);
  message.success = record.Success();
  if (accounts) FillAccounts(*accounts, message);
  return message;
}

std::vector<aquafarm::IssuedForecast> FromMsg(
    const std::vector<aquafarm_msgs::DisasterForecast>& messages) {
  CheckSize("forecasts", messages.size(), kMaxForecasts);
  std::vector<aquafarm::IssuedForecast> forecasts;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const std::string name = "forecasts[" + std::to_string(i) + "].points";
    forecasts.push_back({messages[i].step, WaypointsFrom(name, messages[i].points)});
  }
  return forecasts;
}

aquafarm::DisasterSpec FromMsg(const aquafarm_msgs::DisasterInfo& message) {
  CheckSize("info.radii", message.radii.size(), aquafarm::kMaxRings);
  CheckSize("info.risks", message.risks.size(), aquafarm::kMaxRings);
  aquafarm::DisasterSpec spec;
  spec.kind =
      ClosedSet<aquafarm::DisasterKind>("info.kind", message.kind, aquafarm::kDisasterKindCount);
  spec.grade = message.grade;
  spec.radii = message.radii;
  spec.risks = message.risks;
  spec.quadrants = QuadrantsOf("info.quadrants", message.quadrants);
  spec.speed = message.speed;
  if (message.has_heading) spec.heading_deg = message.heading_deg;
  spec.turn_probability = message.turn_probability;
  spec.radius_growth = message.radius_growth;
  spec.border = ClosedSet<aquafarm::Border>("info.border", message.border, 3);
  spec.duration = message.duration;
  if (message.has_start) spec.start = {message.x, message.y};
  spec.track = WaypointsFrom("info.track", message.track);
  if (!spec.track.empty()) spec.quadrants = spec.track.front().quadrants;
  return spec;
}

ros::Time WorldTime(const aquafarm::Scenario& scenario, std::int64_t step) {
  const double start_s = static_cast<double>(scenario.start_time.value_or(0));
  const double time_s = start_s + static_cast<double>(step) * scenario.step_duration_s;
  constexpr double kMaxTime_s = std::numeric_limits<std::uint32_t>::max();
  if (!(time_s >= 0.0 && time_s < kMaxTime_s)) return ros::Time(0, 0);
  return ros::Time(time_s);
}

}  // namespace aquafarm_sim
