// SPDX-License-Identifier: BSD-3-Clause
#include <ros/init.h>

#include "aquafarm_agents/nodes/node.h"
#include "aquafarm_agents/nodes/signals.h"
#include "aquafarm_sim/node_help.h"

int main(int argc, char** argv) {
  constexpr aquafarm_sim::NodeHelp kHelp{"aquafarm_agents", "policy_node",
                                         "Evaluates a policy, or steers ships with it.",
                                         "evaluate.launch"};
  if (aquafarm_sim::PrintHelpIfRequested(argc, argv, kHelp)) return 0;
  ros::init(argc, argv, "policy", ros::init_options::NoSigintHandler);
  aquafarm_agents::StopOnSignals();
  return aquafarm_agents::RunPolicyNode();
}
