// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/node/sim_node.h"

#include <ros/init.h>

#include "aquafarm_sim/node_help.h"

int main(int argc, char** argv) {
  constexpr aquafarm_sim::NodeHelp kHelp{
      "aquafarm_sim", "sim_node", "Simulates the farms of a scenario behind services and topics.",
      "sim.launch"};
  if (aquafarm_sim::PrintHelpIfRequested(argc, argv, kHelp)) return 0;
  ros::init(argc, argv, "sim", ros::init_options::NoSigintHandler);
  return aquafarm_sim::RunSimNode();
}
