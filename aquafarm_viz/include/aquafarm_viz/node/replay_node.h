// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Plays a bag with the services that a running ranch has: `pause` (and so many steps), `set_pace`,
/// and `jump` to a step. rosbag play cannot jump, and knows no steps.

#include <aquafarm_msgs/Jump.h>
#include <aquafarm_msgs/Pause.h>
#include <aquafarm_msgs/SetPace.h>
#include <ros/ros.h>

#include <map>
#include <string>

#include "aquafarm_viz/replay/replay.h"

namespace aquafarm_viz {

/// The parameters of the node, from its private namespace.
struct ReplayParams {
  std::string bag;
  double speed{1.0};      ///< as fast as recorded times this, (0, 1000]
  double start_s{};       ///< seconds into the bag
  int start_episode{-1};  ///< -1: the first
  int start_step{};       ///< of that episode
  double delay_s{1.0};    ///< wall time before it begins, for others to come up
  bool paused{};          ///< begins paused
  bool loop{};            ///< begins anew at its end
  bool keep_alive{};      ///< leaves the last picture until it is ended
};

/// @throws std::invalid_argument naming the parameter, what it is and what is allowed
ReplayParams ReadReplayParams(const ros::NodeHandle& node);

class ReplayNode {
 public:
  /// @param node namespace of the services and of topics without a leading slash
  /// @throws std::runtime_error when the bag cannot be shown
  ReplayNode(ros::NodeHandle node, const ReplayParams& params);

  const ReplayTape& tape() const { return tape_; }

 private:
  void Begin();
  void Tick();
  void Publish(std::size_t position);
  void PublishClock();
  bool IsAtEnd() const { return next_ >= tape_.messages().size(); }
  void JumpTo(const ReplayTape::Step& step);
  void GoOn(std::uint32_t steps);
  bool OnPause(aquafarm_msgs::Pause::Request& request, aquafarm_msgs::Pause::Response& response);
  bool OnSetPace(aquafarm_msgs::SetPace::Request& request,
                 aquafarm_msgs::SetPace::Response& response);
  bool OnJump(aquafarm_msgs::Jump::Request& request, aquafarm_msgs::Jump::Response& response);

  ros::NodeHandle node_;
  const ReplayParams params_;
  const ReplayTape tape_;
  double speed_;
  bool paused_;
  bool begun_{};
  std::size_t next_{};  // message to publish
  ros::Time now_;       // of the bag
  ros::WallTime ticked_;
  std::map<std::string, ros::Publisher> topics_;
  ros::Publisher clock_;
  ros::ServiceServer pause_;
  ros::ServiceServer set_pace_;
  ros::ServiceServer jump_;
  ros::WallTimer timer_;
};

}  // namespace aquafarm_viz
