// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Processors of the ranks of one host. A rank with processors of its own polls while it waits for
/// another (docs/decisions/ranks.md).

#include <sched.h>

namespace aquafarm::agents {

/// Returns the processors of rank `rank`: a share of `all`, disjoint from those of the other ranks
/// and of equal size, as mpirun and srun assign them. Returns `all` if the ranks outnumber them.
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
