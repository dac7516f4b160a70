// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Implementation of Planner: the farm and the task as a graph (planner_solver.cpp) and the search
/// in it (planner_search.cpp).

#include <limits>
#include <vector>

#include "aquafarm/agents/planning/plan.h"

namespace aquafarm::agents {

/// Status of a device in a plan.
enum Fate : std::uint8_t { kWaiting, kPaid, kUnpaid, kGone };
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
  std::uint8_t action{};
  bool triggers{};  // a crash or an illegal action, which replaces the step reward, even if it is 0
};

class PlannerSolver {
 public:
  PlannerSolver(const Scenario& scenario, std::int32_t slots);
  Plan Solve(const Farm& farm, Foresight foresight, const Task& task);
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
    std::uint32_t mark{};  // layer in which it was reached, plus 1
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
  std::vector<std::uint32_t> sets_;        // two bits per device: its Fate
  std::vector<std::int32_t> set_of_bits_;  // inverse of sets_; kNone: more aboard than the capacity
  std::size_t all_gone_{};

  // Data of the current farm and task.
  const Task* task_{};
  const Layout* layout_{};
  std::vector<std::vector<Option>> options_;  // by cell
  std::vector<std::int32_t> site_;            // by device: its cell
  std::vector<float> value_;
  std::vector<float> health_;  // present health of the waiting devices
  std::vector<double> bound_;  // by state: max further return without disasters
  std::vector<Disaster> disasters_;
  std::vector<Track> tracks_;  // assumed tracks of the disasters
  Grid<float> risk_;
  bool crash_hurts_{};

  // State of the search.
  std::vector<std::vector<Node>> layers_;
  std::vector<double> values_;       // of the layer that is expanded
  std::vector<double> next_values_;  // of the layer that is reached
  std::vector<Open> open_;           // by state
  double best_{kNever};
  std::size_t best_layer_{};
  std::uint32_t best_parent_{};
  std::uint8_t best_action_{};
};

}  // namespace aquafarm::agents
