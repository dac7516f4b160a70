// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdio>
#include <string_view>

namespace aquafarm_sim {

/// Content of the help text of a node.
struct NodeHelp {
  const char* package{};
  const char* node{};     ///< name of the program
  const char* summary{};  ///< what the node does, in a sentence
  const char* launch{};   ///< file of aquafarm_bringup that starts the node; null if there is none
};

/// Prints the help of a node to stdout if `-h` or `--help` is among the arguments. main must call
/// this function before ros::init, because the help must also work without ROS_MASTER_URI.
/// @returns true if the help was printed; main must then return 0
inline bool PrintHelpIfRequested(int argc, char** argv, const NodeHelp& help) {
  const auto is_help_option = [](std::string_view word) {
    return word == "-h" || word == "--help";
  };
  if (std::none_of(argv + 1, argv + std::max(1, argc), is_help_option)) return false;
  std::printf("usage: rosrun %s %s [_PARAMETER:=VALUE ...] [TOPIC:=OTHER ...]\n\n%s\n\n",
              help.package, help.node, help.summary);
  if (help.launch != nullptr) {
    std::printf(
        "%s of aquafarm_bringup starts it; 'roslaunch --ros-args aquafarm_bringup %s'\nlists "
        "the arguments.\n",
        help.launch, help.launch);
  }
  std::printf(
      "docs/ros_api.md lists the node's parameters; so does the error message for an unknown "
      "parameter.\n");
  return true;
}

}  // namespace aquafarm_sim
