// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm_agents {

/// Trains a learner through the services of a ranch. Publishes the progress on `training` and
/// prints a summary. Private parameters configure the run.
/// @returns an ExitCode
int RunTrainNode();

/// Plays a policy through the services of a ranch: evaluates it, or drives ships.
/// @returns an ExitCode
int RunPolicyNode();

/// Plans the rescue of a ranch's devices, and plans again when a bulletin, another input file or
/// the state of the ranch changes. Publishes `plan`, a path for each ship, markers, a chart and a
/// heartbeat. A separate thread makes the plans.
/// @returns an ExitCode
int RunPlanNode();

}  // namespace aquafarm_agents
