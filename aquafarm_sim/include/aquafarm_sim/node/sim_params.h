// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The private parameters of sim_node, such as the scenario, rates and frames. Sizes, rewards and
/// rules of the farm are only in the scenario file. An unknown parameter is an error.

#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "aquafarm_sim/names.h"
#include "aquafarm_sim/server/farm_server.h"

namespace aquafarm_sim {

struct SimParams {
  std::string scenario{"paper"};  ///< name of a shipped scenario, or a path
  /// ~farms, ~threads, ~seed (-1: from the wall clock), ~pace, ~rate_hz, ~barrier_timeout_s,
  /// ~late_ships_hold, ~claim_timeout_s
  ServerOptions ranch;
  /// Max rate at which states are published if `record` is false [states per second of wall time].
  /// 0: neither states nor the topics that are sent with them (farm_publisher.h) are published.
  double publish_hz{10.0};
  bool record{};                     ///< publish the state after every change of farm 0
  std::string keep{"none"};          ///< episodes to write as bags, in the syntax of ParseKeep
  std::string keep_dir{"episodes"};  ///< folder of these bags
  double recorder_wait_s{};          ///< max time to wait for a recorder at the start; 0: no wait
  bool publish_clock{true};          ///< false if another node publishes /clock
  std::string map_frame{names::kMapFrame};
  std::string earth_frame{names::kEarthFrame};
  std::string frame_prefix;  ///< prefix of the frames ship_<id> and disaster_<id>
};

/// Reads the parameters. Checks their types, their ranges and the value of pace. SimNode checks
/// scenario, keep and keep_dir.
/// @throws InputError "~rate_hz: got -1, expected [0.001, 1000]"; for an unknown parameter the
///         message lists the known ones
SimParams ReadSimParams(const ros::NodeHandle& private_node);

/// Returns the names of the scenarios in a folder, sorted; empty if the folder cannot be read.
std::vector<std::string> ShippedScenarios(const std::string& folder);

/// Returns the path of a scenario file.
/// @param scenario a path (contains a slash or ends in .yaml), or the name of a shipped scenario
/// @param folder folder of the shipped scenarios
/// @throws InputError if the file does not exist; the message lists the shipped names
std::string ResolveScenario(const std::string& scenario, const std::string& folder);

/// Returns the folder of the shipped scenarios, in the source tree or in the installed package.
std::string ScenarioFolder();

}  // namespace aquafarm_sim
