// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Implementation of Planner. planner_solver.cpp prepares the farm and the task as a graph of
/// states. planner_search.cpp searches the graph. A state consists of a cell of the ship and a
/// *set*: the statuses (PickupPlan) of all devices of the task. The index of a state is
/// (index of its set) · (number of cells) + (index of its cell).

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "aquafarm/agents/planning/risk_source.h"

namespace aquafarm::agents {

/// Status of a device in a plan: at its site, aboard as paid or unpaid (planner.h), or delivered.
/// If the task has fewer than the max number of devices, the unused positions of a set hold kGone.
enum PickupPlan : std::uint8_t { kWaiting, kPaid, kUnpaid, kGone };

constexpr double kNever = -std::numeric_limits<double>::infinity();
// Plans whose returns differ by at most this much count as equal, because rounding may cause such a
// difference.
constexpr double kTolerance = 1e-6;
// A narrow search finds a first plan, then an exact search follows. The exact search prunes a state
// if its upper bound does not exceed the return of the first plan minus this margin. It thus finds
// the same plan again if there is no better one.
constexpr double kSlack = 1e-3;
// Max number of states that the narrow search keeps in each step.
constexpr std::size_t kBeam = 64;

// Result of one action in one cell. The action is a move, or an illegal pickup or drop-off. The
// effects of disasters are not included.
struct Option {
  std::int32_t to{};      // cell after the action
  float reward{};         // reward of a crash or an illegal action; 0 for a move
  float damage{};         // health that each device aboard loses in a crash, [0, 1]
  double km{};            // distance covered
  std::uint8_t action{};  // Action
  bool triggers{};  // true for a crash or an illegal action: `reward` replaces the step reward
};

class PlannerSolver {
 public:
  PlannerSolver(const Scenario& scenario, std::int32_t max_devices);
  Plan Solve(const Farm& farm, RiskSource& risks, const Task& task);
  std::size_t state_count() const { return sets_.size() * cells_; }

 private:
  // A state reached at some step, with its predecessor. All nodes of a step form a layer.
  struct Node {
    std::uint32_t state;
    std::uint32_t parent;  // index of the predecessor in the previous layer
    std::uint8_t action;   // action that led from the predecessor to this state
  };
  // Whether and how a state was reached in the newest layer.
  struct Open {
    double reached{kNever};       // max return so far
    std::uint32_t layer_index{};  // index of its node in the layer
    std::uint32_t mark{};         // mark_ of the layer in which the state was last reached
  };
  // Upper bounds of the rewards that a set can still earn with pickups and drop-offs. The rewards
  // of moves and waiting are not included.
  struct Gains {
    double value{};        // value of the waiting devices, multiplied by their health
    double actions{};      // rewards of pickups and drop-offs if each device is delivered alone
    double if_not{};       // for a plan that lasts until the end of the episode: positive rewards
                           // of pickups (with the value) and drop-offs, minus the step rewards
                           // that these replace
    std::int32_t steps{};  // min number of pickups and drop-offs until all devices are delivered
  };

  PickupPlan PickupPlanOf(std::size_t set, std::size_t device) const {
    return static_cast<PickupPlan>((sets_[set] >> (2 * device)) & 3U);
  }
  std::size_t With(std::size_t set, std::size_t device, PickupPlan pickup) const;
  std::size_t Delivered(std::size_t set) const;

  void Prepare(const Farm& farm);
  void PriceEnergy(const Farm& farm);
  // Returns the cost of the energy of a step with one of options_.
  // @param risk at option.to
  double EnergyCost(std::size_t set, const Option& option, float risk) const {
    const double sea = 1.0 + rough_sea_ * static_cast<double>(risk);
    return idle_cost_ + km_cost_ * load_[set] * option.km * sea;
  }
  void ListOptions(const Farm& farm);
  bool IsPrepared(const Farm& farm) const;
  std::vector<std::size_t> LastSetsFirst() const;
  void CountMoves();
  void SeedMoves(std::size_t set);
  void SumRewards();
  void SeedRewards(std::size_t set, std::vector<double>& best) const;
  bool IsOfTask(std::size_t set) const;
  void SumGains();
  Gains GainsOf(std::size_t set) const;
  void SumStepRewards(const Farm& farm);
  // Max rewards over all cells in one step.
  struct BestRewards {
    double any{};   // max reward of a step without a pickup or a drop-off
    double risk{};  // mildest risk; it is the max, because risks are at most 0
  };
  BestRewards BestOf(const RiskLayers& layers) const;
  double Bound(std::uint32_t state, std::int32_t step) const;
  void EnterStep(const Farm& farm, std::int32_t step);
  void WearDown();
  double Loss(std::size_t set, float share) const;
  double Wear(std::size_t set, std::size_t cell) const;

