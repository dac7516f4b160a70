// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/node/viz_node.h"

#include <ros/ros.h>

#include <exception>

int main(int argc, char** argv) {
  ros::init(argc, argv, "viz");
  try {
    const auto params = aquafarm_viz::ReadVizParams(ros::NodeHandle("~"));
    const aquafarm_viz::VizNode node(ros::NodeHandle(), params);
    ros::spin();
  } catch (const std::exception& fault) {
    ROS_FATAL("%s", fault.what());
    return 2;
  }
  return 0;
}
