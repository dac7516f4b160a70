// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Matches states with the specs of their episodes. States and specs arrive in any order, because
/// their topics have separate connections.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <cstddef>
#include <deque>
#include <string>

namespace aquafarm_viz {

/// A state and the spec of its episode; both are null if there is nothing to show.
struct Shown {
  aquafarm_msgs::FarmSpecConstPtr spec;
  aquafarm_msgs::FarmStateConstPtr state;
};

/// Stores the last specs and the last state, and returns the newest matching pair.
class Pairing {
 public:
  static constexpr std::size_t kSpecs = 16;  ///< max number of stored specs

  /// Adds a spec. Returns an empty text, or the reason if CheckSpec refuses the spec.
  std::string AddSpec(const aquafarm_msgs::FarmSpecConstPtr& spec);

  /// Adds a state. Returns an empty text, or the reason if CheckState refuses the state.
  std::string AddState(const aquafarm_msgs::FarmStateConstPtr& state);

  /// Returns the newest state whose spec was added, with that spec.
  const Shown& shown() const { return shown_; }

  /// Returns a line about the missing spec of the newest state; empty if no spec is missing.
  std::string Waiting() const;

 private:
  void Pair();

  std::deque<aquafarm_msgs::FarmSpecConstPtr> specs_;  // oldest first
  aquafarm_msgs::FarmStateConstPtr newest_;
  Shown shown_;
};

}  // namespace aquafarm_viz
