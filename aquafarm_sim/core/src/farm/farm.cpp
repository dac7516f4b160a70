// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/farm.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/energy.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/storms/draw_storm.h"

namespace aquafarm {
namespace {

float Clamped(float health) { return health > 0.0F ? health : 0.0F; }

// Returns whether the action of a ship triggered a reward term that replaces the step reward, even
// if that term is 0.
bool TriggersReward(const Ship& ship) {
  switch (ship.outcome) {
    case Outcome::kOk:
      return ship.action == Action::kPickup || ship.action == Action::kDropOff;
    case Outcome::kEdge:
    case Outcome::kHeld:
    case Outcome::kOutOfPlay:
      return false;
    default:
      return true;
  }
}

}  // namespace

float CrashDamage(const Scenario& scenario, std::uint8_t bits, float crash_reward) {
  return (bits & kIslandBit) != 0 ? scenario.damage.island_damage : -crash_reward / 100.0F;
}

EpisodeSummary SummaryOf(const EpisodeRecord& record, std::int32_t farm) {
  EpisodeSummary summary;
  static_cast<EpisodeStatistics&>(summary) = record;
  if (record.delivered > 0) summary.delivered_health /= static_cast<float>(record.delivered);
  summary.farm = farm;
  return summary;
}

Farm::Farm(std::shared_ptr<const Scenario> scenario) : Farm(std::move(scenario), nullptr) {}

Farm::Farm(std::shared_ptr<const Scenario> scenario, std::shared_ptr<const Layout> fixed_layout)
    : scenario_(std::move(scenario)), layout_(std::move(fixed_layout)) {
  if (layout_ == nullptr) {
    own_layout_ = std::make_shared<Layout>();
    layout_ = own_layout_;
    generator_ = std::make_unique<LayoutGenerator>(*scenario_);
  }
  ships_.reserve(static_cast<std::size_t>(scenario_->AgentCount()));
  ship_index_.reserve(ships_.capacity());
  devices_.reserve(static_cast<std::size_t>(scenario_->devices.Total()));
  disasters_.reserve(scenario_->disasters.size());
  const std::vector<DisasterSpec>& specs = scenario_->disasters;
  if (std::any_of(specs.begin(), specs.end(), [](const auto& spec) { return spec.storms; })) {
    drawn_ = std::make_unique<DrawnStorms>();
    drawn_->tracks.resize(specs.size());
    drawn_->storms.resize(specs.size());
  }
  move_km_ = {MoveLength(Action::kNorth) * scenario_->cell_size_m / 1000.0,
              MoveLength(Action::kNorthEast) * scenario_->cell_size_m / 1000.0};
  ResetTracks();
  Reset(0, 0);
}

void Farm::ResetTracks() {
  tracks_.clear();
  for (const DisasterSpec& spec : scenario_->disasters) {
    // The aliasing pointer shares ownership of the scenario, which contains the waypoints.
    tracks_.emplace_back(scenario_, &spec.track);
  }
  tracks_changed_ = false;
}

void Farm::DrawStorms() {
  const double x = (scenario_->width - 1) / 2.0;
  const double y = (scenario_->height - 1) / 2.0;
  for (std::size_t id = 0; id < scenario_->disasters.size(); ++id) {
    const std::optional<StormsSpec>& storms = scenario_->disasters[id].storms;
    if (!storms) continue;
    const DrawnStorm drawn =
        DrawStorm(*storms, record_.seed, record_.episode, static_cast<std::int32_t>(id), x, y);
    drawn_->storms[id] = drawn.storm;
    drawn_->errors.assign(1, drawn.errors);
    drawn_->placer.Place(drawn.storm->path, drawn_->errors, storms->risks, DrawnTrack(id));
  }
}

// Gives a disaster a track of its own and returns it. The caller must set the waypoints.
std::vector<Waypoint>& Farm::DrawnTrack(std::size_t id) {
  tracks_[id].reset();
  std::shared_ptr<std::vector<Waypoint>>& track = drawn_->tracks[id];
  if (track == nullptr || track.use_count() > 1) track = std::make_shared<std::vector<Waypoint>>();
  tracks_[id] = track;
  return *track;
}

const ArchivedStorm* Farm::DrawnStormOf(std::int32_t disaster) const {
  const auto id = static_cast<std::size_t>(disaster);
  return drawn_ != nullptr && id < drawn_->storms.size() ? drawn_->storms[id] : nullptr;
}

void Farm::Reset(std::uint64_t seed, std::uint64_t episode) {
  const bool draw = own_layout_ != nullptr && (scenario_->layout == LayoutMode::kPerEpisode ||
                                               own_layout_->cells.size() == 0);
  if (draw) generator_->Generate(seed, episode, *own_layout_);
  record_ = EpisodeRecord{};
  record_.seed = seed;
  record_.episode = episode;
  if (tracks_changed_) ResetTracks();
  if (drawn_ != nullptr) DrawStorms();
  forecasts_.assign(scenario_->disasters.size(), nullptr);

  devices_.clear();
  for (const PlacedDevice& placed : layout_->devices) {
    Device device;
    device.cell = placed.cell;
    device.value = placed.value;
    device.health = scenario_->devices.health;
    device.kind = placed.kind;
    device.self_propelled = placed.self_propelled;
    devices_.push_back(device);
  }
  record_.devices = static_cast<std::int32_t>(devices_.size());
  remaining_ = record_.devices;

  ships_.clear();
  for (std::int32_t id = 0; id < scenario_->ships.count; ++id) {
    Ship ship;
    const auto draws = Draw({seed, episode, RngStream::kStart, static_cast<std::uint32_t>(id)}, 0);
    const auto ports = static_cast<std::uint32_t>(layout_->ports.size());
    ship.cell = layout_->ports[ToBelow(draws[0], ports)];
    ships_.push_back(ship);
  }
  for (std::size_t device = 0; device < devices_.size(); ++device) {
    if (!devices_[device].self_propelled) continue;
    Ship ship;
    ship.cell = devices_[device].cell;
    ship.own_device = static_cast<std::int32_t>(device);
    ships_.push_back(ship);
  }

  IndexShips();

  disasters_.clear();
  for (std::size_t id = 0; id < scenario_->disasters.size(); ++id) {
    disasters_.push_back(SpawnDisaster(scenario_->disasters[id], static_cast<std::int32_t>(id),
                                       seed, episode, scenario_->width, scenario_->height,
                                       tracks_[id].get()));
  }
  const bool is_partial = scenario_->view.mode == ViewMode::kPartial;
  bulletins_.assign(is_partial ? disasters_.size() : 0, Bulletin{});
  IssueBulletins();
}

void Farm::IndexShips() {
  ship_index_.clear();
  for (const Ship& ship : ships_) {
    ship_index_.push_back(ship.active ? LinearIndex(ship.cell, scenario_->width) : kNone);
  }
}

void Farm::Prefetch() const {
  constexpr std::size_t kLine = 64;
  const auto load = [](const void* from, std::size_t size) {
    if (from == nullptr) return;  // an empty list, for example without disasters
    for (std::size_t at = 0; at < size; at += kLine) {
      __builtin_prefetch(static_cast<const char*>(from) + at, /*will be written*/ 1);
    }
  };
  // Loads only the first object of each list: most farms have one ship and one disaster.
  load(ships_.data(), sizeof(Ship));
  load(devices_.data(), sizeof(Device));
  load(disasters_.data(), sizeof(Disaster));
}

void Farm::Step(const std::uint8_t* actions) {
  AQUAFARM_CHECK_EQ(static_cast<int>(record_.reason), static_cast<int>(EndReason::kNone));
  ++record_.steps;
  MoveDisasters();
  for (std::size_t id = 0; id < ships_.size(); ++id) {
    Act(static_cast<std::int32_t>(id), static_cast<Action>(actions[id]));
  }
  Damage();
  if (scenario_->energy) Consume(*scenario_->energy);
  Reward();
  if (scenario_->money) CountShipSteps();
  Finish();
}

void Farm::MoveDisasters() {
  for (std::size_t id = 0; id < disasters_.size(); ++id) {
    const StreamKey key{record_.seed, record_.episode, RngStream::kDisasterTurn,
                        static_cast<std::uint32_t>(id)};
    MoveDisaster(disasters_[id], tracks_[id], key, record_.steps, scenario_->width,
                 scenario_->height);
  }
  IssueBulletins();
}

void Farm::IssueBulletins() {
  const ViewSpec& view = scenario_->view;
  if (view.mode == ViewMode::kFull || view.bulletin_period == 0) return;
  if (record_.steps % view.bulletin_period != 0) return;
  for (std::size_t id = 0; id < disasters_.size(); ++id) IssueBulletin(id);
}

void Farm::IssueBulletin(std::size_t id) {
  const Disaster& disaster = disasters_[id];
  Bulletin& bulletin = bulletins_[id];
  const auto draws =
      Draw({record_.seed, record_.episode, RngStream::kSensors, static_cast<std::uint32_t>(id)},
           static_cast<std::uint32_t>(record_.steps));
  const float noise = scenario_->view.bulletin_noise;
  bulletin.x = disaster.x + noise * (2.0F * ToUnit(draws[0]) - 1.0F);
  bulletin.y = disaster.y + noise * (2.0F * ToUnit(draws[1]) - 1.0F);
  bulletin.speed = disaster.speed;
  bulletin.heading_deg = disaster.heading_deg;
  bulletin.step = record_.steps;
  CopyRings(disaster, bulletin);
}

void Farm::Act(std::int32_t id, Action action) {
  Ship& ship = ships_[static_cast<std::size_t>(id)];
  ship.terms = RewardTerms{};
  ship.energy = 0.0;
  ship.distance = 0.0;
  ship.action = action;
  if (!ship.active) {
    ship.outcome = Outcome::kOutOfPlay;
    return;
  }
  if (action < Action::kPickup) {
    Move(ship, id, action);
  } else if (action == Action::kPickup) {
    PickUp(ship, id);
  } else if (action == Action::kDropOff) {
    DropOff(ship, id);
  } else {
    AQUAFARM_CHECK_EQ(static_cast<int>(action), static_cast<int>(Action::kHold));
    ship.outcome = Outcome::kHeld;
  }
}

// Returns whether an active ship is in the cell with a linear index. Callers that want to move a
// ship must not pass the cell that this ship occupies.
bool Farm::Occupied(std::int32_t index) const {
  std::int32_t found = 0;
  for (const std::int32_t other : ship_index_) found += other == index ? 1 : 0;
  return found != 0;
}

bool Farm::CanPlaceShip(std::int32_t ship, Cell cell) const {
  AQUAFARM_CHECK_LT(static_cast<std::size_t>(ship), ships_.size());
  const bool on_map =
      cell.x >= 0 && cell.x < scenario_->width && cell.y >= 0 && cell.y < scenario_->height;
  if (!on_map || (layout_->bits(cell) & kBlockedBits) != 0) return false;
  return ships_[static_cast<std::size_t>(ship)].cell == cell ||
         (layout_->bits(cell) & kPortBit) != 0 || !Occupied(LinearIndex(cell, scenario_->width));
}

void Farm::PlaceShip(std::int32_t ship, Cell cell) {
  if (!CanPlaceShip(ship, cell)) {
    throw InputError("cell: got (" + std::to_string(cell.x) + ", " + std::to_string(cell.y) +
                     "), expected free water on the map");
  }
  Ship& one = ships_[static_cast<std::size_t>(ship)];
  one.cell = cell;
  if (one.own_device != kNone) devices_[static_cast<std::size_t>(one.own_device)].cell = cell;
  IndexShips();
}

void Farm::Move(Ship& ship, std::int32_t id, Action action) {
  const Cell by = kMoves[static_cast<std::size_t>(action)];
  const Cell to{ship.cell.x + by.x, ship.cell.y + by.y};
  const bool on_map =
      static_cast<std::uint32_t>(to.x) < static_cast<std::uint32_t>(scenario_->width) &&
      static_cast<std::uint32_t>(to.y) < static_cast<std::uint32_t>(scenario_->height);
  if (!on_map) {
    ship.outcome = Outcome::kEdge;
    return;
  }
  const std::uint8_t bits = layout_->bits(to);
  if ((bits & kBlockedBits) != 0) {
    ship.outcome = Outcome::kCrash;
    ship.terms.crash = layout_->crash_reward(to.y, to.x);
    ++record_.crashes;
    CrashInto(ship, id, bits);
    return;
  }
  const std::int32_t index = LinearIndex(to, scenario_->width);
  if (ships_.size() > 1 && (bits & kPortBit) == 0 && Occupied(index)) {
    ship.outcome = Outcome::kCollision;
    ship.terms.collision = scenario_->rewards.collision;
    ++record_.collisions;
    return;
  }
  ship.outcome = Outcome::kOk;
  ship.distance = move_km_[static_cast<std::size_t>(std::abs(by.x * by.y))];  // [1] is diagonal
  ship.episode_distance += ship.distance;
  record_.distance += ship.distance;
  ship.cell = to;
  ship_index_[static_cast<std::size_t>(id)] = index;
  if (ship.own_device != kNone) devices_[static_cast<std::size_t>(ship.own_device)].cell = to;
}

// Reduces the health of the devices that a crash damages. Step calls Damage() later. The order does
// not matter, because a ship that crashes does not deliver in the same step.
void Farm::CrashInto(const Ship& ship, std::int32_t id, std::uint8_t bits) {
  if (ship.aboard == 0 && ship.own_device == kNone) return;
  const float probability = scenario_->damage.crash_probability;
  if (probability < 1.0F) {
    const StreamKey key{record_.seed, record_.episode, RngStream::kDamage,
                        static_cast<std::uint32_t>(id)};
    const auto draws = Draw(key, static_cast<std::uint32_t>(record_.steps));
    if (ToUnit(draws[0]) >= probability) return;
  }
  const float loss = CrashDamage(*scenario_, bits, ship.terms.crash);
  if (ship.own_device != kNone) {
    Device& own = devices_[static_cast<std::size_t>(ship.own_device)];
    own.health = Clamped(own.health - loss);
    return;
  }
  for (Device& device : devices_) {
    if (device.carrier == id) device.health = Clamped(device.health - loss);
  }
}

std::int32_t Farm::DeviceToPickUp(const Ship& ship) const {
  if ((layout_->bits(ship.cell) & kDeviceSiteBit) == 0) return kNone;
  if (ship.own_device != kNone || ship.aboard >= scenario_->ships.capacity) return kNone;
  for (std::size_t id = 0; id < devices_.size(); ++id) {
    const Device& device = devices_[id];
    if (device.cell == ship.cell && device.status == DeviceStatus::kDeployed &&
        !device.self_propelled) {
      return static_cast<std::int32_t>(id);
    }
  }
  return kNone;
}

void Farm::PickUp(Ship& ship, std::int32_t id) {
  const std::int32_t found = DeviceToPickUp(ship);
  if (found == kNone) {
    ship.outcome = Outcome::kIllegalPickup;
    ship.terms.illegal = scenario_->rewards.illegal;
    return;
  }
  Device& device = devices_[static_cast<std::size_t>(found)];
  device.status = DeviceStatus::kAboard;
  device.carrier = id;
  ++ship.aboard;
  ship.outcome = Outcome::kOk;
  ship.terms.pickup = scenario_->rewards.pickup;
}

void Farm::DropOff(Ship& ship, std::int32_t id) {
  const bool at_port = (layout_->bits(ship.cell) & kPortBit) != 0;
  if (!at_port || (ship.aboard == 0 && ship.own_device == kNone)) {
    ship.outcome = Outcome::kIllegalDropOff;
    ship.terms.illegal = scenario_->rewards.illegal;
    return;
  }
  float value = 0.0F;
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    Device& device = devices_[i];
    if (device.carrier != id && static_cast<std::int32_t>(i) != ship.own_device) continue;
    device.status = DeviceStatus::kDelivered;
    device.carrier = kNone;
    device.cell = ship.cell;
    value += device.health * device.value;
    record_.delivered_health += device.health;
    ++record_.delivered;
    --remaining_;
  }
  ship.aboard = 0;
  if (ship.own_device != kNone) {
    ship.active = false;
    ship_index_[static_cast<std::size_t>(id)] = kNone;
  }
  ship.outcome = Outcome::kOk;
  ship.terms.drop_off = scenario_->rewards.drop_off + value;
}

