// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <string>
#include <utility>

#include "aquafarm/check.h"
#include "aquafarm/disaster.h"
#include "aquafarm/forecast.h"
#include "water_distance.h"

namespace aquafarm::agents {
namespace {

// What has become of a device, as far as a plan goes.
enum Fate : std::uint8_t { kWaiting, kForValue, kForNothing, kGone };
constexpr std::int32_t kFates = 4;

constexpr double kNever = -std::numeric_limits<double>::infinity();
// Sums of floats in double differ from the farm's own by less than this.
constexpr double kTolerance = 1e-6;
// By how much the exact search undercuts the narrow one's result, to meet it again on its own.
constexpr double kSlack = 1e-3;
// States kept a step by the narrow search.
constexpr std::size_t kBeam = 64;

// One way to act in a cell, before disasters: where it leads and what it pays.
struct Option {
  std::int32_t to{};
  float reward{};  // crash, illegal; 0 for a quiet move
  float damage{};  // health lost aboard in a crash
  std::uint8_t action{};
};

}  // namespace

class Planner::Solver {
 public:
  Solver(const Scenario& scenario, std::int32_t slots);
  Plan Solve(const Farm& farm, Foresight foresight, const Task& task);
  std::size_t state_count() const { return sets_.size() * cells_; }

 private:
  // A state reached at some time, and how.
  struct Node {
    std::uint32_t state;
    std::uint32_t parent;  // index into the layer before
    std::uint8_t action;
  };
  struct Open {
    double reached{kNever};
    std::uint32_t layer_index{};
    std::uint32_t mark{};  // layer in which it was reached, + 1
  };

  Fate FateOf(std::size_t set, std::size_t device) const {
    return static_cast<Fate>((sets_[set] >> (2 * device)) & 3U);
  }
  std::size_t With(std::size_t set, std::size_t device, Fate fate) const;
  std::size_t Delivered(std::size_t set) const;

  void Prepare(const Farm& farm);
  void ListOptions(const Farm& farm);
  void SolveBound();
  bool IsOfTask(std::size_t set) const;
  void AddGains(std::size_t set, std::vector<double>& best) const;
  void FollowDisasters(const Farm& farm, Foresight foresight);
  void AdvanceDisasters(const Farm& farm, std::int32_t step);
  void WearDown();
  double Loss(std::size_t set, float share) const;

  void Expand(std::int32_t step, std::size_t index);
  void Reach(std::int32_t step, std::uint32_t state, double value, std::uint32_t parent,
             std::uint8_t action);
  void Complete(std::uint32_t parent, std::uint8_t action, double value);
  void Search(const Farm& farm, Foresight foresight, std::size_t widest);
  std::int32_t LastStep(std::int32_t step) const;
  void ReachStart(const Farm& farm);
  void Narrow(std::size_t widest);
  void EndOfTime();
  Plan Trace() const;
  bool IsInTheWay(std::int32_t step, std::size_t cell) const;

  const Scenario& scenario_;
  std::size_t cells_;
  std::size_t devices_;                    // slots of a task
  std::vector<std::uint32_t> sets_;        // two bits a device: its Fate
  std::vector<std::int32_t> set_of_bits_;  // back; kNone: more aboard than capacity
  std::size_t all_gone_{};

  // Of the farm and the task planned for.
  const Task* task_{};
  const Layout* layout_{};
  std::vector<std::vector<Option>> options_;  // by cell
  std::vector<std::int32_t> site_;            // by device: its cell
  std::vector<float> value_;
  std::vector<float> health_;  // of what still waits, now
  std::vector<double> bound_;  // by state: most that can follow, were there no disaster
  std::vector<Disaster> disasters_;
  std::vector<Track> tracks_;  // that they are thought to follow
  Grid<float> risk_;
  bool crash_hurts_{};

