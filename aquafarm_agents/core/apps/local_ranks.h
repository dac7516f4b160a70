// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Starts the ranks of a training as processes of this host.

namespace aquafarm::agents {

/// Starts this program `ranks` times, with the same arguments, and waits until all processes end.
/// @param argv arguments of this program
/// @returns the exit code of the first rank that failed; 0 if no rank failed
/// @throws InputError if there is no free TCP port
int RunLocalRanks(int ranks, char** argv);

}  // namespace aquafarm::agents
