// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm_agents {

/// Checks that no node with the name of this one is running: ROS would shut down the running node,
/// which may be driving a ship. Must be called after ros::init and before the first NodeHandle. The
/// registration of a dead node is ignored unless another process listens on its port. Two nodes
/// that start at the same time may both pass the check; ROS then shuts down one of them.
/// @throws InputError "node /aquafarm/agent_0 is already running at http://boat:41234/; …"
void RefuseTwin();

}  // namespace aquafarm_agents
