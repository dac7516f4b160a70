// SPDX-License-Identifier: BSD-3-Clause
#include <ros/init.h>

#include "aquafarm_agents/nodes/node.h"
#include "aquafarm_agents/nodes/signals.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "policy", ros::init_options::NoSigintHandler);
  aquafarm_agents::StopOnSignals();
  return aquafarm_agents::RunPolicyNode();
}
