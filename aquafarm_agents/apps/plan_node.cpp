// SPDX-License-Identifier: BSD-3-Clause
#include <ros/init.h>

#include "aquafarm_agents/nodes/node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "plan");
  return aquafarm_agents::RunPlanNode();
}