// Damages each device that is not delivered, whether it is aboard or not. The damage depends on the
// risk at its current cell.
void Farm::Damage() {
  const float exposure = scenario_->damage.exposure_damage;
  if (exposure == 0.0F) return;
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    Device& device = devices_[i];
    if (device.status == DeviceStatus::kDelivered) continue;
    const float risk = DamagingRiskAt(CellOf(static_cast<std::int32_t>(i)), device.kind);
    device.health = Clamped(device.health + exposure * risk);
  }
}

void Farm::Consume(const EnergySpec& energy) {
  for (Ship& ship : ships_) {
    if (ship.outcome == Outcome::kOutOfPlay) continue;
    const bool is_ship = ship.own_device == kNone;
    // ship.aboard is the number of devices after the action. During a move the number does not
    // change, because pickups and drop-offs are separate actions.
    ship.energy = EnergyOf(is_ship ? energy.ships : energy.self_propelled, ship.distance,
                           ship.aboard, RiskAt(ship.cell));
    if (energy.weight > 0.0) ship.terms.energy = static_cast<float>(-energy.weight * ship.energy);
    ship.episode_energy += ship.energy;
    record_.energy += ship.energy;
  }
}

void Farm::Reward() {
  const bool team = scenario_->rewards.sharing == RewardSharing::kTeam;
  float sum = 0.0F;
  for (Ship& ship : ships_) {
    if (ship.outcome == Outcome::kOutOfPlay) {
      ship.reward = 0.0F;
      continue;
    }
    RewardTerms& terms = ship.terms;
    terms.disaster = RiskAt(ship.cell);
    if (terms.disaster == 0.0F && !TriggersReward(ship)) terms.step = scenario_->rewards.step;
    ship.reward = terms.Total();
    record_.steps_in_disaster += terms.disaster < 0.0F ? 1 : 0;
    sum += ship.reward;
  }
  for (Ship& ship : ships_) {
    if (team) ship.reward = sum;
    ship.episode_return += ship.reward;
  }
  record_.episode_return += sum;
}

