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
  /// @throws InputError if a parameter or the scenario is invalid
  SimNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  ~SimNode();

  /// Keeps serving for a limited time if a trainer is running, until the trainer has saved.
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
  // Commands may wait for other ships. They run on separate threads and block no other call.
  ros::CallbackQueue ship_queue_;
  ros::NodeHandle ship_node_;
  std::vector<ros::ServiceServer> services_;
  std::unique_ptr<FarmDiagnostics> diagnostics_;
  std::unique_ptr<ros::AsyncSpinner> ship_spinner_;
  std::thread pacer_;
};

/// Runs the node until ROS shuts down. @return the exit code: 0, or 2 if the input was refused
int RunSimNode();

}  // namespace aquafarm_sim
