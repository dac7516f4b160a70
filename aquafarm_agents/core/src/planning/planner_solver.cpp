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
#include "aquafarm/farm/energy.h"
#include "planning/water_distance.h"

namespace aquafarm::agents {

PlannerSolver::PlannerSolver(const Scenario& scenario, std::int32_t max_devices)
    : scenario_(scenario),
      cells_(static_cast<std::size_t>(scenario.CellCount())),
      devices_(static_cast<std::size_t>(max_devices > 0 ? max_devices : scenario.devices.Total())) {
  for (const auto& [name, value] :
       {std::pair{"step", scenario.rewards.step}, std::pair{"illegal", scenario.rewards.illegal}}) {
    if (value <= 0.0F) continue;
    throw InputError("planner: rewards." + std::string(name) +
                     ": got more than 0, expected at most 0, because a ship could earn it "
                     "again and again; evaluate a learner instead");
  }
  if (devices_ > std::size_t{kMaxPlanDevices}) {
    throw InputError(
        "planner: got " + std::to_string(devices_) + " devices for one ship, expected at most " +
        std::to_string(kMaxPlanDevices) +
        "; give another policy, such as policy:=fetch_by_value, or policy:=none to hold "
        "the ships");
  }
  const std::size_t codes = std::size_t{1} << (2 * devices_);
  set_of_bits_.assign(codes, kNone);
  for (std::size_t bits = 0; bits < codes; ++bits) {
    std::int32_t aboard = 0;
    for (std::size_t d = 0; d < devices_; ++d) {
      const std::size_t pickup = (bits >> (2 * d)) & 3U;
      aboard += pickup == kPaid || pickup == kUnpaid ? 1 : 0;
    }
    if (aboard > scenario.ships.capacity) continue;
    set_of_bits_[bits] = static_cast<std::int32_t>(sets_.size());
    sets_.push_back(static_cast<std::uint32_t>(bits));
  }
  all_gone_ = static_cast<std::size_t>(set_of_bits_[codes - 1]);
  if (state_count() > kMaxPlanStates) {
    throw InputError("planner: got " + std::to_string(state_count()) +
                     " states, expected at most " + std::to_string(kMaxPlanStates) +
                     "; give fewer devices or cells, or policy:=fetch_by_value");
  }
  site_.resize(devices_);
  value_.resize(devices_);
  kind_.resize(devices_);
  damaging_.resize(devices_);
  health_.resize(devices_);
  open_.resize(state_count());
}

void PlannerSolver::ListOptions(const Farm& farm) {
  const Layout& layout = farm.layout();
  options_.resize(cells_);
  best_crash_ = scenario_.rewards.island_crash;
  for (std::int32_t y = 0; y < scenario_.height; ++y) {
    for (std::int32_t x = 0; x < scenario_.width; ++x) {
      const std::int32_t here = LinearIndex({x, y}, scenario_.width);
      std::vector<Option>& options = options_[static_cast<std::size_t>(here)];
      options.clear();
      if ((layout.bits({x, y}) & kBlockedBits) != 0) continue;
      std::optional<Option> edge;  // a move off the map, after which the ship stays in the cell
      for (std::uint8_t action = 0; action < kMoveCount; ++action) {
        const Cell to{x + kMoves[action].x, y + kMoves[action].y};
        const bool on_map =
            to.x >= 0 && to.y >= 0 && to.x < scenario_.width && to.y < scenario_.height;
        if (!on_map) {
          edge = {here, 0.0F, 0.0F, 0.0, action, false};
        } else if ((layout.bits(to) & kBlockedBits) != 0) {
          const float reward = layout.crash_reward(to.y, to.x);
          best_crash_ = std::max(best_crash_, reward);
          options.push_back(
              {here, reward, CrashDamage(scenario_, layout.bits(to), reward), 0.0, action, true});
        } else {
          const double km =
              MoveLength(static_cast<Action>(action)) * scenario_.cell_size_m / 1000.0;
          options.push_back({LinearIndex(to, scenario_.width), 0.0F, 0.0F, km, action, false});
        }
      }
      if (edge) options.push_back(*edge);
      // The ship can also stay in the cell by an illegal action, whose reward replaces the step
      // reward. The action must not pick up or drop off a device here.
      const bool at_port = (layout.bits({x, y}) & kPortBit) != 0;
      options.push_back({here, scenario_.rewards.illegal, 0.0F, 0.0,
                         static_cast<std::uint8_t>(at_port ? Action::kPickup : Action::kDropOff),
                         true});
    }
  }
}

// Returns whether the options, moves and rewards of the previous plan are valid for the new one.
bool PlannerSolver::IsPrepared(const Farm& farm) const {
  const Layout& layout = farm.layout();
  const auto is_same = [](const auto& a, const auto& b) {
    return a.size() == b.size() && (a == b).all();
  };
  const Ship& ship = farm.ships()[static_cast<std::size_t>(task_->ship)];
  if (planned_devices_ != task_->devices.size() ||
      planned_self_propelled_ != (ship.own_device != kNone) ||
      move_reward_ != static_cast<double>(risks_->best_quiet()) ||
      !is_same(chart_.cells, layout.cells) || !is_same(chart_.crash_reward, layout.crash_reward)) {
    return false;
  }
  for (std::size_t d = 0; d < planned_devices_; ++d) {
    const Device& device = farm.devices()[static_cast<std::size_t>(task_->devices[d])];
    if (site_[d] != LinearIndex(device.cell, scenario_.width)) return false;
  }
  return true;
}

// Returns whether a set can occur in the task. If the task has fewer than devices_ devices, the
// unused positions of a set hold kGone.
bool PlannerSolver::IsOfTask(std::size_t set) const {
  for (std::size_t d = task_->devices.size(); d < devices_; ++d) {
    if (PickupPlanOf(set, d) != kGone) return false;
  }
  return true;
}

// Sets the costs of energy of the task's ship. A self-propelled device carries no load.
void PlannerSolver::PriceEnergy(const Farm& farm) {
  load_.assign(sets_.size(), 1.0);
  idle_cost_ = km_cost_ = rough_sea_ = 0.0;
  if (!scenario_.energy || scenario_.energy->weight == 0.0) return;
  const EnergySpec& energy = *scenario_.energy;
  const Ship& ship = farm.ships()[static_cast<std::size_t>(task_->ship)];
  const bool is_ship = ship.own_device == kNone;
  const EnergyFigures& figures = is_ship ? energy.ships : energy.self_propelled;
  idle_cost_ = energy.weight * figures.idle_per_step;
  km_cost_ = energy.weight * figures.per_km;
  rough_sea_ = figures.rough_sea / static_cast<double>(kWorstRisk);
  for (std::size_t set = 0; set < sets_.size() && is_ship; ++set) {
    for (std::size_t d = 0; d < devices_; ++d) {
      const PickupPlan pickup = PickupPlanOf(set, d);
      if (pickup == kPaid || pickup == kUnpaid) load_[set] += figures.per_device;
    }
  }
}

// Fills sources_ with the cells where a pickup or a drop-off changes the set. Each cell has the min
// number of moves from there until the task is complete. The cells are sorted by this number.
void PlannerSolver::SeedMoves(std::size_t set) {
  const auto add = [this](std::size_t next, std::size_t cell) {
    const std::int32_t further = next == all_gone_ ? 0 : moves_[next * cells_ + cell];
    if (further != kUnreachable) sources_.emplace_back(further, cell);
  };
  sources_.clear();
  for (std::size_t d = 0; d < devices_; ++d) {
    if (PickupPlanOf(set, d) != kWaiting) continue;
    const std::size_t next = With(set, d, kPaid);
    if (next != sets_.size()) add(next, static_cast<std::size_t>(site_[d]));
  }
  const std::size_t unloaded = Delivered(set);
  for (std::size_t i = 0; i < chart_.ports.size() && unloaded != set; ++i) {
    add(unloaded, static_cast<std::size_t>(LinearIndex(chart_.ports[i], scenario_.width)));
  }
  std::sort(sources_.begin(), sources_.end());
}

// Returns the sets of the task so that each set comes after all sets to which it can change. A
// device's PickupPlan only increases, so this is the descending order of the bits.
std::vector<std::size_t> PlannerSolver::LastSetsFirst() const {
  std::vector<std::size_t> order;
  for (std::size_t set = 0; set < sets_.size(); ++set) {
    if (IsOfTask(set) && set != all_gone_) order.push_back(set);
  }
  std::sort(order.begin(), order.end(),
            [this](std::size_t a, std::size_t b) { return sets_[a] > sets_[b]; });
  return order;
}

// Computes, for every state, the min number of moves until the task is complete. Each set has its
// own breadth-first search, which starts from all cells where the set changes.
void PlannerSolver::CountMoves() {
  moves_.assign(state_count(), kUnreachable);
  std::fill_n(moves_.begin() + static_cast<std::ptrdiff_t>(all_gone_ * cells_), cells_, 0);
  for (const std::size_t set : LastSetsFirst()) {
    std::int32_t* moves = moves_.data() + set * cells_;
    SeedMoves(set);
    queue_.clear();
    std::size_t seeded = 0;
    for (std::size_t head = 0; head < queue_.size() || seeded < sources_.size();) {
      const bool is_seed = head == queue_.size() || (seeded < sources_.size() &&
                                                     sources_[seeded].first <= moves[queue_[head]]);
      const std::size_t cell = is_seed ? sources_[seeded].second : queue_[head];
      if (is_seed) {
        const std::int32_t count = sources_[seeded++].first;
        if (moves[cell] <= count) continue;
        moves[cell] = count;
      } else {
        ++head;
      }
      for (const Option& option : options_[cell]) {
        const auto to = static_cast<std::size_t>(option.to);
        if (moves[to] <= moves[cell] + 1) continue;
        moves[to] = moves[cell] + 1;
        queue_.push_back(to);
      }
    }
  }
}

// Raises best[cell] to the max reward of plans that start with a pickup or a drop-off in the cell
// and complete the task. @param best [cells]
void PlannerSolver::SeedRewards(std::size_t set, std::vector<double>& best) const {
  const auto raise = [&](std::size_t next, std::size_t cell, float reward) {
    const double further = next == all_gone_ ? 0.0 : rewards_[next * cells_ + cell];
    best[cell] = std::max(best[cell], static_cast<double>(reward) - idle_cost_ + further);
  };
  for (std::size_t d = 0; d < devices_; ++d) {
    if (PickupPlanOf(set, d) != kWaiting) continue;
    const std::size_t next = With(set, d, kPaid);
    if (next != sets_.size()) {
      raise(next, static_cast<std::size_t>(site_[d]), scenario_.rewards.pickup);
    }
  }
  const std::size_t unloaded = Delivered(set);
  for (std::size_t i = 0; i < chart_.ports.size() && unloaded != set; ++i) {
    raise(unloaded, static_cast<std::size_t>(LinearIndex(chart_.ports[i], scenario_.width)),
          scenario_.rewards.drop_off);
  }
}

// Computes, for every state, the max reward until the task is complete, as if all water were calm
// and the devices had no value. The number of moves does not determine this reward in two cases:
// with a capacity above 1, one drop-off may unload several devices; with energy, the cost of a move
// depends on its length and load.
void PlannerSolver::SumRewards() {
  rewards_.assign(state_count(), kNever);
  std::vector<double> best(cells_);
  std::priority_queue<std::pair<double, std::size_t>> queue;
  for (const std::size_t set : LastSetsFirst()) {
    std::fill(best.begin(), best.end(), kNever);
    SeedRewards(set, best);
    for (std::size_t cell = 0; cell < cells_; ++cell) {
      if (best[cell] != kNever) queue.push({best[cell], cell});
    }
    while (!queue.empty()) {
      const auto [value, cell] = queue.top();
      queue.pop();
      if (value < best[cell]) continue;
      for (const Option& option : options_[cell]) {
        const auto to = static_cast<std::size_t>(option.to);
        const double further = value + move_reward_ - EnergyCost(set, option, 0.0F);
        if (further <= best[to]) continue;
        best[to] = further;
        queue.push({best[to], to});
      }
    }
    std::copy(best.begin(), best.end(),
              rewards_.begin() + static_cast<std::ptrdiff_t>(set * cells_));
  }
}

PlannerSolver::Gains PlannerSolver::GainsOf(std::size_t set) const {
  const auto drop_off = static_cast<double>(scenario_.rewards.drop_off);
  const auto pickup = static_cast<double>(scenario_.rewards.pickup);
  // A pickup or drop-off replaces the step reward.
  const auto action = -static_cast<double>(scenario_.rewards.step);
  Gains gains;
  std::int32_t carried = 0;
  for (std::size_t d = 0; d < devices_; ++d) {
    const PickupPlan plan = PickupPlanOf(set, d);
    if (plan == kGone) continue;
    ++carried;
    gains.actions += drop_off;
    gains.if_not += std::max(0.0, drop_off) + action;
    if (plan != kWaiting) continue;
    const double value = static_cast<double>(value_[d]) * static_cast<double>(health_[d]);
    gains.value += value;
    gains.actions += pickup;
    gains.if_not += std::max(0.0, pickup + value) + action;
    ++gains.steps;
  }
  gains.steps += scenario_.ships.capacity == 1 ? carried : carried > 0 ? 1 : 0;
  return gains;
}

void PlannerSolver::SumGains() {
  gains_.resize(sets_.size());
  for (std::size_t set = 0; set < sets_.size(); ++set) {
    if (IsOfTask(set)) gains_[set] = GainsOf(set);
  }
}

PlannerSolver::BestRewards PlannerSolver::BestOf(const RiskLayers& layers) const {
  const float triggered = std::max(scenario_.rewards.illegal, best_crash_);
  float quiet = static_cast<float>(kNever);
  float risk = quiet;
  for (std::size_t cell = 0; cell < cells_; ++cell) {
    if (options_[cell].empty()) continue;  // land
    quiet = std::max(quiet, layers.quiet.data()[cell]);
    risk = std::max(risk, layers.risk.data()[cell]);
  }
  return {static_cast<double>(std::max(quiet, risk + triggered)), static_cast<double>(risk)};
}

// Computes step_rewards_ and surcharges_. It reads the risks of twice as many steps as the task
// takes in quiet water, plus kMargin. For later steps, it assumes the best reward that a step can
// have.
void PlannerSolver::SumStepRewards(const Farm& farm) {
  constexpr std::int32_t kMargin = 32;
  first_step_ = farm.step();
  const auto steps = static_cast<std::size_t>(std::max(0, last_step_ - first_step_));
  step_rewards_.assign(steps + 1, 0.0);
  surcharges_.assign(steps + 1, 0.0);
  const Ship& ship = farm.ships()[static_cast<std::size_t>(task_->ship)];
  const auto cell = static_cast<std::size_t>(LinearIndex(ship.cell, scenario_.width));
  std::size_t set = 0;  // all devices wait, which takes the most moves
  for (std::size_t d = task_->devices.size(); d < devices_; ++d) set = With(set, d, kGone);
  const auto known =
      static_cast<std::size_t>(2 * (moves_[set * cells_ + cell] + gains_[set].steps) + kMargin);
  const double later = std::max(
      {move_reward_, static_cast<double>(std::max(scenario_.rewards.illegal, best_crash_))});
  for (std::size_t k = 1; k <= steps; ++k) {
    BestRewards best{later, 0.0};
    if (k <= known) best = BestOf(risks_->At(first_step_ + static_cast<std::int32_t>(k)));
    step_rewards_[k] = step_rewards_[k - 1] + best.any - idle_cost_;
    // The reward of a pickup or a drop-off is in Gains. Its step adds only the risk.
    surcharges_[k] =
        surcharges_[k - 1] + std::max(std::min(0.0, best.any - move_reward_), best.risk);
  }
}

// Returns an upper bound of the return after `step`. Either the plan completes its task after at
// least the min number of moves and actions, or it lasts until the end. Each step earns at most its
// best reward.
double PlannerSolver::Bound(std::uint32_t state, std::int32_t step) const {
  const Gains& gains = gains_[state / cells_];
  const auto at = static_cast<std::size_t>(step - first_step_);
  const double bound = gains.if_not + step_rewards_.back() - step_rewards_[at];
  const std::int32_t moves = moves_[state];
  const std::size_t end = at + static_cast<std::size_t>(moves + gains.steps);
  if (end >= surcharges_.size()) return bound;  // also if moves is kUnreachable
  const double rewards = rewards_.empty() ? gains.actions + moves * move_reward_ : rewards_[state];
  return std::max(bound, rewards + gains.value + surcharges_[end] - surcharges_[at]);
}

void PlannerSolver::EnterStep(const Farm& farm, std::int32_t step) {
  layers_of_step_ = &risks_->At(step);
  for (std::size_t d = 0; d < task_->devices.size(); ++d) {
    damaging_[d] = layers_of_step_->Damaging(kind_[d]).data();
  }
  const float probability = scenario_.damage.crash_probability;
  const auto draws = Draw(
      {farm.seed(), farm.episode(), RngStream::kDamage, static_cast<std::uint32_t>(task_->ship)},
      static_cast<std::uint32_t>(step));
  crash_hurts_ = probability >= 1.0F || ToUnit(draws[0]) < probability;
}

// Updates the health that waiting devices have after this step.
void PlannerSolver::WearDown() {
  const float exposure = scenario_.damage.exposure_damage;
  bool is_worn = false;
  for (std::size_t d = 0; d < task_->devices.size() && exposure > 0.0F; ++d) {
    const float risk = damaging_[d][site_[d]];
    is_worn = is_worn || risk < 0.0F;
    health_[d] = std::max(0.0F, health_[d] + exposure * risk);
  }
  if (is_worn) SumGains();
}

}  // namespace aquafarm::agents
