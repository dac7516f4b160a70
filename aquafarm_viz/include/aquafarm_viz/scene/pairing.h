// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Brings specs and states together: they come over different connections, in any order.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <cstddef>
#include <deque>
#include <string>

namespace aquafarm_viz {

/// A state and the spec of its episode; both null when there is nothing to show.
struct Shown {
  aquafarm_msgs::FarmSpecConstPtr spec;
  aquafarm_msgs::FarmStateConstPtr state;
};

/// Remembers the last specs and the last state, and gives out the newest pair that fits.
class Pairing {
 public:
  static constexpr std::size_t kSpecs = 16;  ///< specs remembered

  /// Takes a spec in; returns why it is refused, or nothing.
  std::string AddSpec(const aquafarm_msgs::FarmSpecConstPtr& spec);

  /// Takes a state in; returns why it is refused, or nothing.
  std::string AddState(const aquafarm_msgs::FarmStateConstPtr& state);

  /// The newest state whose spec is known.
  const Shown& shown() const { return shown_; }

  /// Says in one line that the newest state waits for its spec; empty when it does not.
  std::string Waiting() const;

 private:
  void Pair();

  std::deque<aquafarm_msgs::FarmSpecConstPtr> specs_;  // oldest first
  aquafarm_msgs::FarmStateConstPtr newest_;
  Shown shown_;
};

}  // namespace aquafarm_viz
