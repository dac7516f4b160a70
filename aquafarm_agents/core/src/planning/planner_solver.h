// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What Planner keeps to itself: the farm and the task as a graph (planner_solver.cpp) and the
/// search in it (planner_search.cpp).

#include <limits>
#include <vector>

#include "aquafarm/agents/planning/plan.h"

namespace aquafarm::agents {

/// What has become of a device, as far as a plan goes.
enum Fate : std::uint8_t { kWaiting, kPaid, kUnpaid, kGone };
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
  bool triggers{};  // a crash or an illegal action, which replaces the step reward, even if it is 0
};

class PlannerSolver {
 public:
  PlannerSolver(const Scenario& scenario, std::int32_t slots);
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

}  // namespace aquafarm::agents
