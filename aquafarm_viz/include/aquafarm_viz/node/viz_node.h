// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The visualisation node: subscribes to spec and state, publishes markers and images.

#include <aquafarm_msgs/TrainingStatus.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm_viz/draw/image.h"
#include "aquafarm_viz/markers/danger.h"
#include "aquafarm_viz/scene/pairing.h"

namespace aquafarm_viz {

/// The parameters of the node, from its private namespace.
struct VizParams {
  double rate_hz{20.0};              ///< max drawings per second of wall time, [0.1, 1000]
  ImageSize image;                   ///< [pixels], each side in [kMinImageSide, kMaxImageSide]
  Layers layers;                     ///< layers of the pictures and markers
  const Style* style{&DarkStyle()};  ///< colours of the pictures
};

/// Reads the parameters.
/// @throws InputError if a parameter is out of range, has another type or is unknown
/// @throws std::invalid_argument if a name in `layers` or `style` is unknown
VizParams ReadVizParams(const ros::NodeHandle& node);

/// Publishes `markers`, `moves`, `image`, `image/compressed`, and `ship_<id>/route` of the ships 0
/// to 63, at most rate_hz times per second of wall time. A topic without a subscriber gets no
/// messages. A topic with a subscriber gets a message after its content has changed, or after a new
/// subscriber has connected. A new subscriber of `markers` gets the current markers immediately.
class VizNode {
 public:
  /// @param node  namespace of the topics
  VizNode(ros::NodeHandle node, const VizParams& params);

 private:
  void OnSpec(const aquafarm_msgs::FarmSpecConstPtr& spec);
  void OnState(const aquafarm_msgs::FarmStateConstPtr& state);
  void OnTraining(const aquafarm_msgs::TrainingStatusConstPtr& training);
  void OnMarkerSubscriber(const ros::SingleSubscriberPublisher& subscriber);
  visualization_msgs::MarkerArray MarkersOf(const Shown& shown);
  void Draw();
  void PublishMarkers(const Shown& shown);
  void PublishImages(const Shown& shown);
  void PublishRoutes(const Shown& shown);
  void PublishMoves(const Shown& shown);
  void FollowValues();
  void ReadCloud(const Shown& shown);

  ros::NodeHandle node_;
  Pairing pairing_;
  Trail trail_;
  Trail route_{Trail::kWhole};
  const Layers layers_;
  FarmPainter painter_;
  DangerMarkers danger_;
  aquafarm_msgs::TrainingStatusConstPtr training_;
  bool marked_{};                           // true: `markers` are up to date
  bool pictured_{};                         // true: the images are up to date
  bool routed_{};                           // true: the routes are up to date
  bool moved_{true};                        // true: the moves are up to date
  sensor_msgs::PointCloud2ConstPtr cloud_;  // unread message of `values/points`; null: none
  std::optional<Values> values_;
  std::deque<std::pair<ros::Time, std::uint64_t>> stamps_;  // stamps and steps of the last states
  aquafarm_msgs::PolicyChoiceConstPtr choice_;
  Shown marked_episode_;  // pair whose markers were published last

  ros::Publisher markers_;
  ros::Publisher moves_;
  ros::Publisher image_;
  ros::Publisher compressed_;
  std::vector<ros::Publisher> routes_;  // by ship
  ros::Subscriber spec_;
  ros::Subscriber state_;
  ros::Subscriber training_topic_;
  // `values_topic_` is subscribed only while values are drawn, because they are computed only for a
  // subscriber.
  ros::Subscriber values_topic_;
  ros::Subscriber choice_topic_;
  ros::WallTimer timer_;
};

}  // namespace aquafarm_viz
