// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/node/viz_node.h"

#include <gtest/gtest.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <visualization_msgs/MarkerArray.h>

#include <functional>
#include <limits>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "fixture.h"

namespace aquafarm_viz {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

// Publishes messages in place of the sim node, but no /clock: viz_node must not need it.
class VizNodeTest : public testing::Test {
 protected:
  static constexpr double kLimit_s = 60.0;

  VizNodeTest()
      : spec_(node_.advertise<aquafarm_msgs::FarmSpec>("spec", 10, true)),
        state_(node_.advertise<aquafarm_msgs::FarmState>("state", 10)) {
    EXPECT_TRUE(Until([&] {
      return spec_.getNumSubscribers() > 0 && state_.getNumSubscribers() > 0;
    })) << "viz_node does not subscribe to spec and state";
  }

  static bool Until(const std::function<bool()>& done) {
    const auto end = ros::WallTime::now() + ros::WallDuration(kLimit_s);
    while (!done()) {
      if (ros::WallTime::now() > end || !ros::ok()) return false;
      ros::spinOnce();
      ros::WallDuration(0.005).sleep();
    }
    return true;
  }

  static void Idle(double seconds) {
    const auto end = ros::WallTime::now() + ros::WallDuration(seconds);
    while (ros::WallTime::now() < end) {
      ros::spinOnce();
      ros::WallDuration(0.005).sleep();
    }
  }

  // Each test plays a different episode.
  void Play(std::uint64_t episode, std::uint64_t step) {
    auto state = test::MakeState();
    state.episode = episode;
    state.step = step;
    state.header.stamp = ros::Time(100.0 + double(step));
    state.disasters.front().x += 0.5F * static_cast<float>(step);
    state_.publish(state);
  }

  void Announce(std::uint64_t episode) {
    auto spec = test::MakeSpec();
    spec.episode = episode;
    spec_.publish(spec);
  }

