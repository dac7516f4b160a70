// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include "aquafarm_sim/bags/episode_recorder.h"
#include "aquafarm_sim/node/farm_publisher.h"
#include "aquafarm_sim/server/farm_server.h"

namespace aquafarm_sim {

/// Publishes the status and the counters of a farm server to /diagnostics every second.
class FarmDiagnostics {
 public:
  /// Server, publisher and recorder must outlive this object.
  /// @param recorder null if no episodes are kept
  FarmDiagnostics(ros::NodeHandle& node, const ros::NodeHandle& private_node, FarmServer& server,
                  const FarmPublisher& publisher, const EpisodeRecorder* recorder);
  FarmDiagnostics(const FarmDiagnostics&) = delete;
  FarmDiagnostics& operator=(const FarmDiagnostics&) = delete;

 private:
  void Fill(diagnostic_updater::DiagnosticStatusWrapper& status);

  FarmServer& server_;
  const FarmPublisher& publisher_;
  const EpisodeRecorder* const recorder_;
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
  ros::WallTime seen_at_;  // time of the last report
  ServerCounters seen_;    // at that time
};

}  // namespace aquafarm_sim
