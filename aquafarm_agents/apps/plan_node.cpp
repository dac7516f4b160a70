// SPDX-License-Identifier: BSD-3-Clause
#include <ros/init.h>

#include "aquafarm_agents/nodes/node.h"
#include "aquafarm_sim/node_help.h"

int main(int argc, char** argv) {
  constexpr aquafarm_sim::NodeHelp kHelp{
      "aquafarm_agents", "plan_node",
      "Plans the rescue of a ranch's devices again at every bulletin.", "plan.launch"};
  if (aquafarm_sim::PrintHelpIfRequested(argc, argv, kHelp)) return 0;
  ros::init(argc, argv, "plan");
  return aquafarm_agents::RunPlanNode();
}
