// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/node/replay_node.h"

#include <cstdio>
#include <exception>
#include <string>

#include "aquafarm/base/version.h"
#include "aquafarm_sim/node_help.h"

int main(int argc, char** argv) {
  constexpr aquafarm_sim::NodeHelp kHelp{"aquafarm_viz", "replay_node", "Plays a recorded bag.",
                                         "replay.launch"};
  if (aquafarm_sim::PrintHelpIfRequested(argc, argv, kHelp)) return 0;
  ros::init(argc, argv, "replay");
  // Without a node handle in this scope, roscpp would shut down and start again between the handles
  // below. It would lose a Ctrl-C in that time.
  const ros::NodeHandle handle;
  try {
    const auto params = aquafarm_viz::ReadReplayParams(ros::NodeHandle("~"));
    const aquafarm_viz::ReplayNode node(handle, params);
    for (const std::string& note : node.tape().Notes(aquafarm::kVersion)) {
      std::fprintf(stderr, "replay: %s: %s\n", params.bag.c_str(), note.c_str());
    }
    ros::spin();
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "replay: %s\n", fault.what());
    return 2;
  }
  return 0;
}
