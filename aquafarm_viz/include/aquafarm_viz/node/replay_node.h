// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The node that replays a bag. Clients control it with services. `pause` pauses or resumes the
/// replay, or shows a number of steps immediately and then pauses. `set_pace` sets the speed, and
/// `jump` shows a given step. rosbag play cannot jump, and it steps by messages, not by steps of
/// the ranch.

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
  double speed{1.0};      ///< speed relative to the recording, [0.001, 1000]
  double start_s{};       ///< start position in the bag [s]; 0: uses start_episode, start_step
  int start_episode{-1};  ///< episode to start with; -1: the first one of the bag
  int start_step{};       ///< step of that episode to start with
  double delay_s{1.0};    ///< wall time before the start [s], so that other nodes can start
  bool paused{};          ///< true: starts paused
  bool loop{};            ///< true: restarts at the first step when the bag ends
  bool keep_alive{};      ///< true: keeps running when the bag ends; false: shuts down
};

/// Reads the parameters.
/// @throws InputError if `bag` is missing, a value is not allowed, or a parameter is unknown
ReplayParams ReadReplayParams(const ros::NodeHandle& node);

/// Publishes /clock and the messages of a bag, except drawings (markers, paths and images). Offers
/// the services `pause`, `set_pace` and `jump`.
class ReplayNode {
 public:
  /// @param node namespace of the services and of topics without a leading slash
  /// @throws std::runtime_error if the bag cannot be shown, see ReplayTape
  ReplayNode(const ros::NodeHandle& node, const ReplayParams& params);

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
  std::size_t next_{};    // index of the next message to publish
  ros::Time now_;         // current bag time
  ros::WallTime ticked_;  // time of the last tick; at first, the time at which the replay starts
  std::map<std::string, ros::Publisher> topics_;
  ros::Publisher clock_;
  ros::ServiceServer pause_;
  ros::ServiceServer set_pace_;
  ros::ServiceServer jump_;
  ros::WallTimer timer_;
};

}  // namespace aquafarm_viz
