// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm_agents {

/// Trains through the services of a ranch, configured by private parameters. Publishes the progress
/// on `training` and prints a summary.
/// @returns an ExitCode
int RunTrainNode();

/// Plays a saved policy through the services of a ranch: evaluates it, or drives ships.
/// @returns an ExitCode
int RunPolicyNode();

}  // namespace aquafarm_agents
