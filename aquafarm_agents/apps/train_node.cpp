// SPDX-License-Identifier: BSD-3-Clause
#include <ros/init.h>

#include "aquafarm_agents/nodes/node.h"
#include "aquafarm_agents/nodes/signals.h"
#include "aquafarm_sim/node_help.h"

int main(int argc, char** argv) {
  constexpr aquafarm_sim::NodeHelp kHelp{
      "aquafarm_agents", "train_node",
      "Trains a learner on the farms of a running sim_node and writes a run folder.",
      "train.launch"};
  if (aquafarm_sim::PrintHelpIfRequested(argc, argv, kHelp)) return 0;
  ros::init(argc, argv, "train", ros::init_options::NoSigintHandler);
  aquafarm_agents::StopOnSignals();
  return aquafarm_agents::RunTrainNode();
}
