// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The ranch as a ROS node: services, topics and diagnostics. Callbacks convert the request, call
/// the FarmServer and convert the result. The FarmServer decides which requests are allowed.

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "aquafarm_sim/bags/episode_recorder.h"
#include "aquafarm_sim/node/farm_diagnostics.h"
#include "aquafarm_sim/node/farm_publisher.h"
#include "aquafarm_sim/node/sim_params.h"
#include "aquafarm_sim/server/farm_server.h"

namespace aquafarm_sim {

class SimNode {
 public:
  /// @param node namespace of the topics and services
  /// @throws InputError if a parameter or the scenario is invalid, or keep_dir cannot be written
  SimNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  ~SimNode();

  /// Waits until a running trainer has saved the farms' state, at most 8 s. A trainer is running if
  /// the last joint step was less than 2 s ago. Services continue meanwhile.
  void LetClientsSave();
  SimNode(const SimNode&) = delete;
  SimNode& operator=(const SimNode&) = delete;

 private:
  void KeepEpisodes();
  void AdvertiseFarm();
  void AdvertiseShip(std::int32_t ship);

  const SimParams params_;
  ros::NodeHandle node_;
  FarmServer ranch_;
  FarmPublisher publisher_;
  std::unique_ptr<EpisodeRecorder> recorder_;  // null if no episodes are kept
  // Commands may wait for other ships, so their services have a separate queue and threads.
  ros::CallbackQueue ship_queue_;
  ros::NodeHandle ship_node_;
  std::vector<ros::ServiceServer> services_;
  std::unique_ptr<FarmDiagnostics> diagnostics_;
  std::unique_ptr<ros::AsyncSpinner> ship_spinner_;
  std::thread pacer_;
};

/// Runs the node until ROS shuts down or SIGINT or SIGTERM arrives.
/// @returns the exit code: 0 without an error, 2 for an InputError of SimNode, 1 for other errors
int RunSimNode();

}  // namespace aquafarm_sim
