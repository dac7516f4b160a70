// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/node/sim_node.h"

#include <ros/init.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "sim", ros::init_options::NoSigintHandler);
  return aquafarm_sim::RunSimNode();
}
