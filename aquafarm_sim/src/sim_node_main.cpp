// SPDX-License-Identifier: BSD-3-Clause
#include <ros/init.h>

#include "aquafarm_sim/sim_node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "sim", ros::init_options::NoSigintHandler);
  return aquafarm_sim::RunSimNode();
}