void Farm::Finish() {
  if (remaining_ == 0) {
    record_.reason = EndReason::kAllRetrieved;
  } else if (!disasters_.empty() &&
             std::none_of(disasters_.begin(), disasters_.end(),
                          [](const Disaster& disaster) { return disaster.active(); })) {
    record_.reason = EndReason::kDisasterEnded;
  } else if (record_.steps >= scenario_->step_limit) {
    record_.reason = EndReason::kStepLimit;
  }
}

// Counts the rescue ships that are not moored in this step. A ship is moored if it is in a port at
// the end of a step in which it did not move.
void Farm::CountShipSteps() {
  for (const Ship& ship : ships_) {
    const bool moved = ship.outcome == Outcome::kOk && ship.action < Action::kPickup;
    const bool is_moored = !moved && (layout_->bits(ship.cell) & kPortBit) != 0;
    if (ship.own_device == kNone && !is_moored) ++record_.ship_steps;
  }
}

std::optional<Accounts> Farm::SettleAccounts() const {
  if (!over() || !scenario_->money) return std::nullopt;
  const MoneySpec& money = *scenario_->money;
  Accounts accounts;
  for (std::size_t id = 0; id < devices_.size(); ++id) {
    const Device& device = devices_[id];
    accounts.by_kind[static_cast<std::size_t>(device.kind)] +=
        Settle(money, layout_->devices[id].insured, device.health, scenario_->devices.health,
               device.status == DeviceStatus::kDelivered);
  }
  const double hours = record_.ship_steps * scenario_->step_duration_s / 3600.0;
  accounts.ship_cost = ToCents(hours * money.ship_hour);
  accounts.energy_cost = ToCents(record_.energy * money.kwh);
  return accounts;
}

float Farm::RiskAt(Cell cell) const {
  return std::min(aquafarm::RiskAt(disasters_, cell), scenario_->SeaRiskAt(cell));
}

float Farm::DamagingRiskAt(Cell cell, DeviceKind kind) const {
  return std::min(aquafarm::DamagingRiskAt(disasters_, cell, scenario_->damage.FactorsOf(kind)),
                  scenario_->SeaRiskAt(cell));
}

ActionMask Farm::LegalActions(std::int32_t id) const {
  const Ship& ship = ships_[static_cast<std::size_t>(id)];
  if (!ship.active) return kMoveMask;
  ActionMask mask = kMoveMask;
  const std::uint8_t bits = layout_->bits(ship.cell);
  if ((bits & (kPortBit | kDeviceSiteBit)) == 0) return mask;
  const bool laden = ship.aboard > 0 || ship.own_device != kNone;
  if ((bits & kPortBit) != 0 && laden) mask |= MaskOf(Action::kDropOff);
  if (DeviceToPickUp(ship) != kNone) mask |= MaskOf(Action::kPickup);
  return mask;
}

}  // namespace aquafarm
