// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>

namespace aquafarm::agents {

/// Returns whether a signal handler or another thread has set `stop`, which may be null.
inline bool IsStopped(const std::atomic<bool>* stop) { return stop != nullptr && *stop; }

}  // namespace aquafarm::agents
