// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm_agents {

/// Trains through a ranch's services as the private parameters say, publishes how it goes on
/// `training`, prints a summary.
/// @returns an ExitCode
int RunTrainNode();

/// Lets a saved policy play through a ranch's services: evaluates it, or drives ships.
/// @returns an ExitCode
int RunPolicyNode();

}  // namespace aquafarm_agents