  ros::NodeHandle node_;
  ros::Publisher spec_;
  ros::Publisher state_;
};

TEST_F(VizNodeTest, DrawsStatesAsImagesThatChange) {
  std::vector<sensor_msgs::ImageConstPtr> images;
  const auto subscriber = node_.subscribe<sensor_msgs::Image>(
      "image", 10, [&](const sensor_msgs::ImageConstPtr& image) { images.push_back(image); });
  ASSERT_TRUE(Until([&] { return subscriber.getNumPublishers() > 0; }));
  Announce(1);
  Play(1, 1);
  ASSERT_TRUE(Until([&] { return !images.empty() && images.back()->header.stamp.sec == 101; }));
  EXPECT_EQ(images.back()->encoding, "bgr8");
  EXPECT_EQ(images.back()->width, 640U);
  EXPECT_EQ(images.back()->height, 640U);
  EXPECT_EQ(images.back()->header.frame_id, "map");
  const auto first = images.back();
  Play(1, 6);
  ASSERT_TRUE(Until([&] { return images.back()->header.stamp.sec == 106; }));
  EXPECT_NE(first->data, images.back()->data);
}

TEST_F(VizNodeTest, CompressesOnlyWhatIsAskedFor) {
  std::vector<sensor_msgs::CompressedImageConstPtr> images;
  Announce(2);
  Play(2, 1);
  {
    const auto subscriber = node_.subscribe<sensor_msgs::CompressedImage>(
        "image/compressed", 10,
        [&](const sensor_msgs::CompressedImageConstPtr& image) { images.push_back(image); });
    // No new state arrives, but a new subscriber gets a picture.
    ASSERT_TRUE(Until([&] { return !images.empty(); }));
  }
  const cv::Mat picture = cv::imdecode(images.back()->data, cv::IMREAD_COLOR);
  EXPECT_EQ(picture.size(), cv::Size(640, 640));
  EXPECT_EQ(images.back()->format, "bgr8; jpeg compressed bgr8");
}

TEST_F(VizNodeTest, PublishesEachShipsRouteAsAPathInMetres) {
  nav_msgs::PathConstPtr path;
  const auto subscriber = node_.subscribe<nav_msgs::Path>(
      "ship_0/route", 10, [&](const nav_msgs::PathConstPtr& got) { path = got; });
  Announce(80);
  ASSERT_TRUE(Until([&] { return subscriber.getNumPublishers() > 0; }));
  for (int step = 1; step <= 4; ++step) {
    auto state = test::MakeState();
    state.episode = 80;
    state.step = static_cast<std::uint64_t>(step);
    state.ships.front().x = 4 + step;
    state.ships.front().y = 7;
    state_.publish(state);
  }
  ASSERT_TRUE(Until([&] { return path != nullptr && path->poses.size() == 4; }));
  EXPECT_EQ(path->header.frame_id, "map");
  const double cell_m = test::MakeSpec().cell_size_m;
  EXPECT_EQ(path->poses.front().pose.position.x, 5 * cell_m);
  EXPECT_EQ(path->poses.back().pose.position.x, 8 * cell_m);
  EXPECT_EQ(path->poses.back().pose.position.y, 7 * cell_m);
}

// Counts the messages and namespaces of `markers`.
struct MarkerCount {
  std::map<std::string, int> delete_all;  // by episode, as written in the status
  std::set<std::string> spaces;
  std::string status;  // without the clock, with which the text begins
  void Take(const MarkerArray& array) {
    int here = 0;
    for (const auto& marker : array.markers) {
      here += marker.action == Marker::DELETEALL ? 1 : 0;
      spaces.insert(marker.ns);
      if (marker.ns == "status") status = marker.text.substr(marker.text.find("episode "));
    }
    delete_all[status.substr(0, status.find("  "))] += here;
  }
};

TEST_F(VizNodeTest, DeletesAllMarkersOncePerEpisode) {
  MarkerCount count;
  const auto subscriber = node_.subscribe<MarkerArray>(
      "markers", 100, [&](const visualization_msgs::MarkerArrayConstPtr& m) { count.Take(*m); });
  ASSERT_TRUE(Until([&] { return subscriber.getNumPublishers() > 0; }));
  for (const std::uint64_t episode : {30U, 31U}) {
    Announce(episode);
    for (std::uint64_t step = 1; step <= 5; ++step) {
      Play(episode, step);
      const std::string words =
          "episode " + std::to_string(episode) + "  step " + std::to_string(step);
      ASSERT_TRUE(Until([&] { return count.status.substr(0, words.size()) == words; })) << words;
    }
    EXPECT_EQ(count.delete_all["episode " + std::to_string(episode)], 1);
  }
}

TEST_F(VizNodeTest, GivesALateOnlookerEverything) {
  Announce(40);
  Play(40, 1);
  Idle(0.3);
  MarkerCount count;
  const auto subscriber = node_.subscribe<MarkerArray>(
      "markers", 100, [&](const visualization_msgs::MarkerArrayConstPtr& m) { count.Take(*m); });
  ASSERT_TRUE(Until([&] { return count.spaces.count("status") > 0; }));
  for (const char* space :
       {"sea", "island", "rocks", "port", "ship", "device", "ring", "heading"}) {
    EXPECT_EQ(count.spaces.count(space), 1U) << space;
  }
}

TEST_F(VizNodeTest, WaitsForTheSpecThatFits) {
  MarkerCount count;
  const auto subscriber = node_.subscribe<MarkerArray>(
      "markers", 100, [&](const visualization_msgs::MarkerArrayConstPtr& m) { count.Take(*m); });
  ASSERT_TRUE(Until([&] { return subscriber.getNumPublishers() > 0; }));
  Play(50, 1);
  Idle(0.5);
  EXPECT_NE(count.status.substr(0, 10), "episode 50");
  Announce(50);
  EXPECT_TRUE(Until([&] { return count.status.substr(0, 10) == "episode 50"; }));
}

TEST_F(VizNodeTest, DrawsThePolicysMovesAndAsksForValuesOnlyWhileSomebodyLooks) {
  ros::Publisher values = node_.advertise<sensor_msgs::PointCloud2>("values/points", 1, true);
  auto cloud = test::MakeCloud();
  cloud.point_step = 1;  // invalid
  values.publish(cloud);
  Announce(80);
  Play(80, 1);
  Idle(0.5);
  EXPECT_EQ(values.getNumSubscribers(), 0U);
  std::size_t arrows = 0;
  auto subscriber = node_.subscribe<MarkerArray>(
      "moves", 10, [&](const visualization_msgs::MarkerArrayConstPtr& message) {
        arrows = message->markers.at(0).points.size();
      });
  ASSERT_TRUE(Until([&] { return values.getNumSubscribers() > 0; }));
  values.publish(test::MakeCloud());
  ASSERT_TRUE(Until([&] { return arrows > 0; }));
  EXPECT_EQ(arrows, 12U * 12U * 9U) << "of every second cell";
  subscriber.shutdown();
  EXPECT_TRUE(Until([&] { return values.getNumSubscribers() == 0; }));
}

TEST_F(VizNodeTest, OutlivesHostileMessages) {
  auto spec = test::MakeSpec();
  spec.episode = 60;
  spec.width = spec.height = 2000000000;
  spec_.publish(spec);
  spec.width = spec.height = -1;
  spec_.publish(spec);
  auto state = test::MakeState();
  state.episode = 60;
  state.disasters.front().radii.assign(1000000, 1.0F);
  state_.publish(state);
  state = test::MakeState();
  state.episode = 60;
  state.disasters.front().x = std::numeric_limits<float>::quiet_NaN();
  state_.publish(state);
  MarkerCount count;
  const auto subscriber = node_.subscribe<MarkerArray>(
      "markers", 100, [&](const visualization_msgs::MarkerArrayConstPtr& m) { count.Take(*m); });
  Announce(61);
  Play(61, 1);
  EXPECT_TRUE(Until([&] { return count.status.substr(0, 10) == "episode 61"; }));
}

TEST_F(VizNodeTest, HasALightStyle) {
  ros::NodeHandle own("~");
  EXPECT_EQ(ReadVizParams(own).style, &DarkStyle());
  own.setParam("style", "light");
  EXPECT_EQ(ReadVizParams(own).style, &LightStyle());
  own.setParam("style", "blue");
  try {
    ReadVizParams(own);
    ADD_FAILURE();
  } catch (const std::invalid_argument& fault) {
    EXPECT_STREQ(fault.what(), "style: got 'blue', expected dark or light");
  }
  own.deleteParam("style");
}

TEST_F(VizNodeTest, DrawsNoFasterThanItsRate) {
  int images = 0;
  const auto subscriber = node_.subscribe<sensor_msgs::Image>(
      "image", 1000, [&](const sensor_msgs::ImageConstPtr&) { ++images; });
  ASSERT_TRUE(Until([&] { return subscriber.getNumPublishers() > 0; }));
  Announce(70);
  const auto start = ros::WallTime::now();
  for (std::uint64_t step = 1; step <= 2000; ++step) {
    Play(70, step % 5000);
    ros::WallDuration(0.0005).sleep();
    ros::spinOnce();
  }
  const double seconds = (ros::WallTime::now() - start).toSec();
  EXPECT_GT(images, 2);
  EXPECT_LE(images, static_cast<int>(50.0 * seconds * 1.2) + 3);
}

}  // namespace
}  // namespace aquafarm_viz

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "viz_node_test");
  return RUN_ALL_TESTS();
}
