// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm_agents {

/// Rejects a second node of the same name: ROS would shut down the first one, which drives its
/// ship. Must be called after ros::init and before the first NodeHandle. A stale registration of a
/// dead node is ignored unless a process answers on its port. Two nodes that start at the same time
/// may both pass; ROS then shuts down one of them.
/// @throws InputError "node /aquafarm/agent_0 is already running at http://boat:41234/: …"
void RefuseTwin();

}  // namespace aquafarm_agents
