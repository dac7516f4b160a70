// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/node/viz_node.h"

#include <cv_bridge/cv_bridge.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "aquafarm_sim/checked_topics.h"
#include "aquafarm_sim/params.h"
#include "aquafarm_viz/markers/markers.h"
#include "aquafarm_viz/names.h"
#include "aquafarm_viz/replay/replay.h"
#include "markers/legend.h"

namespace aquafarm_viz {
namespace {

constexpr double kWarnEvery_s = 5.0;
constexpr int kJpegQuality = 90;
constexpr std::size_t kStamps = 200;     // number of last states to which values may belong
constexpr std::int32_t kMaxRoutes = 64;  // max ships with a route topic

}  // namespace

VizParams ReadVizParams(const ros::NodeHandle& node) {
  VizParams params;
  aquafarm_sim::Params reader(node);
  std::string layers;
  std::string style = "dark";
  reader.Number(names::kRateParam, 0.1, 1000.0, params.rate_hz);
  reader.Int(names::kWidthParam, kMinImageSide, kMaxImageSide, params.image.width);
  reader.Int(names::kHeightParam, kMinImageSide, kMaxImageSide, params.image.height);
  reader.Text(names::kLayersParam, layers);
  reader.Text(names::kStyleParam, style);
  reader.RefuseOthers();
  if (node.hasParam(names::kLayersParam)) params.layers = ParseLayers(layers);
  params.style = &StyleByName(style);
  return params;
}

VizNode::VizNode(ros::NodeHandle node, const VizParams& params)
    : node_(node), layers_(params.layers), painter_(params.image, *params.style) {
  markers_ = node.advertise<visualization_msgs::MarkerArray>(
      names::kMarkers, 10,
      [this](const ros::SingleSubscriberPublisher& subscriber) { OnMarkerSubscriber(subscriber); });
  moves_ = node.advertise<visualization_msgs::MarkerArray>(
      names::kMoves, 2, [this](const ros::SingleSubscriberPublisher&) { moved_ = !values_; });
  // A new subscriber gets a picture even if the farm does not change.
  const auto redraw = [this](const ros::SingleSubscriberPublisher&) { pictured_ = false; };
  image_ = node.advertise<sensor_msgs::Image>(names::kImage, 2, redraw);
  compressed_ = node.advertise<sensor_msgs::CompressedImage>(names::kCompressed, 2, redraw);
  spec_ = aquafarm_sim::Subscribe<aquafarm_msgs::FarmSpec>(
      node, names::kSpec, Pairing::kSpecs,
      [this](const aquafarm_msgs::FarmSpecConstPtr& spec) { OnSpec(spec); });
  state_ = aquafarm_sim::Subscribe<aquafarm_msgs::FarmState>(
      node, names::kState, ReplayTape::kQueueOfStates,
      [this](const aquafarm_msgs::FarmStateConstPtr& state) { OnState(state); },
      ros::TransportHints().tcpNoDelay());
  training_topic_ = aquafarm_sim::Subscribe<aquafarm_msgs::TrainingStatus>(
      node, names::kTraining, 1,
      [this](const aquafarm_msgs::TrainingStatusConstPtr& training) { OnTraining(training); });
  choice_topic_ = aquafarm_sim::Subscribe<aquafarm_msgs::PolicyChoice>(
      node, names::kChoice, 2, [this](const aquafarm_msgs::PolicyChoiceConstPtr& choice) {
        choice_ = choice;
        marked_ = pictured_ = false;
      });
  timer_ = node.createWallTimer(ros::WallDuration(1.0 / params.rate_hz),
                                [this](const ros::WallTimerEvent&) { Draw(); });
}

void VizNode::OnSpec(const aquafarm_msgs::FarmSpecConstPtr& spec) {
  if (const auto fault = pairing_.AddSpec(spec); !fault.empty()) {
    ROS_WARN_THROTTLE(kWarnEvery_s, "spec refused: %s", fault.c_str());
    return;
  }
  marked_ = pictured_ = routed_ = false;
  for (auto ship = static_cast<std::int32_t>(routes_.size());
       ship < std::min(spec->agents, kMaxRoutes); ++ship) {
    routes_.push_back(node_.advertise<nav_msgs::Path>(
        "ship_" + std::to_string(ship) + "/" + names::kRoute, 2,
        [this](const ros::SingleSubscriberPublisher&) { routed_ = false; }));
  }
}

void VizNode::OnState(const aquafarm_msgs::FarmStateConstPtr& state) {
  if (const auto fault = pairing_.AddState(state); !fault.empty()) {
    ROS_WARN_THROTTLE(kWarnEvery_s, "state refused: %s", fault.c_str());
    return;
  }
  trail_.Update(*state);
  route_.Update(*state);
  if (values_) values_->Pair(*state);
  stamps_.emplace_back(state->header.stamp, state->step);
  if (stamps_.size() > kStamps) stamps_.pop_front();
  marked_ = pictured_ = routed_ = false;
}

void VizNode::OnTraining(const aquafarm_msgs::TrainingStatusConstPtr& training) {
  training_ = training;
  pictured_ = false;
}

void VizNode::OnMarkerSubscriber(const ros::SingleSubscriberPublisher& subscriber) {
  const Shown& shown = pairing_.shown();
  if (shown.spec == nullptr) return;
  subscriber.publish(Joined(SpecMarkers(*shown.spec, false, layers_), MarkersOf(shown)));
}

visualization_msgs::MarkerArray VizNode::MarkersOf(const Shown& shown) {
  auto array = StateMarkers(*shown.spec, *shown.state, &trail_, layers_);
  if (layers_.risk) {
    array = Joined(array, danger_.Of(*shown.spec, *shown.state, layers_.trail ? &trail_ : nullptr));
  }
  if (choice_ == nullptr) return array;
  return Joined(array, ChoiceMarkers(*choice_, *shown.spec, *shown.state));
}

void VizNode::FollowValues() {
  const bool pictures = image_.getNumSubscribers() > 0 || compressed_.getNumSubscribers() > 0;
  const bool wanted =
      moves_.getNumSubscribers() > 0 || (pictures && (layers_.values || layers_.moves));
  if (!wanted) {
    values_topic_.shutdown();
    values_topic_ = ros::Subscriber();
  } else if (!values_topic_) {
    values_topic_ = aquafarm_sim::Subscribe<sensor_msgs::PointCloud2>(
        node_, names::kValuePoints, 1,
        [this](const sensor_msgs::PointCloud2ConstPtr& cloud) { cloud_ = cloud; });
  }
}

void VizNode::ReadCloud(const Shown& shown) {
  try {
    values_ = ReadValues(*cloud_, *shown.spec);
    for (const auto& [stamp, step] : stamps_) {
      if (stamp == values_->stamp) values_->step = step;
    }
    moved_ = pictured_ = false;
  } catch (const std::invalid_argument& fault) {
    ROS_WARN_THROTTLE(kWarnEvery_s, "%s", fault.what());
  }
  cloud_.reset();
}

void VizNode::Draw() {
  FollowValues();
  if (const auto waiting = pairing_.Waiting(); !waiting.empty()) {
    ROS_WARN_DELAYED_THROTTLE(kWarnEvery_s, "%s", waiting.c_str());
  }
  const Shown& shown = pairing_.shown();
  if (shown.spec == nullptr) return;
  if (cloud_ != nullptr) ReadCloud(shown);
  try {
    if (!moved_) PublishMoves(shown);
    if (!marked_) PublishMarkers(shown);
    if (!pictured_) PublishImages(shown);
    if (!routed_) PublishRoutes(shown);
  } catch (const std::exception& fault) {
    marked_ = pictured_ = routed_ = moved_ = true;  // drawing the same state would fail again
    ROS_ERROR_THROTTLE(kWarnEvery_s, "state not drawn: %s", fault.what());
  }
}

void VizNode::PublishMarkers(const Shown& shown) {
  if (markers_.getNumSubscribers() == 0) return;
  auto array = MarkersOf(shown);
  if (marked_episode_.spec != shown.spec)
    array = Joined(SpecMarkers(*shown.spec, true, layers_), array);
  markers_.publish(array);
  marked_episode_ = shown;
  marked_ = true;
}

void VizNode::PublishMoves(const Shown& shown) {
  if (moves_.getNumSubscribers() > 0) {
    auto array = MoveMarkers(*values_, *shown.spec);
    AddValueLegend(array, *shown.spec, *values_);
    moves_.publish(array);
  }
  moved_ = true;
}

void VizNode::PublishRoutes(const Shown& shown) {
  for (std::size_t ship = 0; ship < routes_.size(); ++ship) {
    const ShipTrail* way = route_.Find(static_cast<std::int32_t>(ship));
    if (way == nullptr || routes_[ship].getNumSubscribers() == 0) continue;
    nav_msgs::Path path;
    path.header = shown.state->header;
    path.header.frame_id = names::kMapFrame;
    const std::size_t first = way->UnbrokenFrom();  // a Path message cannot contain gaps
    path.poses.resize(way->places.size() - first);
    for (std::size_t i = 0; i < path.poses.size(); ++i) {
      const cv::Point& place = way->places[first + i];
      path.poses[i].header = path.header;
      path.poses[i].pose.position.x = place.x * shown.spec->cell_size_m;
      path.poses[i].pose.position.y = place.y * shown.spec->cell_size_m;
      path.poses[i].pose.orientation.w = 1.0;
    }
    routes_[ship].publish(path);
  }
  routed_ = true;
}

void VizNode::PublishImages(const Shown& shown) {
  const bool raw = image_.getNumSubscribers() > 0;
  const bool compressed = compressed_.getNumSubscribers() > 0;
  if (!raw && !compressed) return;
  const cv::Mat& picture = painter_.Draw(
      *shown.spec, *shown.state,
      {&trail_, training_.get(), &route_, layers_, values_ ? &*values_ : nullptr, choice_.get()});
  std_msgs::Header header = shown.state->header;
  header.frame_id = names::kMapFrame;
  if (raw) image_.publish(cv_bridge::CvImage(header, "bgr8", picture).toImageMsg());
  if (compressed) {
    sensor_msgs::CompressedImage message;
    message.header = header;
    message.format = "bgr8; jpeg compressed bgr8";
    cv::imencode(".jpg", picture, message.data, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
    compressed_.publish(message);
  }
  pictured_ = true;
}

}  // namespace aquafarm_viz
