// SPDX-License-Identifier: BSD-3-Clause
// The search for a plan, forward in time. It keeps the max return so far of each state, and prunes
// states by Bound.
#include <algorithm>
#include <cmath>
#include <utility>

#include "aquafarm/base/check.h"
#include "planning/planner_solver.h"

namespace aquafarm::agents {

std::size_t PlannerSolver::With(std::size_t set, std::size_t device, PickupPlan pickup) const {
  const std::uint32_t bits =
      (sets_[set] & ~(3U << (2 * device))) | (static_cast<std::uint32_t>(pickup) << (2 * device));
  const std::int32_t found = set_of_bits_[bits];
  return found == kNone ? sets_.size() : static_cast<std::size_t>(found);
}

std::size_t PlannerSolver::Delivered(std::size_t set) const {
  for (std::size_t d = 0; d < devices_; ++d) {
    const PickupPlan pickup = PickupPlanOf(set, d);
    if (pickup == kPaid || pickup == kUnpaid) set = With(set, d, kGone);
  }
  return set;
}

void PlannerSolver::Prepare(const Farm& farm) {
  const bool is_prepared = IsPrepared(farm);
  if (!is_prepared) {
    PriceEnergy(farm);
    ListOptions(farm);
    const Layout& layout = farm.layout();
    chart_.cells = layout.cells;
    chart_.crash_reward = layout.crash_reward;
    chart_.ports = layout.ports;
    planned_devices_ = task_->devices.size();
    const Ship& ship = farm.ships()[static_cast<std::size_t>(task_->ship)];
    planned_self_propelled_ = ship.own_device != kNone;
  }
  for (std::size_t d = 0; d < task_->devices.size(); ++d) {
    const Device& device = farm.devices()[static_cast<std::size_t>(task_->devices[d])];
    site_[d] = LinearIndex(device.cell, scenario_.width);
    value_[d] = device.value;
    kind_[d] = device.kind;
    health_[d] = device.health;
  }
  if (!is_prepared) {
    move_reward_ = static_cast<double>(risks_->best_quiet());
    CountMoves();
    const bool costs_energy = idle_cost_ > 0.0 || km_cost_ > 0.0;
    rewards_.clear();
    if (scenario_.ships.capacity > 1 || costs_energy) SumRewards();
  }
  last_step_ = risks_->last_step();
  if (task_->until > 0) last_step_ = std::min(last_step_, task_->until);
  SumGains();
  SumStepRewards(farm);
  best_ = kNever;
  best_layer_ = 0;
}

// Returns the value lost if each paid device aboard loses the health `share`, [0, 1].
double PlannerSolver::Loss(std::size_t set, float share) const {
  double loss = 0.0;
  for (std::size_t d = 0; d < devices_ && share > 0.0F; ++d) {
    if (PickupPlanOf(set, d) == kPaid) {
      loss += static_cast<double>(share) * static_cast<double>(value_[d]);
    }
  }
  return loss;
}

// Returns the value that the paid devices aboard lose in this step at a cell, due to its risk.
double PlannerSolver::Wear(std::size_t set, std::size_t cell) const {
  const float exposure = scenario_.damage.exposure_damage;
  double loss = 0.0;
  for (std::size_t d = 0; d < task_->devices.size() && exposure > 0.0F; ++d) {
    if (PickupPlanOf(set, d) != kPaid) continue;
    const float share = -exposure * damaging_[d][cell];
    loss += static_cast<double>(share) * static_cast<double>(value_[d]);
  }
  return loss;
}

void PlannerSolver::Reach(std::int32_t step, std::uint32_t state, double value,
                          std::uint32_t parent, std::uint8_t action) {
  if (value + Bound(state, step) <= best_ + kTolerance) return;
  Open& open = open_[state];
  std::vector<Node>& layer = layers_.back();
  if (open.mark != mark_) {
    open = {value, static_cast<std::uint32_t>(layer.size()), mark_};
    layer.push_back({state, parent, action});
    next_values_.push_back(value);
  } else if (value > open.reached) {
    open.reached = value;
    layer[open.layer_index] = {state, parent, action};
    next_values_[open.layer_index] = value;
  }
}

void PlannerSolver::Complete(std::uint32_t parent, std::uint8_t action, double value) {
  if (value <= best_ + kTolerance) return;
  best_ = value;
  best_layer_ = layers_.size() - 1;
  best_parent_ = parent;
  best_action_ = action;
}

void PlannerSolver::Expand(std::int32_t step, std::size_t index) {
  const Node node = layers_[layers_.size() - 2][index];
  const double so_far = values_[index];
  if (so_far + Bound(node.state, step - 1) <= best_ + kTolerance) return;
  const std::size_t set = node.state / cells_;
  const std::size_t cell = node.state % cells_;
  const auto parent = static_cast<std::uint32_t>(index);
  const auto state = [this](std::size_t of_set, std::size_t at) {
    return static_cast<std::uint32_t>(of_set * cells_ + at);
  };
  for (const Option& option : options_[cell]) {
    const auto to = static_cast<std::size_t>(option.to);
    const float risk = layers_of_step_->risk.data()[to];
    double reward = option.triggers ? static_cast<double>(option.reward) + static_cast<double>(risk)
                                    : static_cast<double>(layers_of_step_->quiet.data()[to]);
    const float crash = crash_hurts_ ? option.damage : 0.0F;
    reward -= Loss(set, crash) + Wear(set, to) + EnergyCost(set, option, risk);
    if (!IsInTheWay(step, to)) {
      Reach(step, state(set, to), so_far + reward, parent, option.action);
    }
  }
  if (IsInTheWay(step, cell)) return;
  const float risk = layers_of_step_->risk.data()[cell];
  // A pickup takes the first waiting device in the cell, as in the farm.
  for (std::size_t d = 0; d < devices_; ++d) {
    if (site_[d] != static_cast<std::int32_t>(cell) || PickupPlanOf(set, d) != kWaiting) continue;
    for (const PickupPlan pickup : {kPaid, kUnpaid}) {
      const std::size_t next = With(set, d, pickup);
      if (next == sets_.size()) continue;
      double reward = static_cast<double>(scenario_.rewards.pickup) + static_cast<double>(risk) -
                      Wear(next, cell) - idle_cost_;
      if (pickup == kPaid) {
        reward += static_cast<double>(value_[d]) * static_cast<double>(health_[d]);
      }
      Reach(step, state(next, cell), so_far + reward, parent,
            static_cast<std::uint8_t>(Action::kPickup));
    }
    break;
  }
  const std::size_t unloaded = Delivered(set);
  const Cell at{static_cast<std::int32_t>(cell) % scenario_.width,
                static_cast<std::int32_t>(cell) / scenario_.width};
  if (unloaded == set || (chart_.bits(at) & kPortBit) == 0) return;
  const double value = so_far + static_cast<double>(scenario_.rewards.drop_off) +
                       static_cast<double>(risk) - idle_cost_;
  constexpr auto kDropOff = static_cast<std::uint8_t>(Action::kDropOff);
  if (unloaded == all_gone_) {
    Complete(parent, kDropOff, value);
  } else {
    Reach(step, state(unloaded, cell), value, parent, kDropOff);
  }
}

// Returns whether other ships exclude this ship from a cell. They never exclude it from a port.
bool PlannerSolver::IsInTheWay(std::int32_t step, std::size_t cell) const {
  if (task_->others == nullptr) return false;
  const auto index = static_cast<std::int32_t>(cell);
  const Cell at{index % scenario_.width, index / scenario_.width};
  if ((chart_.bits(at) & kPortBit) != 0) return false;
  return task_->others->IsTaken(task_->ship, step, index);
}

Plan PlannerSolver::Solve(const Farm& farm, RiskSource& risks, const Task& task) {
  AQUAFARM_CHECK_LE(task.devices.size(), devices_);
  if (farm.over()) return {};
  task_ = &task;
  risks_ = &risks;
  Prepare(farm);
  // The result of a narrow search prunes the exact search.
  Search(farm, kBeam);
  Plan narrow = Trace();
  if (best_ != kNever) best_ -= kSlack;
  best_layer_ = 0;
  Search(farm, state_count());
  return best_layer_ == 0 ? narrow : Trace();
}

void PlannerSolver::Search(const Farm& farm, std::size_t widest) {
  for (std::size_t d = 0; d < task_->devices.size(); ++d) {
    health_[d] = farm.devices()[static_cast<std::size_t>(task_->devices[d])].health;
  }
  SumGains();
  layers_.clear();
  std::int32_t step = farm.step();
  ReachStart(farm);
  while (step < last_step_ && !layers_.back().empty()) {
    Narrow(step, widest);
    ++step;
    EnterStep(farm, step);
    values_.swap(next_values_);
    next_values_.clear();
    layers_.emplace_back();
    ++mark_;
    const std::size_t count = layers_[layers_.size() - 2].size();
    for (std::size_t index = 0; index < count; ++index) Expand(step, index);
    WearDown();
  }
  if (step == last_step_) EndOfTime();
}

// Reaches the states at the farm's present step: each device aboard may be paid or unpaid.
void PlannerSolver::ReachStart(const Farm& farm) {
  layers_.emplace_back();
  ++mark_;
  next_values_.clear();
  const Ship& ship = farm.ships()[static_cast<std::size_t>(task_->ship)];
  const auto cell = static_cast<std::size_t>(LinearIndex(ship.cell, scenario_.width));
  std::vector<std::pair<std::size_t, double>> starts{{0, 0.0}};
  for (std::size_t d = 0; d < devices_; ++d) {
    if (d >= task_->devices.size()) {  // a slot that this task does not use
      for (auto& start : starts) start.first = With(start.first, d, kGone);
      continue;
    }
    const std::int32_t id = task_->devices[d];
    const Device& device = farm.devices()[static_cast<std::size_t>(id)];
    // A self-propelled device counts as aboard its own ship.
    if (device.status == DeviceStatus::kDeployed && id != ship.own_device) continue;
    const std::size_t count = starts.size();
    for (std::size_t i = 0; i < count; ++i) {
      const auto [set, held] = starts[i];
      if (device.status == DeviceStatus::kDelivered) {
        starts[i] = {With(set, d, kGone), held};
        continue;
      }
      const double value = static_cast<double>(device.value) * static_cast<double>(device.health);
      starts.emplace_back(With(set, d, kUnpaid), held);
      starts[i] = {With(set, d, kPaid), held + value};
    }
  }
  for (const auto& [set, held] : starts) {
    Reach(farm.step(), static_cast<std::uint32_t>(set * cells_ + cell), held, 0, 0);
  }
}

// Removes states from the newest layer until it has at most `widest` of them. The states with the
// highest upper bounds of the return remain.
void PlannerSolver::Narrow(std::int32_t step, std::size_t widest) {
  std::vector<Node>& layer = layers_.back();
  if (layer.size() <= widest) return;
  std::vector<std::size_t> order(layer.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::vector<double> promises(layer.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    promises[i] = next_values_[i] + Bound(layer[i].state, step);
  }
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(widest), order.end(),
                   [&](std::size_t i, std::size_t k) {
                     return promises[i] != promises[k] ? promises[i] > promises[k] : i < k;
                   });
  std::vector<Node> kept(widest);
  std::vector<double> kept_values(widest);
  for (std::size_t i = 0; i < widest; ++i) {
    kept[i] = layer[order[i]];
    kept_values[i] = next_values_[order[i]];
  }
  layer = std::move(kept);
  next_values_ = std::move(kept_values);
}

// Completes the plans that last until last_step_. Plans with an undelivered paid device are
// invalid.
void PlannerSolver::EndOfTime() {
  for (std::size_t index = 0; index < layers_.back().size(); ++index) {
    const Node& node = layers_.back()[index];
    bool broken = false;
    for (std::size_t d = 0; d < task_->devices.size(); ++d) {
      broken = broken || PickupPlanOf(node.state / cells_, d) == kPaid;
    }
    if (!broken) Complete(node.parent, node.action, next_values_[index]);
  }
}

Plan PlannerSolver::Trace() const {
  Plan plan;
  if (best_layer_ == 0) return plan;  // there is no complete plan
  plan.expected_return = best_;
  std::uint32_t parent = best_parent_;
  plan.actions.push_back(best_action_);
  for (std::size_t layer = best_layer_ - 1; layer > 0; --layer) {
    const Node& node = layers_[layer][parent];
    plan.actions.push_back(node.action);
    parent = node.parent;
  }
  std::reverse(plan.actions.begin(), plan.actions.end());
  return plan;
}

}  // namespace aquafarm::agents
