// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Starts the ranks of a training as processes of this host.

namespace aquafarm::agents {

/// Starts this program again as `ranks` processes and waits for all of them.
/// @param argv of this program
/// @returns the exit code of the first rank that failed
int RunLocalRanks(int ranks, char** argv);

}  // namespace aquafarm::agents
