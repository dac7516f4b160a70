// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The decision process of a farm's tabular states as matrices (Eqs. 4, 9 and 11 of the paper).
///
///   row    a state: the ship's cell and the status of each device. The last row is the end of the
///          episode
///   T      [rows, rows], T_ij = Σ_a π(a | i) P(j | i, a), the transition matrix under a policy
///   π      [rows − 1, actions], probability of each action
///
/// Moves, pickup and drop-off are deterministic, so P(j | i, a) is 0 or 1. Disasters and damage
/// change rewards, but not these states. In the model, an episode ends neither at a step limit nor
/// with the disasters. From a state, only the delivery of the last device therefore leads to the
/// last row. From the last row, every action leads to the last row.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/agents/learning/exploration.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm::agents {

/// Probability of each action, by row (Eq. 9).
using PolicyMatrix = std::vector<std::array<double, kActionCount>>;

/// An entry of a sparse matrix.
struct MatrixEntry {
  std::size_t row{};
  std::size_t column{};
  double value{};
};

/// The states that a ship can reach from the start of an episode, and the row to which each action
/// leads.
class TabularModel {
 public:
  /// @throws InputError unless the scenario has one ship, no other agent, a fixed layout and few
  ///   enough states for a table
  explicit TabularModel(const Scenario& scenario);

  /// Returns the number of rows: one for each state, and one for the end of the episode.
  std::size_t rows() const { return states_.size() + 1; }
  /// Returns the row of the end of the episode.
  std::size_t end() const { return states_.size(); }
  /// Returns the tabular index of each row except the last, [rows() - 1].
  const std::vector<std::uint32_t>& states() const { return states_; }
  /// Returns the row to which an action leads. @param row [0, end())
  std::size_t next(std::size_t row, std::size_t action) const { return next_[row][action]; }
  /// Returns the legal actions of a state. @param row [0, end())
  ActionMask legal(std::size_t row) const { return legal_[row]; }

  /// Returns the row of a tabular index. @throws InputError if no episode reaches that state
  std::size_t RowOf(std::uint32_t state) const;

  /// Returns the entries of the transition matrix T under a policy (Eq. 4), by row.
  /// @param policy [rows() - 1] or more
  std::vector<MatrixEntry> Transitions(const PolicyMatrix& policy) const;

  /// Returns V* by value iteration (Eq. 11), [rows()], without a step limit.
  /// @param discount in [0, 1]
  /// @throws InputError if the iteration does not converge, or if rewards depend on more than the
  ///   tabular state: with disasters, crash damage, or damage by the risk of the sea
  std::vector<double> OptimalValues(double discount) const;

 private:
  std::string not_finite_;  // why rewards do not depend on state and action alone; empty if they do
  std::vector<std::uint32_t> states_;
  std::vector<std::array<std::size_t, kActionCount>> next_;
  std::vector<std::array<float, kActionCount>> reward_;
  std::vector<ActionMask> legal_;
};

/// Returns the policy matrix of a table of action values: Boltzmann, or ε-greedy (greedy if ε = 0).
/// @param table [states, kActionCount] by tabular index
/// @param level ε, or the temperature in units of reward
/// @param mask_illegal whether illegal actions have probability 0
PolicyMatrix MakePolicyMatrix(const TabularModel& model, const std::vector<float>& table,
                              ExplorationKind kind, double level, bool mask_illegal);

/// Writes PREFIX_policy.mtx and PREFIX_transitions.mtx (Matrix Market, 1-based) and
/// PREFIX_states.csv (row, tabular index, V*). The column of V* is empty if OptimalValues does not
/// support the scenario.
/// @param checkpoint checkpoint of a tabular learner
/// @param policy such as "epsilon_greedy:0.1" or "boltzmann:1"
/// @param discount discount of V*
/// @throws InputError if the checkpoint, the policy or the scenario is not supported, or if
///   OptimalValues does not converge
/// @throws StorageError if a file cannot be written
void WriteMatrices(const std::string& prefix, const Scenario& scenario,
                   const Checkpoint& checkpoint, const std::string& policy, double discount);

}  // namespace aquafarm::agents
