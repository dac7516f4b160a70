// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Second implementation of the farm's rules, written for clarity instead of speed: it searches
// lists, sorts rings to find risks, and stores nothing that can be derived. It does not move
// disasters: it reads those of the farm under test. Other tests check their motion.

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "aquafarm/farm/farm.h"

namespace aquafarm::test {

class OracleFarm {
 public:
  struct OracleShip {
    std::pair<int, int> at;
    std::optional<std::size_t> is_device;
    std::vector<std::size_t> hold;
    bool gone{};
    Outcome outcome{};
    RewardTerms terms;
    float reward{};
    double km{};
    double kwh{};
  };
  struct OracleDevice {
    std::pair<int, int> site;
    float health{};
    bool delivered{};
  };

  explicit OracleFarm(const Farm& farm) : scenario_(farm.scenario()), layout_(farm.layout()) {
    for (const PlacedDevice& placed : layout_.devices) {
      devices.push_back({{placed.cell.x, placed.cell.y}, scenario_.devices.health, false});
    }
    for (const Ship& ship : farm.ships()) {
      OracleShip mine;
      mine.at = {ship.cell.x, ship.cell.y};
      if (ship.own_device >= 0) mine.is_device = static_cast<std::size_t>(ship.own_device);
      ships.push_back(mine);
    }
  }

  /// Executes one step.
  /// @param actions one per ship @param after the farm under test after the same step
  void Step(const std::vector<Action>& actions, const Farm& after) {
    ++steps;
    std::vector<std::pair<int, int>> moved_from;
    for (OracleShip& ship : ships) {
      moved_from.push_back(ship.at);
      ship.km = ship.kwh = 0.0;
    }
    for (std::size_t i = 0; i < ships.size(); ++i) ActOne(i, actions[i], after);
    for (std::size_t d = 0; d < devices.size(); ++d) {
      if (devices[d].delivered) continue;
      const float risk = Risk(after, PlaceOf(d), layout_.devices[d].kind);
      devices[d].health =
          std::max(0.0F, devices[d].health + scenario_.damage.exposure_damage * risk);
    }
    float sum = 0.0F;
    for (std::size_t i = 0; i < ships.size(); ++i) {
      OracleShip& ship = ships[i];
      ship.reward = 0.0F;
      if (ship.outcome == Outcome::kOutOfPlay) continue;
      ship.terms.disaster = Risk(after, ship.at);
      const bool handled = ship.outcome == Outcome::kOk &&
                           (actions[i] == Action::kPickup || actions[i] == Action::kDropOff);
      const std::set<Outcome> quiet{Outcome::kOk, Outcome::kEdge, Outcome::kHeld};
      if (quiet.count(ship.outcome) == 1 && !handled && ship.terms.disaster == 0.0F) {
        ship.terms.step = scenario_.rewards.step;
      }
      Consume(ship, moved_from[i]);
      const RewardTerms& t = ship.terms;
      ship.reward = t.crash + t.disaster + t.pickup + t.drop_off + t.illegal + t.collision +
                    t.step + t.energy;
      sum += ship.reward;
    }
    if (scenario_.rewards.sharing == RewardSharing::kTeam) {
      for (OracleShip& ship : ships) ship.reward = sum;
    }
    const bool all = std::all_of(devices.begin(), devices.end(),
                                 [](const OracleDevice& device) { return device.delivered; });
    int longest = 0;
    for (const DisasterSpec& spec : scenario_.disasters) longest = std::max(longest, spec.duration);
    if (all) {
      reason = EndReason::kAllRetrieved;
    } else if (longest > 0 && steps >= longest) {
      reason = EndReason::kDisasterEnded;
    } else if (steps >= scenario_.step_limit) {
      reason = EndReason::kStepLimit;
    }
  }

  std::pair<int, int> PlaceOf(std::size_t device) const {
    for (const OracleShip& ship : ships) {
      if (ship.is_device == device) return ship.at;
      if (std::count(ship.hold.begin(), ship.hold.end(), device) > 0) return ship.at;
    }
    return devices[device].site;
  }

  std::vector<OracleShip> ships;
  std::vector<OracleDevice> devices;
  int steps{};
  EndReason reason{};

 private:
  void Consume(OracleShip& ship, std::pair<int, int> from) const {
    ship.km = std::hypot(ship.at.first - from.first, ship.at.second - from.second) *
              scenario_.cell_size_m / 1000.0;
    if (!scenario_.energy) return;
    const bool is_device = ship.is_device.has_value();
    const EnergyFigures& f = is_device ? scenario_.energy->self_propelled : scenario_.energy->ships;
    const double load =
        is_device ? 1.0 : 1.0 + f.per_device * static_cast<double>(ship.hold.size());
    const double sea = 1.0 + f.rough_sea * static_cast<double>(ship.terms.disaster) / -20.0;
    ship.kwh = f.idle_per_step + f.per_km * ship.km * load * sea;
    ship.terms.energy = static_cast<float>(-scenario_.energy->weight * ship.kwh);
  }

