// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The private parameters of sim_node: they name the scenario, rates and frames, never a number of
/// the farm. Every parameter is used or refused.

#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "aquafarm_sim/names.h"
#include "aquafarm_sim/server/farm_server.h"

namespace aquafarm_sim {

struct SimParams {
  std::string scenario{"paper"};  ///< a shipped scenario's name, or a path
  /// ~farms, ~threads, ~seed (-1: from the wall clock), ~pace, ~rate_hz, ~barrier_timeout_s,
  /// ~late_ships_hold, ~claim_timeout_s
  RanchOptions ranch;
  double publish_hz{10.0};           ///< most states a second for people; 0: none
  bool record{};                     ///< publish every step of farm 0
  std::string keep{"none"};          ///< which episodes become bags: ParseKeep
  std::string keep_dir{"episodes"};  ///< folder of those bags
  double recorder_wait_s{};          ///< most seconds to wait at the start for someone who records
  bool publish_clock{true};          ///< false where another node owns /clock
  std::string map_frame{names::kMapFrame};
  std::string earth_frame{names::kEarthFrame};
  std::string frame_prefix;  ///< put before ship_<id> and disaster_<id>
};

/// @throws InputError "~rate_hz: got -1, expected [0.001, 1000]"; an unknown parameter is answered
///         with those there are
SimParams ReadSimParams(const ros::NodeHandle& private_node);

/// Names of the scenarios in a folder, sorted.
std::vector<std::string> ShippedScenarios(const std::string& folder);

/// Path of a scenario file, from a path (with a slash or .yaml) or a shipped one's name.
/// @throws InputError with the shipped names when there is no such file
std::string ResolveScenario(const std::string& scenario, const std::string& folder);

/// The folder of the shipped scenarios, in a source or an installed package.
std::string ScenarioFolder();

}  // namespace aquafarm_sim
