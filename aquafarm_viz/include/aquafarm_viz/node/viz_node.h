// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The one node of this package: spec and state in, markers and images out.

#include <aquafarm_msgs/TrainingStatus.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm_viz/draw/image.h"
#include "aquafarm_viz/scene/pairing.h"

namespace aquafarm_viz {

/// The parameters of the node, from its private namespace.
struct VizParams {
  double rate_hz{20.0};  ///< most drawings a second of wall time, (0, 1000]
  ImageSize image;       ///< pixels, each side in [kMinImageSide, kMaxImageSide]
  Layers layers;         ///< of the pictures
};

/// Reads the parameters.
/// @throws std::invalid_argument naming the parameter, what it is and what is allowed.
VizParams ReadVizParams(const ros::NodeHandle& node);

/// Publishes `markers`, `moves`, `image`, `image/compressed` and each ship's `ship_<id>/route`, at
/// most rate_hz times a second of wall time, only of states that are new, and each only while
/// somebody subscribes.
class VizNode {
 public:
  /// @param node  namespace of the topics.
  VizNode(ros::NodeHandle node, const VizParams& params);

 private:
  void OnSpec(const aquafarm_msgs::FarmSpecConstPtr& spec);
  void OnState(const aquafarm_msgs::FarmStateConstPtr& state);
  void OnTraining(const aquafarm_msgs::TrainingStatusConstPtr& training);
  void OnMarkerSubscriber(const ros::SingleSubscriberPublisher& subscriber);
  void Draw();
  void PublishMarkers(const Shown& shown);
  void PublishImages(const Shown& shown);
  void PublishRoutes(const Shown& shown);
  void PublishMoves(const Shown& shown);
  void FollowValues();
  void ReadCloud(const Shown& shown);

  ros::NodeHandle node_;
  Pairing pairing_;
  Wake wake_;
  Wake route_{Wake::kWhole};
  const Layers layers_;
  FarmPainter painter_;
  aquafarm_msgs::TrainingStatusConstPtr training_;
  bool marked_{};                           // state of `markers`: whether it is up to date
  bool pictured_{};                         // the same of the images
  bool routed_{};                           // and of the routes
  bool moved_{true};                        // and of the moves
  sensor_msgs::PointCloud2ConstPtr cloud_;  // of `values/points`, not yet read
  std::optional<Values> values_;
  std::deque<std::pair<ros::Time, std::uint64_t>> stamps_;  // of the last states, with their steps
  aquafarm_msgs::PolicyChoiceConstPtr choice_;
  Shown marked_episode_;  // the episode whose standing markers were sent

  ros::Publisher markers_;
  ros::Publisher moves_;
  ros::Publisher image_;
  ros::Publisher compressed_;
  std::vector<ros::Publisher> routes_;  // by ship
  ros::Subscriber spec_;
  ros::Subscriber state_;
  ros::Subscriber training_topic_;
  ros::Subscriber values_topic_;  // only while somebody looks: it costs whoever computes it
  ros::Subscriber choice_topic_;
  ros::WallTimer timer_;
};

}  // namespace aquafarm_viz