  // Returns the worst risk at a cell; with a kind of device, times its damage factors.
  static float Risk(const Farm& farm, std::pair<int, int> at,
                    std::optional<DeviceKind> kind = std::nullopt) {
    float worst = 0.0F;
    for (const Disaster& disaster : farm.disasters()) {
      if (disaster.steps_left <= 0) continue;
      std::map<float, float> rings;  // radius → risk, ascending
      for (int k = 0; k < disaster.rings; ++k) {
        const auto i = static_cast<std::size_t>(k);
        rings.emplace(disaster.radius[i], disaster.risk[i]);
      }
      const float dx = disaster.x - static_cast<float>(at.first);
      const float dy = disaster.y - static_cast<float>(at.second);
      for (const auto& [radius, risk] : rings) {
        if (dx * dx + dy * dy > radius * radius) continue;
        const auto& kinds = farm.scenario().damage.kinds;
        const float factor = kind ? kinds.at(static_cast<std::size_t>(*kind))
                                        .at(static_cast<std::size_t>(disaster.kind))
                                  : 1.0F;
        worst = std::min(worst, risk * factor);
        break;
      }
    }
    return worst;
  }

  std::uint8_t Bits(std::pair<int, int> at) const { return layout_.bits({at.first, at.second}); }

  void ActOne(std::size_t i, Action action, const Farm& after) {
    OracleShip& ship = ships[i];
    ship.terms = RewardTerms{};
    if (ship.gone) {
      ship.outcome = Outcome::kOutOfPlay;
    } else if (action == Action::kHold) {
      ship.outcome = Outcome::kHeld;
    } else if (action == Action::kPickup) {
      PickUpOne(i);
    } else if (action == Action::kDropOff) {
      DropOffOne(ship);
    } else {
      MoveOne(i, action, after);
    }
  }

  void MoveOne(std::size_t i, Action action, const Farm& after) {
    static const std::map<Action, std::pair<int, int>> kBy{
        {Action::kNorth, {0, 1}},       {Action::kSouth, {0, -1}},     {Action::kWest, {-1, 0}},
        {Action::kEast, {1, 0}},        {Action::kNorthWest, {-1, 1}}, {Action::kNorthEast, {1, 1}},
        {Action::kSouthWest, {-1, -1}}, {Action::kSouthEast, {1, -1}}};
    OracleShip& ship = ships[i];
    const std::pair<int, int> to{ship.at.first + kBy.at(action).first,
                                 ship.at.second + kBy.at(action).second};
    if (to.first < 0 || to.second < 0 || to.first >= scenario_.width ||
        to.second >= scenario_.height) {
      ship.outcome = Outcome::kEdge;
      return;
    }
    if ((Bits(to) & (kIslandBit | kRockBit)) != 0) {
      ship.outcome = Outcome::kCrash;
      ship.terms.crash = layout_.crash_reward(to.second, to.first);
      const bool island = (Bits(to) & kIslandBit) != 0;
      const float loss = island ? scenario_.damage.island_damage : -ship.terms.crash / 100.0F;
      std::vector<std::size_t> hurt = ship.hold;
      if (ship.is_device) hurt.push_back(*ship.is_device);
      const auto draws =
          Draw({after.seed(), after.episode(), RngStream::kDamage, static_cast<std::uint32_t>(i)},
               static_cast<std::uint32_t>(steps));
      if (ToUnit(draws[0]) >= scenario_.damage.crash_probability) return;
      for (std::size_t d : hurt) devices[d].health = std::max(0.0F, devices[d].health - loss);
      return;
    }
    for (std::size_t other = 0; other < ships.size(); ++other) {
      if (other == i || ships[other].gone || ships[other].at != to) continue;
      if ((Bits(to) & kPortBit) != 0) continue;
      ship.outcome = Outcome::kCollision;
      ship.terms.collision = scenario_.rewards.collision;
      return;
    }
    ship.outcome = Outcome::kOk;
    ship.at = to;
  }

  void PickUpOne(std::size_t i) {
    OracleShip& ship = ships[i];
    ship.outcome = Outcome::kIllegalPickup;
    ship.terms.illegal = scenario_.rewards.illegal;
    if (ship.is_device || static_cast<int>(ship.hold.size()) >= scenario_.ships.capacity) return;
    for (std::size_t d = 0; d < devices.size(); ++d) {
      bool free = !devices[d].delivered && devices[d].site == ship.at;
      for (const OracleShip& other : ships) {
        free = free && other.is_device != d &&
               std::count(other.hold.begin(), other.hold.end(), d) == 0;
      }
      if (!free) continue;
      ship.hold.push_back(d);
      ship.outcome = Outcome::kOk;
      ship.terms.illegal = 0.0F;
      ship.terms.pickup = scenario_.rewards.pickup;
      return;
    }
  }

  void DropOffOne(OracleShip& ship) {
    std::vector<std::size_t> all = ship.hold;
    if (ship.is_device) all.push_back(*ship.is_device);
    std::sort(all.begin(), all.end());
    if ((Bits(ship.at) & kPortBit) == 0 || all.empty()) {
      ship.outcome = Outcome::kIllegalDropOff;
      ship.terms.illegal = scenario_.rewards.illegal;
      return;
    }
    float worth = 0.0F;
    for (std::size_t d : all) {
      devices[d].delivered = true;
      devices[d].site = ship.at;
      worth += devices[d].health * layout_.devices[d].value;
    }
    ship.hold.clear();
    ship.gone = ship.is_device.has_value();
    ship.outcome = Outcome::kOk;
    ship.terms.drop_off = scenario_.rewards.drop_off + worth;
  }

  const Scenario& scenario_;
  Layout layout_;
};

}  // namespace aquafarm::test
