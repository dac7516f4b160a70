// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/node/replay_node.h"

#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/Outcome.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <climits>
#include <set>
#include <string>

#include "aquafarm_sim/params.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::Outcome;

constexpr double kTick_s = 0.01;
constexpr double kMinSpeed = 0.001;
constexpr double kMaxSpeed = 1000.0;
constexpr std::uint32_t kQueue = 100;

template <typename Response>
void Refuse(const std::string& message, Response& response) {
  response.ok = false;
  response.code = Outcome::BAD_VALUE;
  response.message = message;
}

// Returns true for drawings. They are not replayed, because viz_node draws the replayed states.
bool IsDrawn(const rosbag::MessageInstance& message) {
  static const std::set<std::string> kDrawn{"visualization_msgs/MarkerArray", "nav_msgs/Path",
                                            "sensor_msgs/Image", "sensor_msgs/CompressedImage"};
  return kDrawn.count(message.getDataType()) != 0;
}

}  // namespace

ReplayParams ReadReplayParams(const ros::NodeHandle& node) {
  ReplayParams params;
  aquafarm_sim::Params reader(node);
  reader.Text("bag", params.bag);
  reader.Number("speed", kMinSpeed, kMaxSpeed, params.speed);
  reader.Number("start_s", 0.0, 1e9, params.start_s);
  reader.Int("start_episode", -1, INT_MAX, params.start_episode);
  reader.Int("start_step", 0, INT_MAX, params.start_step);
  reader.Number("delay_s", 0.0, 3600.0, params.delay_s);
  reader.Flag("paused", params.paused);
  reader.Flag("loop", params.loop);
  reader.Flag("keep_alive", params.keep_alive);
  reader.RefuseOthers();
  if (params.bag.empty()) {
    throw aquafarm::InputError("~bag: got nothing, expected a bag file");
  }
  return params;
}

ReplayNode::ReplayNode(const ros::NodeHandle& node, const ReplayParams& params)
    : node_(node),
      params_(params),
      tape_(params.bag),
      speed_(params.speed),
      paused_(params.paused) {
  for (const rosbag::MessageInstance& message : tape_.messages()) {
    const std::string& topic = message.getTopic();
    if (topics_.count(topic) != 0 || IsDrawn(message)) continue;
    ros::AdvertiseOptions options =
        AdvertiseOptionsOf(message, IsState(message) ? ReplayTape::kQueueOfStates : kQueue);
    // A new subscriber gets the last message of a topic, except of topics with states.
    options.latch =
        message.getDataType() != ros::message_traits::datatype<aquafarm_msgs::FarmState>();
    topics_[topic] = node_.advertise(options);
  }
  clock_ = node_.advertise<rosgraph_msgs::Clock>("/clock", 10);
  pause_ = node_.advertiseService("pause", &ReplayNode::OnPause, this);
  set_pace_ = node_.advertiseService("set_pace", &ReplayNode::OnSetPace, this);
  jump_ = node_.advertiseService("jump", &ReplayNode::OnJump, this);
  now_ = tape_.messages().front().getTime();
  ticked_ = ros::WallTime::now() + ros::WallDuration(params.delay_s);
  timer_ = node_.createWallTimer(ros::WallDuration(kTick_s),
                                 [this](const ros::WallTimerEvent&) { Tick(); });
}

void ReplayNode::Begin() {
  begun_ = true;
  const auto& first = tape_.steps().front();
  const std::uint64_t episode =
      params_.start_episode < 0 ? first.episode : static_cast<std::uint64_t>(params_.start_episode);
  auto step = tape_.Find(first, episode, static_cast<std::uint64_t>(params_.start_step));
  if (!step) {
    ROS_WARN("start_episode: got %d, which the bag does not contain; showing episode %llu",
             params_.start_episode, static_cast<unsigned long long>(first.episode));
    step = first;
  }
  const ros::Time wanted = tape_.messages().front().getTime() + ros::Duration(params_.start_s);
  if (params_.start_s > 0.0) {
    for (const ReplayTape::Step& one : tape_.steps()) {
      step = one;
      if (tape_.messages()[one.position].getTime() >= wanted) break;
    }
  }
  JumpTo(*step);
}

