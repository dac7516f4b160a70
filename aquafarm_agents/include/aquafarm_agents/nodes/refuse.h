// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>

#include "aquafarm/agents/base/exit_code.h"

namespace aquafarm_agents {

/// Prints "node: what" to standard error when a node ends with an error.
/// @returns `code` as the exit code of main
inline int Refuse(const char* node, aquafarm::agents::ExitCode code, const char* what) {
  std::fprintf(stderr, "%s: %s\n", node, what);
  return static_cast<int>(code);
}

}  // namespace aquafarm_agents
