// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The decision process of a farm's tabular states as matrices (Eqs. 4, 9 and 11).
///
///   row    a state: the ship's cell and the status of each device; the last row is the end
///   T      [rows, rows], T_ij = Σ_a π(a | i) P(j | i, a), the transition matrix under a policy
///   π      [rows, actions]
///
/// Moves, pickup and drop-off are deterministic, so P(j | i, a) is 0 or 1. Disasters and
/// damage change rewards, not these states; an episode's other ends (disasters over, step limit)
/// are left out, so only delivering every device leads to the last row, which leads to itself.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/agents/learning/exploration.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm::agents {

/// Probabilities of the actions by row (Eq. 9).
using PolicyMatrix = std::vector<std::array<double, kActionCount>>;

/// An entry of a sparse matrix.
struct MatrixEntry {
  std::size_t row{};
  std::size_t column{};
  double value{};
};

/// Every state that a farm can be in, and where each action leads.
class TabularModel {
 public:
  /// @throws InputError unless one ship decides, on a fixed layout with a tabular index
  explicit TabularModel(const Scenario& scenario);

  /// Number of states and the end.
  std::size_t rows() const { return states_.size() + 1; }
  std::size_t end() const { return states_.size(); }
  /// Tabular index of each row but the last.
  const std::vector<std::uint32_t>& states() const { return states_; }
  std::size_t next(std::size_t row, std::size_t action) const { return next_[row][action]; }
  ActionMask legal(std::size_t row) const { return legal_[row]; }

  /// Row of a tabular index. @throws InputError if no episode reaches that state
  std::size_t RowOf(std::uint32_t state) const;

  /// Transition matrix under a policy (Eq. 4), by row. @param policy [rows() - 1] or more
  std::vector<MatrixEntry> Transitions(const PolicyMatrix& policy) const;

  /// V* by value iteration (Eq. 11), [rows()], without a step limit.
  /// @param discount in [0, 1]
  /// @throws InputError where rewards depend on more than the tabular state: disasters, damage
  std::vector<double> OptimalValues(double discount) const;

 private:
  std::string not_finite_;  // why rewards are no function of state and action; empty: they are
  std::vector<std::uint32_t> states_;
  std::vector<std::array<std::size_t, kActionCount>> next_;
  std::vector<std::array<float, kActionCount>> reward_;
  std::vector<ActionMask> legal_;
};

/// Policy matrix of a table of action values: ε-greedy (greedy with ε = 0) or Boltzmann.
/// @param table [states, kActionCount] by tabular index
/// @param level ε, or the temperature in units of reward
/// @param mask_illegal never draws an illegal action
PolicyMatrix MakePolicyMatrix(const TabularModel& model, const std::vector<float>& table,
                              ExplorationKind kind, double level, bool mask_illegal);

/// Writes PREFIX_policy.mtx and PREFIX_transitions.mtx (Matrix Market, 1-based) and
/// PREFIX_states.csv (row, tabular index, V*; the latter empty where it is not defined).
/// @param checkpoint of a table @param policy such as "epsilon_greedy:0.1" or "boltzmann:1"
/// @throws InputError when policy or scenario do not fit; StorageError
void WriteMatrices(const std::string& prefix, const Scenario& scenario,
                   const Checkpoint& checkpoint, const std::string& policy, double discount);

}  // namespace aquafarm::agents
