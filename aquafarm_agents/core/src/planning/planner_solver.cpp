// SPDX-License-Identifier: BSD-3-Clause
#include "planning/planner_solver.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <string>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/disaster.h"
#include "planning/water_distance.h"

namespace aquafarm::agents {

PlannerSolver::PlannerSolver(const Scenario& scenario, std::int32_t slots)
    : scenario_(scenario),
      cells_(static_cast<std::size_t>(scenario.CellCount())),
      devices_(static_cast<std::size_t>(slots > 0 ? slots : scenario.devices.Total())) {
  constexpr std::size_t kMostDevices = 12;
  for (const auto& [name, value] :
       {std::pair{"step", scenario.rewards.step}, std::pair{"illegal", scenario.rewards.illegal}}) {
    if (value <= 0.0F) continue;
    throw InputError("planner: rewards." + std::string(name) +
                     ": got more than 0, expected at most 0, since a ship earns without end by "
                     "waiting; evaluate a learner instead");
  }
  if (devices_ > kMostDevices) {
    throw InputError("planner: got " + std::to_string(devices_) + " devices, expected at most " +
                     std::to_string(kMostDevices));
  }
  const std::size_t codes = std::size_t{1} << (2 * devices_);
  set_of_bits_.assign(codes, kNone);
  for (std::size_t bits = 0; bits < codes; ++bits) {
    std::int32_t aboard = 0;
    for (std::size_t d = 0; d < devices_; ++d) {
      const std::size_t fate = (bits >> (2 * d)) & 3U;
      aboard += fate == kPaid || fate == kUnpaid ? 1 : 0;
    }
    if (aboard > scenario.ships.capacity) continue;
    set_of_bits_[bits] = static_cast<std::int32_t>(sets_.size());
    sets_.push_back(static_cast<std::uint32_t>(bits));
  }
  all_gone_ = static_cast<std::size_t>(set_of_bits_[codes - 1]);
  if (state_count() > kMaxPlanStates) {
    throw InputError("planner: got " + std::to_string(state_count()) +
                     " states, expected at most " + std::to_string(kMaxPlanStates) +
                     "; fewer devices or cells are needed");
  }
  site_.resize(devices_);
  value_.resize(devices_);
  health_.resize(devices_);
  risk_.resize(scenario.height, scenario.width);
  open_.resize(state_count());
}

void PlannerSolver::ListOptions(const Farm& farm) {
  layout_ = &farm.layout();
  options_.resize(cells_);
  for (std::int32_t y = 0; y < scenario_.height; ++y) {
    for (std::int32_t x = 0; x < scenario_.width; ++x) {
      const std::int32_t here = LinearIndex({x, y}, scenario_.width);
      std::vector<Option>& options = options_[static_cast<std::size_t>(here)];
      options.clear();
      if ((layout_->bits({x, y}) & kBlockedBits) != 0) continue;
      std::optional<Option> edge;  // stays in the cell by a move off the map
      for (std::uint8_t action = 0; action < kMoveCount; ++action) {
        const Cell to{x + kMoves[action].x, y + kMoves[action].y};
        const bool on_map =
            to.x >= 0 && to.y >= 0 && to.x < scenario_.width && to.y < scenario_.height;
        if (!on_map) {
          edge = {here, 0.0F, 0.0F, action, false};
        } else if ((layout_->bits(to) & kBlockedBits) != 0) {
          const float reward = layout_->crash_reward(to.y, to.x);
          options.push_back(
              {here, reward, CrashDamage(scenario_, layout_->bits(to), reward), action, true});
        } else {
          options.push_back({LinearIndex(to, scenario_.width), 0.0F, 0.0F, action, false});
        }
      }
      if (edge) options.push_back(*edge);
      // Staying in the cell by an illegal action, which replaces the step reward. The action chosen
      // must not pick up or drop off a device here.
      const bool at_port = (layout_->bits({x, y}) & kPortBit) != 0;
      options.push_back({here, scenario_.rewards.illegal, 0.0F,
                         static_cast<std::uint8_t>(at_port ? Action::kPickup : Action::kDropOff),
                         true});
    }
  }
}

// Updates `best` [cells] with the returns after a pickup or a drop-off in the cell.
void PlannerSolver::AddGains(std::size_t set, std::vector<double>& best) const {
  const auto bound = [&](std::size_t next, std::size_t cell) {
    return next == all_gone_ ? 0.0 : bound_[next * cells_ + cell];
  };
  for (std::size_t d = 0; d < devices_; ++d) {
    if (FateOf(set, d) != kWaiting) continue;
    const auto cell = static_cast<std::size_t>(site_[d]);
    for (const Fate fate : {kPaid, kUnpaid}) {
      const std::size_t next = With(set, d, fate);
      if (next == sets_.size()) continue;
      const double worth =
          fate == kPaid ? static_cast<double>(value_[d]) * static_cast<double>(health_[d]) : 0;
      best[cell] = std::max(
          best[cell], static_cast<double>(scenario_.rewards.pickup) + worth + bound(next, cell));
    }
  }
  const std::size_t unloaded = Delivered(set);
  if (unloaded == set) return;
  for (const Cell port : layout_->ports) {
    const auto cell = static_cast<std::size_t>(LinearIndex(port, scenario_.width));
    best[cell] = std::max(best[cell],
                          static_cast<double>(scenario_.rewards.drop_off) + bound(unloaded, cell));
  }
}

// Unused slots of a task count as gone from the start.
bool PlannerSolver::IsOfTask(std::size_t set) const {
  for (std::size_t d = task_->devices.size(); d < devices_; ++d) {
    if (FateOf(set, d) != kGone) return false;
  }
  return true;
}

// Computes the max further return of every state. A device's status only advances, so each set of
// devices is solved once, the last sets first. A move costs the step reward in quiet water, or the
// mildest risk if that costs less.
void PlannerSolver::SolveBound() {
  bound_.assign(state_count(), 0.0);
  const double move = std::max(static_cast<double>(scenario_.rewards.step), kMildestRisk);
  std::vector<std::size_t> order(sets_.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [this](std::size_t a, std::size_t b) { return sets_[a] > sets_[b]; });
  std::vector<double> best(cells_);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry> queue;
  for (const std::size_t set : order) {
    if (set == all_gone_ || !IsOfTask(set)) continue;
    std::fill(best.begin(), best.end(), 0.0);  // stopping costs nothing
    AddGains(set, best);
    for (std::size_t cell = 0; cell < cells_; ++cell) {
      if (best[cell] > 0.0) queue.push({best[cell], cell});
    }
    while (!queue.empty()) {
      const auto [value, cell] = queue.top();
      queue.pop();
      if (value < best[cell]) continue;
      const Cell at{static_cast<std::int32_t>(cell) % scenario_.width,
                    static_cast<std::int32_t>(cell) / scenario_.width};
      for (const Cell by : kMoves) {
        const Cell from{at.x + by.x, at.y + by.y};
        const bool on_map =
            from.x >= 0 && from.y >= 0 && from.x < scenario_.width && from.y < scenario_.height;
        if (!on_map || (layout_->bits(from) & kBlockedBits) != 0) continue;
        const auto k = static_cast<std::size_t>(LinearIndex(from, scenario_.width));
        if (value + move <= best[k]) continue;
        best[k] = value + move;
        queue.push({best[k], k});
      }
    }
    std::copy(best.begin(), best.end(), bound_.begin() + static_cast<std::ptrdiff_t>(set * cells_));
  }
}

void PlannerSolver::FollowDisasters(const Farm& farm, Foresight foresight) {
  disasters_ = farm.disasters();
  tracks_ = Foresee(farm, foresight, disasters_);
}

void PlannerSolver::AdvanceDisasters(const Farm& farm, std::int32_t step) {
  for (std::size_t id = 0; id < disasters_.size(); ++id) {
    const StreamKey key{farm.seed(), farm.episode(), RngStream::kDisasterTurn,
                        static_cast<std::uint32_t>(id)};
    MoveDisaster(disasters_[id], tracks_[id], key, step, scenario_.width, scenario_.height);
  }
  FillRisk(scenario_, disasters_, risk_);
  const float probability = scenario_.damage.crash_probability;
  const auto draws = Draw(
      {farm.seed(), farm.episode(), RngStream::kDamage, static_cast<std::uint32_t>(task_->ship)},
      static_cast<std::uint32_t>(step));
  crash_hurts_ = probability >= 1.0F || ToUnit(draws[0]) < probability;
}

// Damages the devices that still wait at their deployed positions, after this step.
void PlannerSolver::WearDown() {
  const float exposure = scenario_.damage.exposure_damage;
  for (std::size_t d = 0; d < task_->devices.size() && exposure > 0.0F; ++d) {
    health_[d] = std::max(0.0F, health_[d] + exposure * risk_.data()[site_[d]]);
  }
}

}  // namespace aquafarm::agents
