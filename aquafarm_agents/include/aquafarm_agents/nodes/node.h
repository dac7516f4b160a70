// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm_agents {

/// Trains a learner on the farms of a sim node. Publishes the progress on the topic `training`,
/// writes a run folder and prints a summary. Private parameters configure the run.
/// @returns an ExitCode
int RunTrainNode();

/// Evaluates a policy on the farms of a sim node, or drives the ships of a running ranch with it.
/// @returns an ExitCode
int RunPolicyNode();

/// Plans the rescue of a ranch's devices. Plans again when a bulletin, the list of devices or of
/// ships, or the state of the ranch changes. A plan without a running ranch is also made again
/// periodically. Publishes the plan, a path for each ship, markers, a chart and a heartbeat. A
/// separate thread makes the plans.
/// @returns an ExitCode
int RunPlanNode();

}  // namespace aquafarm_agents
