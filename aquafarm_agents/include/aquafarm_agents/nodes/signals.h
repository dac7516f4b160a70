// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <csignal>

namespace aquafarm_agents {

/// True after SIGINT or SIGTERM, for example from Ctrl-C or roslaunch.
inline std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // set in a signal handler

/// Installs signal handlers that set stop_requested. Call it after ros::init with NoSigintHandler.
inline void StopOnSignals() {
  const auto handler = [](int) { stop_requested = true; };
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
}

}  // namespace aquafarm_agents
