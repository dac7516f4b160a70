// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/planning/fetch_by_value.h"

#include <algorithm>

#include "aquafarm/base/check.h"
#include "planning/water_distance.h"

namespace aquafarm::agents {
namespace {

constexpr auto kHoldCode = static_cast<std::uint8_t>(Action::kHold);
// Consecutive steps that a ship waits for a ship with a higher id before it makes way itself.
constexpr std::int32_t kPatience = 3;

std::size_t IndexOf(const Farm& farm, Cell cell) {
  return static_cast<std::size_t>(LinearIndex(cell, farm.scenario().width));
}

// Returns the number of steps until the episode ends if not all devices are delivered before.
std::int32_t StepsLeft(const Farm& farm) {
  std::int32_t left = farm.scenario().step_limit - farm.step();
  if (farm.disasters().empty()) return left;
  std::int32_t longest = 0;
  for (const Disaster& disaster : farm.disasters()) {
    longest = std::max(longest, disaster.steps_left);
  }
  return std::min(left, longest);
}

// Returns the value by which devices are chosen: the insured value if the scenario has money, else
// the value that the reward credits.
double ValueOf(const Farm& farm, std::size_t device) {
  if (farm.scenario().money) return static_cast<double>(farm.layout().devices[device].insured);
  return static_cast<double>(farm.devices()[device].value);
}

bool IsOnMap(const Farm& farm, Cell cell) {
  return cell.x >= 0 && cell.y >= 0 && cell.x < farm.scenario().width &&
         cell.y < farm.scenario().height;
}

}  // namespace

void FetchByValue::Begin(const Farm& farm) {
  seed_ = farm.seed();
  episode_ = farm.episode();
  errands_.assign(farm.ships().size(), {});
  to_port_ = WaterDistance(farm.layout(), farm.layout().ports);
}

void FetchByValue::Act(const Farm& farm, std::uint8_t* actions) {
  const bool continues =
      next_step_ == farm.step() && seed_ == farm.seed() && episode_ == farm.episode();
  if (!continues) Begin(farm);
  next_step_ = farm.step() + 1;
  cells_.clear();
  for (const Ship& ship : farm.ships()) cells_.push_back(ship.cell);
  for (std::size_t i = 0; i < errands_.size(); ++i) {
    const auto id = static_cast<std::int32_t>(i);
    actions[i] = ActOf(farm, id);
    if (actions[i] >= kMoveCount) continue;
    const Cell by = kMoves[actions[i]];
    cells_[i] = {cells_[i].x + by.x, cells_[i].y + by.y};
  }
}

bool FetchByValue::CanBringHome(const Farm& farm, std::int32_t device, std::int32_t moves) const {
  const Cell cell = farm.devices()[static_cast<std::size_t>(device)].cell;
  // Pickup and drop-off take one step each.
  return moves + to_port_[IndexOf(farm, cell)] + 2 <= StepsLeft(farm);
}

void FetchByValue::Choose(const Farm& farm, std::int32_t id) {
  Errand& errand = errands_[static_cast<std::size_t>(id)];
  const Ship& ship = farm.ships()[static_cast<std::size_t>(id)];
  const std::vector<std::int32_t> moves = WaterDistance(farm.layout(), {ship.cell});
  std::int32_t chosen = kNone;
  std::int32_t nearest = 0;
  double best = 0.0;
  for (std::size_t i = 0; i < farm.devices().size(); ++i) {
    const Device& device = farm.devices()[i];
    const auto candidate = static_cast<std::int32_t>(i);
    if (device.status != DeviceStatus::kDeployed || device.self_propelled) continue;
    const bool is_taken =
        std::any_of(errands_.begin(), errands_.end(),
                    [candidate](const Errand& other) { return other.device == candidate; });
    const std::int32_t away = moves[IndexOf(farm, device.cell)];
    if (is_taken || !CanBringHome(farm, candidate, away)) continue;
    const double value = ValueOf(farm, i);
    const bool is_better = chosen == kNone || value > best || (value == best && away < nearest);
    if (!is_better) continue;
    best = value;
    nearest = away;
    chosen = candidate;
  }
  errand.device = chosen;
  if (chosen == kNone) return;
  const Cell goal = farm.devices()[static_cast<std::size_t>(chosen)].cell;
  errand.moves = WaterDistance(farm.layout(), {goal});
}

std::uint8_t FetchByValue::ActOf(const Farm& farm, std::int32_t id) {
  const Ship& ship = farm.ships()[static_cast<std::size_t>(id)];
  Errand& errand = errands_[static_cast<std::size_t>(id)];
  if (!ship.active) return kHoldCode;
  const ActionMask legal = farm.LegalActions(id);
  if ((legal & MaskOf(Action::kDropOff)) != 0) return static_cast<std::uint8_t>(Action::kDropOff);
  const bool fetches = ship.own_device == kNone && ship.aboard < farm.scenario().ships.capacity;
  if (errand.device != kNone) {
    const Device& device = farm.devices()[static_cast<std::size_t>(errand.device)];
    const bool keeps = fetches && device.status == DeviceStatus::kDeployed &&
                       CanBringHome(farm, errand.device, errand.moves[IndexOf(farm, ship.cell)]);
    if (!keeps) errand.device = kNone;
  }
  if (fetches && errand.device == kNone) Choose(farm, id);
  if (errand.device == kNone) return Sail(farm, id, to_port_);
  if (errand.moves[IndexOf(farm, ship.cell)] == 0) {
    return static_cast<std::uint8_t>(Action::kPickup);
  }
  return Sail(farm, id, errand.moves);
}

std::int32_t FetchByValue::Blocker(const Farm& farm, std::int32_t id, Cell cell) const {
  if ((farm.layout().bits(cell) & kPortBit) != 0) return kNone;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const auto other = static_cast<std::int32_t>(i);
    if (other != id && farm.ships()[i].active && cells_[i] == cell) return other;
  }
  return kNone;
}