void ReplayNode::PublishClock() {
  rosgraph_msgs::Clock clock;
  clock.clock = now_;
  clock_.publish(clock);
}

void ReplayNode::Publish(std::size_t position) {
  const rosbag::MessageInstance& message = tape_.messages()[position];
  const auto topic = topics_.find(message.getTopic());
  if (topic != topics_.end()) PublishMessage(message, topic->second);
}

void ReplayNode::Tick() {
  const ros::WallTime now = ros::WallTime::now();
  if (now < ticked_) return;  // during delay_s
  if (!begun_) Begin();
  const double passed_s = (now - ticked_).toSec();
  ticked_ = now;
  if (!paused_ && !IsAtEnd()) {
    now_ += ros::Duration(passed_s * speed_);
    while (!IsAtEnd() && tape_.messages()[next_].getTime() <= now_) Publish(next_++);
  }
  PublishClock();
  if (!IsAtEnd() || paused_) return;
  if (params_.loop) {
    JumpTo(tape_.steps().front());
  } else if (!params_.keep_alive) {
    ros::requestShutdown();
  }
}

void ReplayNode::JumpTo(const ReplayTape::Step& step) {
  now_ = tape_.messages()[step.position].getTime();
  PublishClock();
  for (const std::size_t position : tape_.UpTo(step)) Publish(position);
  next_ = step.position + 1;
}

void ReplayNode::GoOn(std::uint32_t steps) {
  while (steps > 0 && !IsAtEnd()) {
    now_ = tape_.messages()[next_].getTime();
    const bool is_state = tape_.At(next_).position == next_;
    Publish(next_++);
    if (is_state) --steps;
  }
  PublishClock();
}

bool ReplayNode::OnPause(aquafarm_msgs::Pause::Request& request,
                         aquafarm_msgs::Pause::Response& response) {
  paused_ = request.paused != 0;
  if (paused_ && request.steps > 0) {
    if (!begun_) Begin();  // also during delay_s
    GoOn(request.steps);
  }
  response.ok = true;
  response.paused = paused_;
  return true;
}

bool ReplayNode::OnSetPace(aquafarm_msgs::SetPace::Request& request,
                           aquafarm_msgs::SetPace::Response& response) {
  const double period_s = tape_.StepPeriod_s(tape_.At(next_ == 0 ? 0 : next_ - 1).run);
  const double speed = request.rate_hz > 0.0 ? request.rate_hz * period_s : speed_;
  response.pace = "paced";
  response.rate_hz = speed_ / period_s;
  if (!request.pace.empty() && request.pace != "paced") {
    Refuse("pace: got " + request.pace + ", expected paced: a replay has no other pace", response);
  } else if (!(request.rate_hz >= 0.0) || !(speed >= kMinSpeed && speed <= kMaxSpeed)) {
    Refuse("rate_hz: got " + std::to_string(request.rate_hz) + ", expected 0 or [" +
               std::to_string(kMinSpeed / period_s) + ", " + std::to_string(kMaxSpeed / period_s) +
               "]",
           response);
  } else {
    speed_ = speed;
    response.ok = true;
    response.rate_hz = speed_ / period_s;
  }
  return true;
}

bool ReplayNode::OnJump(aquafarm_msgs::Jump::Request& request,
                        aquafarm_msgs::Jump::Response& response) {
  const ReplayTape::Step shown = tape_.At(next_ == 0 ? 0 : next_ - 1);
  const auto step =
      tape_.Find(shown, request.has_episode ? request.episode : shown.episode, request.step);
  response.episode = shown.episode;
  response.step = shown.step;
  if (!step) {
    const auto [lowest, highest] =
        std::minmax_element(tape_.steps().begin(), tape_.steps().end(),
                            [](const ReplayTape::Step& one, const ReplayTape::Step& other) {
                              return one.episode < other.episode;
                            });
    Refuse("episode: got " + std::to_string(request.episode) + ", the bag has episodes " +
               std::to_string(lowest->episode) + " to " + std::to_string(highest->episode) +
               " (some of them may not be recorded)",
           response);
    return true;
  }
  begun_ = true;
  JumpTo(*step);
  response.ok = true;
  response.episode = step->episode;
  response.step = step->step;
  return true;
}

}  // namespace aquafarm_viz
