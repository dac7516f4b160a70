// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <exception>

#include "aquafarm_viz/replay_node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "replay");
  try {
    const aquafarm_viz::ReplayNode node(ros::NodeHandle(),
                                        aquafarm_viz::ReadReplayParams(ros::NodeHandle("~")));
    ros::spin();
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "replay: %s\n", fault.what());
    return 2;
  }
  return 0;
}
