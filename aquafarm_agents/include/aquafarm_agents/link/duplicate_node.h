// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm_agents {

/// Refuses to be a second node of the same name: ROS would end the first, which drives its ship.
/// To be called after ros::init and before the first NodeHandle. A name that the master remembers
/// of a node that is dead is free; whoever listens where that node did is taken for it. Of two that
/// start at the same moment both may pass, and ROS ends one.
/// @throws InputError "node /aquafarm/agent_0 runs already, at http://boat:41234/: …"
void RefuseTwin();

}  // namespace aquafarm_agents