  // The search.
  std::vector<std::vector<Node>> layers_;
  std::vector<double> values_;       // of the layer being expanded
  std::vector<double> next_values_;  // of the layer being reached
  std::vector<Open> open_;           // by state
  double best_{kNever};
  std::size_t best_layer_{};
  std::uint32_t best_parent_{};
  std::uint8_t best_action_{};
};

Planner::Solver::Solver(const Scenario& scenario, std::int32_t slots)
    : scenario_(scenario),
      cells_(static_cast<std::size_t>(scenario.CellCount())),
      devices_(static_cast<std::size_t>(slots > 0 ? slots : scenario.devices.Total())) {
  constexpr std::size_t kMostDevices = 12;
  if (scenario.rewards.step > 0.0F) {
    throw InputError(
        "planner: rewards.step: got more than 0, expected at most 0: there would be "
        "no end to what dawdling earns");
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
      aboard += fate == kForValue || fate == kForNothing ? 1 : 0;
    }
    if (aboard > scenario.ships.capacity) continue;
    set_of_bits_[bits] = static_cast<std::int32_t>(sets_.size());
    sets_.push_back(static_cast<std::uint32_t>(bits));
  }
  all_gone_ = static_cast<std::size_t>(set_of_bits_[codes - 1]);
  if (state_count() > kMaxStates) {
    throw InputError("planner: got " + std::to_string(state_count()) +
                     " states, expected at most " + std::to_string(kMaxStates) +
                     "; fewer devices or cells are needed");
  }
  site_.resize(devices_);
  value_.resize(devices_);
  health_.resize(devices_);
  risk_.resize(scenario.height, scenario.width);
  open_.resize(state_count());
}

std::size_t Planner::Solver::With(std::size_t set, std::size_t device, Fate fate) const {
  const std::uint32_t bits =
      (sets_[set] & ~(3U << (2 * device))) | (static_cast<std::uint32_t>(fate) << (2 * device));
  const std::int32_t found = set_of_bits_[bits];
  return found == kNone ? sets_.size() : static_cast<std::size_t>(found);
}

std::size_t Planner::Solver::Delivered(std::size_t set) const {
  for (std::size_t d = 0; d < devices_; ++d) {
    const Fate fate = FateOf(set, d);
    if (fate == kForValue || fate == kForNothing) set = With(set, d, kGone);
  }
  return set;
}

// --- the farm without its disasters --------------------------------------------------------------

void Planner::Solver::ListOptions(const Farm& farm) {
  layout_ = &farm.layout();
  options_.resize(cells_);
  for (std::int32_t y = 0; y < scenario_.height; ++y) {
    for (std::int32_t x = 0; x < scenario_.width; ++x) {
      const std::int32_t here = LinearIndex({x, y}, scenario_.width);
      std::vector<Option>& options = options_[static_cast<std::size_t>(here)];
      options.clear();
      if ((layout_->bits({x, y}) & kBlockedBits) != 0) continue;
      // Standing still: of all ways to stay without a crash, the cheapest.
      Option stay{here, scenario_.rewards.illegal, 0.0F,
                  static_cast<std::uint8_t>(Action::kPickup)};
      for (std::uint8_t action = 0; action < kMoveCount; ++action) {
        const Cell to{x + kMoves[action].x, y + kMoves[action].y};
        const bool on_map =
            to.x >= 0 && to.y >= 0 && to.x < scenario_.width && to.y < scenario_.height;
        if (!on_map) {
          stay = {here, 0.0F, 0.0F, action};
        } else if ((layout_->bits(to) & kBlockedBits) != 0) {
          const float reward = layout_->crash_reward(to.y, to.x);
          options.push_back(
              {here, reward, CrashDamage(scenario_, layout_->bits(to), reward), action});
        } else {
          options.push_back({LinearIndex(to, scenario_.width), 0.0F, 0.0F, action});
        }
      }
      options.push_back(stay);
    }
  }
}

