// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Divides the processors of one host among its ranks. A rank that shares no processor with another
/// rank polls while it waits for an exchange (docs/decisions/ranks.md).

#include <sched.h>

namespace aquafarm::agents {

/// Returns the processors of one rank. Each rank gets the same number of processors, and no two
/// ranks share a processor. Returns `all` if there are more ranks than processors.
/// @param all processors of the host
/// @param rank [0, ranks)
/// @param ranks number of ranks on the host
inline cpu_set_t ProcessorsOf(const cpu_set_t& all, int rank, int ranks) {
  const int share = CPU_COUNT(&all) / ranks;
  if (share == 0) return all;
  cpu_set_t own;
  CPU_ZERO(&own);
  int n = 0;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(cpu, &all) && n++ / share == rank) CPU_SET(cpu, &own);
  }
  return own;
}

}  // namespace aquafarm::agents