  void Expand(std::int32_t step, std::size_t index);
  void Reach(std::int32_t step, std::uint32_t state, double value, std::uint32_t parent,
             std::uint8_t action);
  void Complete(std::uint32_t parent, std::uint8_t action, double value);
  void Search(const Farm& farm, std::size_t widest);
  void ReachStart(const Farm& farm);
  void Narrow(std::int32_t step, std::size_t widest);
  void EndOfTime();
  Plan Trace() const;
  bool IsInTheWay(std::int32_t step, std::size_t cell) const;

  const Scenario& scenario_;
  std::size_t cells_;
  std::size_t devices_;                    // max devices of a task
  std::vector<std::uint32_t> sets_;        // two bits per device: its PickupPlan
  std::vector<std::int32_t> set_of_bits_;  // inverse of sets_; kNone if the number of devices
                                           // aboard exceeds the capacity
  std::size_t all_gone_{};                 // index of the set in which all devices are kGone

  // Data of the current farm and task.
  const Task* task_{};
  RiskSource* risks_{};
  const RiskLayers* layers_of_step_{};
  std::int32_t last_step_{};
  std::vector<float> value_;
  std::vector<DeviceKind> kind_;
  std::vector<const float*> damaging_;  // by device: [H, W] risk that damages it in this step
  std::vector<float> health_;           // of the waiting devices, at the current step of the search
  std::vector<Gains> gains_;            // by set, for the values in health_
  std::int32_t first_step_{};           // the farm's present step
  // Cumulative sums by step from first_step_ on.
  std::vector<double> step_rewards_;  // sum of (best reward − idle_cost_) of each step
  // Each step contributes an upper bound of what risks add to its reward. The bound is at most 0.
  std::vector<double> surcharges_;
  bool crash_hurts_{};  // whether a crash in this step damages devices

  // Costs of energy in the reward (farm/energy.h); 0 without energy.
  double idle_cost_{};        // cost of a step without distance
  double km_cost_{};          // cost of a kilometre without load in calm water
  double rough_sea_{};        // 1 + rough_sea_ · risk is the factor of km_cost_ in a rough sea
  std::vector<double> load_;  // by set: factor of km_cost_ for the devices aboard

  // Data that the next plan reuses if the chart, the devices and move_reward_ are the same.
  Layout chart_;                              // only cells, crash_reward and ports are set
  std::vector<std::vector<Option>> options_;  // by cell
  float best_crash_{};                        // best reward of a crash on the chart
  std::vector<std::int32_t> site_;            // by device: its linear cell
  std::size_t planned_devices_{};             // number of devices of the task
  bool planned_self_propelled_{};             // whether the task's ship is a device
  std::vector<std::int32_t> moves_;  // by state: min moves until the task's devices are delivered
  double move_reward_{};             // upper bound of the reward of a move
  // By state: upper bound of the reward until the task's devices are delivered, without their
  // values. Empty with a capacity of 1 and no cost of energy: the bound then uses moves_.
  std::vector<double> rewards_;
  std::vector<std::pair<std::int32_t, std::size_t>> sources_;  // (moves, cell), for CountMoves
  std::vector<std::size_t> queue_;

  // State of the search.
  std::vector<std::vector<Node>> layers_;  // by step: the reached states
  std::vector<double> values_;             // return so far of each node of the expanded layer
  std::vector<double> next_values_;        // return so far of each node of the newest layer
  std::vector<Open> open_;                 // by state
  std::uint32_t mark_{};                   // number of layers of all searches so far
  // The best complete plan: its return, and its last action from best_parent_ in the layer before
  // best_layer_. best_layer_ is 0 if the present search has found no plan.
  double best_{kNever};
  std::size_t best_layer_{};
  std::uint32_t best_parent_{};
  std::uint8_t best_action_{};
};

}  // namespace aquafarm::agents