// Adds to `best` [cells] what picking up or dropping off there leads to.
void Planner::Solver::AddGains(std::size_t set, std::vector<double>& best) const {
  const auto bound = [&](std::size_t next, std::size_t cell) {
    return next == all_gone_ ? 0.0 : bound_[next * cells_ + cell];
  };
  for (std::size_t d = 0; d < devices_; ++d) {
    if (FateOf(set, d) != kWaiting) continue;
    const auto cell = static_cast<std::size_t>(site_[d]);
    for (const Fate fate : {kForValue, kForNothing}) {
      const std::size_t next = With(set, d, fate);
      if (next == sets_.size()) continue;
      const double worth =
          fate == kForValue ? static_cast<double>(value_[d]) * static_cast<double>(health_[d]) : 0;
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

// Slots that a task does not need count as gone from the start.
bool Planner::Solver::IsOfTask(std::size_t set) const {
  for (std::size_t d = task_->devices.size(); d < devices_; ++d) {
    if (FateOf(set, d) != kGone) return false;
  }
  return true;
}

// Device sets only ever advance, so each layer of cells is solved once, the last ones first: the
// most that any cell can still earn, a step costing what it costs in quiet water, or in the mildest
// risk where that costs less.
void Planner::Solver::SolveBound() {
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
    std::fill(best.begin(), best.end(), 0.0);  // doing nothing more is no better than free
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

// --- the disasters ------------------------------------------------------------------------------

void Planner::Solver::FollowDisasters(const Farm& farm, Foresight foresight) {
  disasters_ = farm.disasters();
  tracks_ = Foresee(farm, foresight, disasters_);
}

void Planner::Solver::AdvanceDisasters(const Farm& farm, std::int32_t step) {
  for (std::size_t id = 0; id < disasters_.size(); ++id) {
    const StreamKey key{farm.seed(), farm.episode(), Purpose::kDisasterTurn,
                        static_cast<std::uint32_t>(id)};
    MoveDisaster(disasters_[id], tracks_[id], key, step, scenario_.width, scenario_.height);
  }
  FillRisk(scenario_, disasters_, risk_);
  const float probability = scenario_.damage.crash_probability;
  const auto draws =
      Draw({farm.seed(), farm.episode(), Purpose::kDamage, static_cast<std::uint32_t>(task_->ship)},
           static_cast<std::uint32_t>(step));
  crash_hurts_ = probability >= 1.0F || ToUnit(draws[0]) < probability;
}

// What still waits where it was deployed, after the damage of this step.
void Planner::Solver::WearDown() {
  const float exposure = scenario_.damage.exposure_damage;
  for (std::size_t d = 0; d < task_->devices.size() && exposure > 0.0F; ++d) {
    health_[d] = std::max(0.0F, health_[d] + exposure * risk_.data()[site_[d]]);
  }
}

// --- the search ---------------------------------------------------------------------------------

void Planner::Solver::Prepare(const Farm& farm) {
  ListOptions(farm);
  for (std::size_t d = 0; d < task_->devices.size(); ++d) {
    const Device& device = farm.devices()[static_cast<std::size_t>(task_->devices[d])];
    site_[d] = LinearIndex(device.cell, scenario_.width);
    value_[d] = device.value;
    health_[d] = device.health;
  }
  SolveBound();
  best_ = kNever;
  best_layer_ = 0;
}

// Value lost when what is aboard for its value loses `share` of its health.
double Planner::Solver::Loss(std::size_t set, float share) const {
  double loss = 0.0;
  for (std::size_t d = 0; d < devices_ && share > 0.0F; ++d) {
    if (FateOf(set, d) == kForValue) {
      loss += static_cast<double>(share) * static_cast<double>(value_[d]);
    }
  }
  return loss;
}

void Planner::Solver::Reach(std::int32_t step, std::uint32_t state, double value,
                            std::uint32_t parent, std::uint8_t action) {
  if (value + bound_[state] <= best_ + kTolerance) return;
  Open& open = open_[state];
  const auto mark = static_cast<std::uint32_t>(step) + 1;
  std::vector<Node>& layer = layers_.back();
  if (open.mark != mark) {
    open = {value, static_cast<std::uint32_t>(layer.size()), mark};
    layer.push_back({state, parent, action});
    next_values_.push_back(value);
  } else if (value > open.reached) {
    open.reached = value;
    layer[open.layer_index] = {state, parent, action};
    next_values_[open.layer_index] = value;
  }
}

void Planner::Solver::Complete(std::uint32_t parent, std::uint8_t action, double value) {
  if (value <= best_ + kTolerance) return;
  best_ = value;
  best_layer_ = layers_.size() - 1;
  best_parent_ = parent;
  best_action_ = action;
}

void Planner::Solver::Expand(std::int32_t step, std::size_t index) {
  const Node node = layers_[layers_.size() - 2][index];
  const double so_far = values_[index];
  if (so_far + bound_[node.state] <= best_ + kTolerance) return;
  const std::size_t set = node.state / cells_;
  const std::size_t cell = node.state % cells_;
  const auto parent = static_cast<std::uint32_t>(index);
  const float exposure = scenario_.damage.exposure_damage;
  const auto state = [this](std::size_t of_set, std::size_t at) {
    return static_cast<std::uint32_t>(of_set * cells_ + at);
  };
  for (const Option& option : options_[cell]) {
    const auto to = static_cast<std::size_t>(option.to);
    const float risk = risk_.data()[to];
    double reward = static_cast<double>(option.reward) + static_cast<double>(risk);
    if (option.reward == 0.0F && risk == 0.0F)
      reward += static_cast<double>(scenario_.rewards.step);
    const float crash = crash_hurts_ ? option.damage : 0.0F;
    reward -= Loss(set, crash) + Loss(set, -exposure * risk);
    if (!IsInTheWay(step, to)) {
      Reach(step, state(set, to), so_far + reward, parent, option.action);
    }
  }
  if (IsInTheWay(step, cell)) return;
  const float risk = risk_.data()[cell];
  // The farm picks up the lowest id of those that wait in a cell.
  for (std::size_t d = 0; d < devices_; ++d) {
    if (site_[d] != static_cast<std::int32_t>(cell) || FateOf(set, d) != kWaiting) continue;
    for (const Fate fate : {kForValue, kForNothing}) {
      const std::size_t next = With(set, d, fate);
      if (next == sets_.size()) continue;
      double reward = static_cast<double>(scenario_.rewards.pickup) + static_cast<double>(risk) -
                      Loss(next, -exposure * risk);
      if (fate == kForValue) {
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
  if (unloaded == set || (layout_->bits(at) & kPortBit) == 0) return;
  const double value =
      so_far + static_cast<double>(scenario_.rewards.drop_off) + static_cast<double>(risk);
  constexpr auto kDropOff = static_cast<std::uint8_t>(Action::kDropOff);
  if (unloaded == all_gone_) {
    Complete(parent, kDropOff, value);
  } else {
    Reach(step, state(unloaded, cell), value, parent, kDropOff);
  }
}

// Ports block nobody.
bool Planner::Solver::IsInTheWay(std::int32_t step, std::size_t cell) const {
  if (task_->others == nullptr) return false;
  const auto index = static_cast<std::int32_t>(cell);
  const Cell at{index % scenario_.width, index / scenario_.width};
  if ((layout_->bits(at) & kPortBit) != 0) return false;
  return task_->others->IsTaken(task_->ship, step, index);
}

Plan Planner::Solver::Solve(const Farm& farm, Foresight foresight, const Task& task) {
  AQUAFARM_CHECK_LE(task.devices.size(), devices_);
  if (farm.over()) return {};
  task_ = &task;
  Prepare(farm);
  // A narrow search first: what it finds prunes the exact one.
  Search(farm, foresight, kBeam);
  Plan narrow = Trace();
  if (best_ != kNever) best_ -= kSlack;
  best_layer_ = 0;
  Search(farm, foresight, state_count());
  return best_layer_ == 0 ? narrow : Trace();
}

void Planner::Solver::Search(const Farm& farm, Foresight foresight, std::size_t widest) {
  FollowDisasters(farm, foresight);
  for (std::size_t d = 0; d < task_->devices.size(); ++d) {
    health_[d] = farm.devices()[static_cast<std::size_t>(task_->devices[d])].health;
  }
  std::fill(open_.begin(), open_.end(), Open{});
  layers_.clear();
  std::int32_t step = farm.step();
  ReachStart(farm);
  std::int32_t last = LastStep(step);
  if (task_->until > 0) last = std::min(last, task_->until);
  while (step < last && !layers_.back().empty()) {
    ++step;
    AdvanceDisasters(farm, step);
    Narrow(widest);
    values_.swap(next_values_);
    next_values_.clear();
    layers_.emplace_back();
    const std::size_t count = layers_[layers_.size() - 2].size();
    for (std::size_t index = 0; index < count; ++index) Expand(step, index);
    WearDown();
  }
  if (step == last) EndOfTime();
}

std::int32_t Planner::Solver::LastStep(std::int32_t step) const {
  std::int32_t longest = 0;
  for (const Disaster& disaster : disasters_) longest = std::max(longest, disaster.steps_left);
  return disasters_.empty() ? scenario_.step_limit : std::min(scenario_.step_limit, step + longest);
}

// What is aboard already may be delivered for its value or for nothing.
void Planner::Solver::ReachStart(const Farm& farm) {
  layers_.emplace_back();
  next_values_.clear();
  const Ship& ship = farm.ships()[static_cast<std::size_t>(task_->ship)];
  const auto cell = static_cast<std::size_t>(LinearIndex(ship.cell, scenario_.width));
  std::vector<std::pair<std::size_t, double>> starts{{0, 0.0}};
  for (std::size_t d = 0; d < devices_; ++d) {
    if (d >= task_->devices.size()) {  // a slot that this task does not need
      for (auto& start : starts) start.first = With(start.first, d, kGone);
      continue;
    }
    const std::int32_t id = task_->devices[d];
    const Device& device = farm.devices()[static_cast<std::size_t>(id)];
    // A ship that is a device has itself aboard.
    if (device.status == DeviceStatus::kDeployed && id != ship.own_device) continue;
    const std::size_t count = starts.size();
    for (std::size_t i = 0; i < count; ++i) {
      const auto [set, held] = starts[i];
      if (device.status == DeviceStatus::kDelivered) {
        starts[i] = {With(set, d, kGone), held};
        continue;
      }
      const double worth = static_cast<double>(device.value) * static_cast<double>(device.health);
      starts.emplace_back(With(set, d, kForNothing), held);
      starts[i] = {With(set, d, kForValue), held + worth};
    }
  }
  for (const auto& [set, held] : starts) {
    Reach(farm.step(), static_cast<std::uint32_t>(set * cells_ + cell), held, 0, 0);
  }
}

// Keeps the most promising states of the layer just reached.
void Planner::Solver::Narrow(std::size_t widest) {
  std::vector<Node>& layer = layers_.back();
  if (layer.size() <= widest) return;
  std::vector<std::size_t> order(layer.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto promise = [&](std::size_t i) { return next_values_[i] + bound_[layer[i].state]; };
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(widest), order.end(),
                   [&](std::size_t i, std::size_t k) {
                     return promise(i) != promise(k) ? promise(i) > promise(k) : i < k;
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

// Time is over: what is aboard for its value was promised and not delivered.
void Planner::Solver::EndOfTime() {
  for (std::size_t index = 0; index < layers_.back().size(); ++index) {
    const Node& node = layers_.back()[index];
    bool broken = false;
    for (std::size_t d = 0; d < task_->devices.size(); ++d) {
      broken = broken || FateOf(node.state / cells_, d) == kForValue;
    }
    if (!broken) Complete(node.parent, node.action, next_values_[index]);
  }
}

Plan Planner::Solver::Trace() const {
  Plan plan;
  if (best_layer_ == 0) return plan;  // nothing was completed
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

std::vector<Track> Foresee(const Farm& farm, Foresight foresight,
                           std::vector<Disaster>& disasters) {
  std::vector<Track> tracks = farm.tracks();
  if (foresight == Foresight::kClairvoyant) return tracks;
  for (std::size_t id = 0; id < disasters.size(); ++id) {
    const auto disaster = static_cast<std::int32_t>(id);
    disasters[id].turn_threshold = 0;
    disasters[id].waypoint = kNone;
    // One with a track comes from afar and knows no border.
    if (!tracks[id]->empty()) disasters[id].border = Border::kLeave;
    if (!HasForecast(farm, disaster, farm.step())) continue;
    disasters[id].waypoint = 0;
    tracks[id] =
        std::make_shared<const std::vector<Waypoint>>(ForecastTrack(farm, disaster, farm.step()));
  }
  return tracks;
}

void Reservations::Add(std::int32_t id, std::int32_t first, const std::vector<std::int32_t>& path) {
  for (std::size_t k = 0; k < path.size(); ++k) {
    const std::int32_t step = first + static_cast<std::int32_t>(k);
    taken_[Key(step, path[k])].push_back({id, 0});
    // Ships move in id order: a higher id finds it gone on, a lower one where it was, and may not
    // be where it is about to go.
    taken_[Key(step - 1, path[k])].push_back({id, 1});
    taken_[Key(step + 1, path[k])].push_back({id, -1});
  }
}

bool Reservations::IsTaken(std::int32_t id, std::int32_t step, std::int32_t cell) const {
  const auto found = taken_.find(Key(step, cell));
  if (found == taken_.end()) return false;
  return std::any_of(found->second.begin(), found->second.end(), [id](const Visit& visit) {
    if (visit.ship == id) return false;
    if (visit.offset == 0) return true;
    return visit.offset > 0 ? visit.ship < id : visit.ship > id;
  });
}

Planner::Planner(const Scenario& scenario, std::int32_t slots)
    : solver_(std::make_unique<Solver>(scenario, slots)) {}
Planner::~Planner() = default;
Planner::Planner(Planner&&) noexcept = default;
Planner& Planner::operator=(Planner&&) noexcept = default;
std::size_t Planner::state_count() const { return solver_->state_count(); }
Plan Planner::Solve(const Farm& farm, Foresight foresight, const Task& task) {
  return solver_->Solve(farm, foresight, task);
}
Plan Planner::Solve(const Farm& farm, Foresight foresight) {
  AQUAFARM_CHECK_EQ(farm.ships().size(), 1U);
  Task task;
  for (std::size_t id = 0; id < farm.devices().size(); ++id) {
    task.devices.push_back(static_cast<std::int32_t>(id));
  }
  return Solve(farm, foresight, task);
}

}  // namespace aquafarm::agents
