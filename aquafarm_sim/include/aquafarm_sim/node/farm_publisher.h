// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Publishes the topics of a ranch:
///   - state, risk (if it has subscribers), tf and clock: at a limited wall rate, or with
///     SimParams::record after every change
///   - spec, chart, sea layers and tf_static (if the map has an origin): with the first published
///     state of an episode
///   - observations that have subscribers: after every change, but after joint steps only together
///     with the state
///   - the summary of each ended episode
/// A change is a call of OnChange. Usually OnChange only sets a flag, and a separate thread
/// publishes. The observations are published in OnChange itself, except after joint steps. With
/// SimParams::record, OnChange publishes all topics except the summaries.

#include <aquafarm_msgs/EpisodeSummary.h>
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <nav_msgs/OccupancyGrid.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <rosgraph_msgs/Clock.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "aquafarm/base/mutex.h"
#include "aquafarm_sim/node/sent_messages.h"
#include "aquafarm_sim/node/sim_params.h"
#include "aquafarm_sim/server/farm_server.h"

namespace aquafarm_sim {

/// The listener of a FarmServer that publishes its state.
class FarmPublisher : public FarmListener {
 public:
  /// @param ranch must outlive the publisher, which sets itself as the listener of the ranch
  FarmPublisher(const ros::NodeHandle& node, const SimParams& params, FarmServer& ranch);
  ~FarmPublisher() override;
  FarmPublisher(const FarmPublisher&) = delete;
  FarmPublisher& operator=(const FarmPublisher&) = delete;

  /// Waits for a recorder. It is ready if `episode` and `state` have subscribers and the number of
  /// subscribers (CountSubscribers) has not changed for half a second. Usually only recorders
  /// subscribe to `episode`.
  /// @returns false if no recorder is ready after `limit_s`, or if ROS shuts down
  bool WaitForRecorder(double limit_s);

  void OnChange(const ServerView& view) override;
  void OnEpisodeEnd(const aquafarm_msgs::EpisodeSummary& summary) override;
  /// Logs which ships are absent or back. Diagnostics report the absent ships periodically.
  void OnPresence(const std::vector<std::int32_t>& ships, bool is_present) override;

  /// Number of episode summaries that were dropped because the queue was full.
  std::uint64_t dropped_summaries() const { return dropped_summaries_; }

 private:
  /// A topic that is not latched, but sends its last message to each new subscriber.
  template <typename Message>
  struct Topic {
    ros::Publisher publisher;
    Message message;
    bool valid{};  // true: `message` was sent with the last published state
  };

  template <typename Message>
  void Advertise(ros::NodeHandle& node, const std::string& name, Topic<Message>& topic);
  std::uint32_t CountSubscribers() const;
  void Fill(const ServerView& view) AQUAFARM_REQUIRES(message_mutex_);
  void PublishObservations(const ServerView& view);
  const aquafarm_msgs::FarmState& ObservationOf(const ServerView& view, std::int32_t ship)
      AQUAFARM_REQUIRES(observation_mutex_);
  void FillEpisode(const ServerView& view) AQUAFARM_REQUIRES(message_mutex_);
  void FillFrames(const ServerView& view) AQUAFARM_REQUIRES(message_mutex_);
  void Send() AQUAFARM_REQUIRES(message_mutex_);
  void SendSeas() AQUAFARM_REQUIRES(message_mutex_);
  void Wake();
  void Run();

  const SimParams params_;
  FarmServer& ranch_;
  SentMessages sent_;
  tf2_ros::TransformBroadcaster frames_;
  tf2_ros::StaticTransformBroadcaster static_frames_;
  Topic<rosgraph_msgs::Clock> clock_;
  ros::Publisher spec_;
  ros::Publisher chart_;
  struct Sea {
    ros::Publisher grid;
    ros::Publisher values;
  };
  std::vector<Sea> seas_;  // by layer
  ros::Publisher episode_;
  Topic<aquafarm_msgs::FarmState> state_;
  Topic<nav_msgs::OccupancyGrid> risk_;

  aquafarm::Mutex message_mutex_;  // also guards the messages of the topics above
  std::uint64_t published_episode_ AQUAFARM_GUARDED_BY(message_mutex_){};
  bool episode_is_new_ AQUAFARM_GUARDED_BY(message_mutex_){};
  // With SimParams::record, the earliest time of the next state. If states followed each other
  // faster, rosbag could drop messages.
  std::chrono::steady_clock::time_point next_record_ AQUAFARM_GUARDED_BY(message_mutex_);
  MessageContext context_ AQUAFARM_GUARDED_BY(message_mutex_);
  aquafarm_msgs::FarmSpec spec_message_ AQUAFARM_GUARDED_BY(message_mutex_);
  nav_msgs::OccupancyGrid chart_message_ AQUAFARM_GUARDED_BY(message_mutex_);
  std::vector<aquafarm::Disaster> disasters_ AQUAFARM_GUARDED_BY(message_mutex_);
  std::vector<geometry_msgs::TransformStamped> frame_messages_ AQUAFARM_GUARDED_BY(message_mutex_);
  // Bearing of each ship's last published move [degrees]; 0 before the ship's first move in an
  // episode.
  std::vector<std::int32_t> bearings_ AQUAFARM_GUARDED_BY(message_mutex_);

  aquafarm::Mutex observation_mutex_;  // also guards the messages of the observations
  struct Observation {
    ros::Publisher publisher;
    aquafarm_msgs::FarmState message;  // its memory is reused
  };
  std::vector<Observation> observations_;
  aquafarm::View view_ AQUAFARM_GUARDED_BY(observation_mutex_);  // scratch

  aquafarm::Mutex queue_mutex_;  // no other mutex is locked while this one is locked
  std::condition_variable wake_;
  std::deque<aquafarm_msgs::EpisodeSummary> summaries_ AQUAFARM_GUARDED_BY(queue_mutex_);
  std::atomic<bool> dirty_{};
  std::atomic<bool> idle_{};
  std::atomic<std::uint64_t> dropped_summaries_{};
  bool ending_ AQUAFARM_GUARDED_BY(queue_mutex_){};
  std::thread thread_;
};

}  // namespace aquafarm_sim
