// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/node/viz_node.h"

#include <ros/ros.h>

#include <exception>

#include "aquafarm_sim/node_help.h"

int main(int argc, char** argv) {
  constexpr aquafarm_sim::NodeHelp kHelp{"aquafarm_viz", "viz_node",
                                         "Draws a ranch for rviz and as pictures.", "sim.launch"};
  if (aquafarm_sim::PrintHelpIfRequested(argc, argv, kHelp)) return 0;
  ros::init(argc, argv, "viz");
  // Without a node handle in this scope, roscpp would shut down and start again between the handles
  // below. It would lose a Ctrl-C in that time.
  const ros::NodeHandle handle;
  try {
    const auto params = aquafarm_viz::ReadVizParams(ros::NodeHandle("~"));
    const aquafarm_viz::VizNode node(handle, params);
    ros::spin();
  } catch (const std::exception& fault) {
    ROS_FATAL("%s", fault.what());
    return 2;
  }
  return 0;
}