// Returns a move along the route, a detour or kHold. If another ship blocks the way, the ship with
// the higher id makes way and the ship with the lower id waits, for at most kPatience steps.
std::uint8_t FetchByValue::Sail(const Farm& farm, std::int32_t id,
                                const std::vector<std::int32_t>& moves) {
  const Cell from = cells_[static_cast<std::size_t>(id)];
  const std::int32_t left = moves[IndexOf(farm, from)];
  Errand& errand = errands_[static_cast<std::size_t>(id)];
  if (left == 0 || left == kUnreachable) return kHoldCode;
  std::uint8_t detour = kHoldCode;
  std::int32_t shortest = kUnreachable;
  bool makes_way = errand.waited >= kPatience;
  for (std::uint8_t action = 0; action < kMoveCount; ++action) {
    const Cell to{from.x + kMoves[action].x, from.y + kMoves[action].y};
    if (!IsOnMap(farm, to)) continue;
    const std::int32_t next = moves[IndexOf(farm, to)];
    const std::int32_t blocker = Blocker(farm, id, to);
    if (blocker != kNone) {
      makes_way = makes_way || (next < left && blocker < id);
    } else if (next < shortest) {
      shortest = next;
      detour = action;
    }
  }
  const bool moves_on = shortest < left || makes_way;
  errand.waited = moves_on ? 0 : errand.waited + 1;
  return moves_on ? detour : kHoldCode;
}

FetchByValuePolicy::FetchByValuePolicy(const EnvironmentSpec& spec)
    : agents_(static_cast<std::size_t>(spec.agents)) {}

void FetchByValuePolicy::Begin(std::uint64_t, std::int32_t farms) {
  fetchers_.assign(static_cast<std::size_t>(farms), {});
}

void FetchByValuePolicy::Act(const StepResults& results, std::vector<std::uint8_t>& actions) {
  AQUAFARM_CHECK_EQ(results.states.size(), fetchers_.size());
  actions.assign(fetchers_.size() * agents_, 0);
  for (std::size_t i = 0; i < fetchers_.size(); ++i) {
    const Farm& farm = *results.states[i];
    if (!farm.over()) fetchers_[i].Act(farm, actions.data() + i * agents_);
  }
}

}  // namespace aquafarm::agents
