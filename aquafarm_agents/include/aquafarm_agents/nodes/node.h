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

/// Plans the rescue of a ranch's devices again at every bulletin and every change of the ranch, in
/// a thread of its own. Publishes `plan`, a path for each ship, markers and a chart.
/// @returns an ExitCode
int RunPlanNode();

}  // namespace aquafarm_agents
