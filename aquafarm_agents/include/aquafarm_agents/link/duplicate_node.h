// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm_agents {

/// Checks that no other node with the name of this node is running. Without the check, ROS would
/// shut down the other node, which may be driving a ship. Must be called after ros::init and before
/// the first NodeHandle.
///
/// A registered node counts as running if a process accepts connections on its port within 2 s. Two
/// nodes that start at the same time may both pass the check. ROS then shuts down one of them.
/// @throws InputError "node /aquafarm/agent_0 is already running at http://boat:41234/; …"
void RefuseTwin();

}  // namespace aquafarm_agents
