// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Implementation of Planner: the farm and the task as a graph (planner_solver.cpp) and the search
/// in it (planner_search.cpp).

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "aquafarm/agents/planning/risk_source.h"

namespace aquafarm::agents {

/// Status of a device in a plan.
enum PickupPlan : std::uint8_t { kWaiting, kPaid, kUnpaid, kGone };
constexpr std::int32_t kFates = 4;

constexpr double kNever = -std::numeric_limits<double>::infinity();
// Sums of floats in double precision differ from the farm's own sums by less than this.
constexpr double kTolerance = 1e-6;
// Margin by which the exact search starts below the result of the narrow search, to find it again.
constexpr double kSlack = 1e-3;
// States per step that the narrow search keeps.
constexpr std::size_t kBeam = 64;

// One action in a cell without disasters: its destination and its reward.
struct Option {
  std::int32_t to{};
  float reward{};  // of a crash or an illegal action; 0 for a quiet move
  float damage{};  // health lost aboard in a crash
  double km{};     // distance covered
  std::uint8_t action{};
  bool triggers{};  // a crash or an illegal action, which replaces the step reward, even if it is 0
};

class PlannerSolver {
 public:
  PlannerSolver(const Scenario& scenario, std::int32_t max_devices);
  Plan Solve(const Farm& farm, RiskSource& risks, const Task& task);
  std::size_t state_count() const { return sets_.size() * cells_; }

 private:
  // A state reached at some step, with its predecessor.
  struct Node {
    std::uint32_t state;
    std::uint32_t parent;  // index into the previous layer
    std::uint8_t action;
  };
  struct Open {
    double reached{kNever};
    std::uint32_t layer_index{};
    std::uint32_t mark{};  // mark_ of the layer in which it was reached
  };
  // Upper bounds of the further rewards of a set of devices, without those of other steps.
  struct Gains {
    double value{};        // of the waiting devices at present
    double actions{};      // pickups and drop-offs, if all devices are delivered one by one
    double if_not{};       // if the plan lasts until the end of the episode
    std::int32_t steps{};  // min pickups and drop-offs until all devices are delivered
  };

  PickupPlan PickupPlanOf(std::size_t set, std::size_t device) const {
    return static_cast<PickupPlan>((sets_[set] >> (2 * device)) & 3U);
  }
  std::size_t With(std::size_t set, std::size_t device, PickupPlan pickup) const;
  std::size_t Delivered(std::size_t set) const;

  void Prepare(const Farm& farm);
  void PriceEnergy(const Farm& farm);
  // Returns the cost of the energy of a step with an action of the list.
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
  // Best rewards in one step of any cell.
  struct BestRewards {
    double any{};   // of a step without a pickup or a drop-off
    double risk{};  // of the risk alone
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
  std::vector<std::uint32_t> sets_;        // two bits per device: its Fate
  std::vector<std::int32_t> set_of_bits_;  // inverse of sets_; kNone: more aboard than the capacity
  std::size_t all_gone_{};

  // Data of the current farm and task.
  const Task* task_{};
  RiskSource* risks_{};
  const RiskLayers* layers_of_step_{};
  std::int32_t last_step_{};
  std::vector<float> value_;
  std::vector<DeviceKind> kind_;
  std::vector<const float*> damaging_;  // by device: its layer of damaging risks of this step
  std::vector<float> health_;           // present health of the waiting devices
  std::vector<Gains> gains_;            // by set, with the present health
  std::int32_t first_step_{};           // the farm's present step
  std::vector<double> step_rewards_;    // by step from first_step_ on: sum of the best rewards
  std::vector<double> surcharges_;      // by step: sum by which they fall short of move_reward_
  bool crash_hurts_{};

  // Costs of energy in the reward (farm/energy.h); 0 without energy.
  double idle_cost_{};        // of a step
  double km_cost_{};          // of a kilometre without load in calm water
  double rough_sea_{};        // added to a factor of 1 per unit of (negative) risk
  std::vector<double> load_;  // by set: factor for the devices aboard

  // Data that stay valid for the next plan on the same chart with the same devices.
  Layout chart_;                              // its cells, crash rewards and ports
  std::vector<std::vector<Option>> options_;  // by cell
  float best_crash_{};                        // best reward of a crash on the chart
  std::vector<std::int32_t> site_;            // by device: its cell
  std::size_t planned_devices_{};             // devices of the task
  bool planned_self_propelled_{};             // the task's ship is a device
  std::vector<std::int32_t> moves_;  // by state: min moves until the task's devices are delivered
  double move_reward_{};             // upper bound of the reward of a move
  std::vector<double> rewards_;      // by state: max reward of moves, pickups and drop-offs until
                                     // then; empty with a capacity of 1 and no energy, where it
                                     // follows from moves_
  std::vector<std::pair<std::int32_t, std::size_t>> sources_;  // (moves, cell), for CountMoves
  std::vector<std::size_t> queue_;

  // State of the search.
  std::vector<std::vector<Node>> layers_;
  std::vector<double> values_;       // of the layer that is expanded
  std::vector<double> next_values_;  // of the layer that is reached
  std::vector<Open> open_;           // by state
  std::uint32_t mark_{};             // number of layers so far, of all searches
  double best_{kNever};
  std::size_t best_layer_{};
  std::uint32_t best_parent_{};
  std::uint8_t best_action_{};
};

}  // namespace aquafarm::agents
