// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/node/farm_publisher.h"

#include <ros/console.h>
#include <ros/init.h>

#include <chrono>
#include <thread>

#include "aquafarm_sim/names.h"

namespace aquafarm_sim {
namespace {

using aquafarm::MutexLock;

constexpr std::uint32_t kQueue = 10;
constexpr std::uint32_t kRecordQueue = 10000;
// While rosbag record writes a chunk, it queues at most 100 messages per topic and drops others.
constexpr std::chrono::milliseconds kRecordPeriod{2};
// Max time to wait until the queue is empty, before a message is sent to a single, new subscriber.
constexpr std::chrono::milliseconds kSendLimit{1000};
constexpr std::size_t kMaxSummaries = 1000;
// A recorder connects to its topics one after the other. It counts as ready if the number of
// connections has not changed for this time.
const ros::WallDuration kRecorderGrace(0.5);

}  // namespace

// A new subscriber receives the last message without waiting for the next state. This message is
// sent after the messages that are still in the queue, so that a recording stays in order of time.
// The topic is not latched for two reasons: roscpp sends a latched message before the queued ones;
// and bags mark latched messages, so that a player that starts in the middle of a bag would first
// send an outdated state.
template <typename Message>
void FarmPublisher::Advertise(ros::NodeHandle& node, const std::string& name,
                              Topic<Message>& topic) {
  const ros::SubscriberStatusCallback greet =
      [this, &topic](const ros::SingleSubscriberPublisher& subscriber) {
        const MutexLock lock(message_mutex_);
        if (topic.valid && sent_.Wait(kSendLimit)) {
          subscriber.publish(topic.message);
        } else {
          Wake();
        }
      };
  topic.publisher = node.advertise<Message>(name, params_.record ? kRecordQueue : kQueue, greet);
}

FarmPublisher::FarmPublisher(const ros::NodeHandle& node_handle, const SimParams& params,
                             FarmServer& ranch)
    : params_(params), ranch_(ranch) {
  ros::NodeHandle node(node_handle);
  const std::uint32_t queue = params_.record ? kRecordQueue : kQueue;
  if (params_.publish_clock) Advertise(node, names::kClock, clock_);
  spec_ = node.advertise<aquafarm_msgs::FarmSpec>(names::kSpec, queue, true);
  chart_ = node.advertise<nav_msgs::OccupancyGrid>(names::kChart, queue, true);
  if (const auto& seas = ranch_.scenario().seas) {
    for (const aquafarm::SeaLayer& layer : seas->layers) {
      seas_.push_back(
          {node.advertise<nav_msgs::OccupancyGrid>(names::Sea(layer.name), queue, true),
           node.advertise<std_msgs::Float32MultiArray>(names::SeaValues(layer.name), queue, true)});
    }
  }
  episode_ = node.advertise<aquafarm_msgs::EpisodeSummary>(names::kEpisode, kMaxSummaries);
  Advertise(node, names::kState, state_);
  Advertise(node, names::kRisk, risk_);
  for (std::int32_t ship = 0; ship < ranch_.agents(); ++ship) {
    // A driver that subscribes receives the current observation immediately.
    const ros::SubscriberStatusCallback greet =
        [this, ship](const ros::SingleSubscriberPublisher& subscriber) {
          ranch_.Inspect([&](const ServerView& view) {
            const MutexLock lock(observation_mutex_);
            sent_.Wait(kSendLimit);  // after a timeout, drivers skip the earlier observations
            subscriber.publish(ObservationOf(view, ship));
          });
        };
    observations_.emplace_back();
    observations_.back().publisher =
        node.advertise<aquafarm_msgs::FarmState>(names::Observation(ship), queue, greet);
  }
  {
    const MutexLock lock(message_mutex_);
    bearings_.assign(static_cast<std::size_t>(ranch_.agents()), 0);
  }
  ranch_.SetListener(this);
  thread_ = std::thread([this] { Run(); });
}

FarmPublisher::~FarmPublisher() {
  ranch_.SetListener(nullptr);
  {
    const MutexLock lock(queue_mutex_);
    ending_ = true;
    wake_.notify_all();
  }
  thread_.join();
}

bool FarmPublisher::WaitForRecorder(double limit_s) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(limit_s);
  std::uint32_t connected = 0;
  ros::WallTime changed_at = ros::WallTime::now();
  for (;;) {
    const ros::WallTime now = ros::WallTime::now();
    const std::uint32_t subscribers = CountSubscribers();
    if (subscribers != connected) changed_at = now;
    connected = subscribers;
    const bool records =
        episode_.getNumSubscribers() > 0 && state_.publisher.getNumSubscribers() > 0;
    if (records && now - changed_at >= kRecorderGrace) return true;
    if (!ros::ok() || now >= end) return false;
    ros::WallDuration(0.02).sleep();
  }
}

std::uint32_t FarmPublisher::CountSubscribers() const {
  std::uint32_t count = spec_.getNumSubscribers() + chart_.getNumSubscribers() +
                        episode_.getNumSubscribers() + state_.publisher.getNumSubscribers() +
                        risk_.publisher.getNumSubscribers();
  for (const Observation& one : observations_) count += one.publisher.getNumSubscribers();
  return count;
}

void FarmPublisher::OnChange(const ServerView& view) {
  if (!view.joint) PublishObservations(view);
  if (params_.record) {
    const MutexLock lock(message_mutex_);
    std::this_thread::sleep_until(next_record_);
    next_record_ = std::chrono::steady_clock::now() + kRecordPeriod;
    Fill(view);
    Send();
    return;
  }
  Wake();
}

void FarmPublisher::Wake() {
  if (dirty_.exchange(true) || !idle_) return;
  const MutexLock lock(queue_mutex_);
  wake_.notify_all();
}

void FarmPublisher::OnEpisodeEnd(const aquafarm_msgs::EpisodeSummary& summary) {
  const MutexLock lock(queue_mutex_);
  if (summaries_.size() >= kMaxSummaries) {
    ++dropped_summaries_;
    return;
  }
  summaries_.push_back(summary);
  if (idle_) wake_.notify_all();
}

void FarmPublisher::OnPresence(const std::vector<std::int32_t>& ships, bool is_present) {
  std::string names;
  for (const std::int32_t ship : ships) names += (names.empty() ? "" : ", ") + std::to_string(ship);
  if (is_present) {
    ROS_WARN("late ship %s sends commands again", names.c_str());
    return;
  }
  ROS_WARN(
      "barrier timed out: no command from ship %s within ~barrier_timeout_s, %g s; it holds until "
      "its next command",
      names.c_str(), params_.ranch.barrier_timeout_s);
}

void FarmPublisher::Run() {
  using Clock = std::chrono::steady_clock;
  const auto period = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(1.0 / (params_.publish_hz > 0.0 ? params_.publish_hz : 10.0)));
  MutexLock lock(queue_mutex_);
  while (!ending_) {
    idle_ = true;
    while (!ending_ && !dirty_ && summaries_.empty()) lock.Wait(wake_);
    idle_ = false;
    std::deque<aquafarm_msgs::EpisodeSummary> summaries;
    summaries.swap(summaries_);
    const Clock::time_point next = Clock::now() + period;
    lock.Unlock();
    if (dirty_.exchange(false) && (params_.publish_hz > 0.0 || params_.record)) {
      try {
        ranch_.Inspect([this](const ServerView& view) {
          const MutexLock message_lock(message_mutex_);
          Fill(view);
        });
        const MutexLock message_lock(message_mutex_);
        Send();
      } catch (const std::exception& error) {
        ROS_ERROR("a state could not be published: %s", error.what());
      }
    }
    for (const aquafarm_msgs::EpisodeSummary& summary : summaries) episode_.publish(summary);
    lock.Lock();
    while (!ending_ && lock.WaitUntil(wake_, next)) {
    }
  }
}

void FarmPublisher::Fill(const ServerView& view) {
  const aquafarm::Farm& farm = view.batch.farm(0);
  context_ = view.context;
  episode_is_new_ = view.episode_count != published_episode_;
  if (episode_is_new_) FillEpisode(view);
  ToMsg(farm, context_, state_.message);
  if (view.joint) PublishObservations(view);
  disasters_ = farm.disasters();
  FillFrames(view);
}

// A node that drives a ship by its observations must receive the observation of every step, except
// of joint steps.
void FarmPublisher::PublishObservations(const ServerView& view) {
  const MutexLock lock(observation_mutex_);
  for (std::int32_t ship = 0; ship < ranch_.agents(); ++ship) {
    const ros::Publisher& publisher = observations_[static_cast<std::size_t>(ship)].publisher;
    if (publisher.getNumSubscribers() > 0) publisher.publish(ObservationOf(view, ship));
  }
}

const aquafarm_msgs::FarmState& FarmPublisher::ObservationOf(const ServerView& view,
                                                             std::int32_t ship) {
  const aquafarm::Farm& farm = view.batch.farm(0);
  aquafarm_msgs::FarmState& message = observations_[static_cast<std::size_t>(ship)].message;
  aquafarm::Observe(farm, ship, view_);
  ToMsg(farm, view_, view.context, message);
  return message;
}

void FarmPublisher::FillEpisode(const ServerView& view) {
  const aquafarm::Farm& farm = view.batch.farm(0);
  published_episode_ = view.episode_count;
  ToMsg(farm, view.batch.encoder(), view.batch.farms(), view.yaml, context_, spec_message_);
  chart_message_ = ChartToMsg(farm, context_);
  bearings_.assign(bearings_.size(), 0);
}

void FarmPublisher::FillFrames(const ServerView& view) {
  const aquafarm::Farm& farm = view.batch.farm(0);
  const aquafarm::Scenario& scenario = farm.scenario();
  frame_messages_.clear();
  for (std::size_t i = 0; i < farm.ships().size(); ++i) {
    const aquafarm::Ship& ship = farm.ships()[i];
    bearings_[i] = BearingOf(ship.action, bearings_[i]);
    frame_messages_.push_back(
        PoseToMsg(params_.frame_prefix + names::Ship(static_cast<std::int32_t>(i)), ship.cell.x,
                  ship.cell.y, bearings_[i], scenario, context_));
  }
  for (std::size_t i = 0; i < disasters_.size(); ++i) {
    const aquafarm::Disaster& disaster = disasters_[i];
    frame_messages_.push_back(
        PoseToMsg(params_.frame_prefix + names::Disaster(static_cast<std::int32_t>(i)), disaster.x,
                  disaster.y, disaster.heading_deg, scenario, context_));
  }
}

void FarmPublisher::Send() {
  if (params_.publish_clock) {
    clock_.message.clock = context_.stamp;
    clock_.publisher.publish(clock_.message);
    clock_.valid = true;
  }
  const aquafarm::Scenario& scenario = ranch_.scenario();
  if (episode_is_new_) {
    spec_.publish(spec_message_);
    chart_.publish(chart_message_);
    SendSeas();
    if (scenario.origin) {
      static_frames_.sendTransform(EarthToMsg(*scenario.origin, params_.earth_frame, context_));
    }
  }
  state_.publisher.publish(state_.message);
  state_.valid = true;
  if (risk_.publisher.getNumSubscribers() > 0) {
    RiskToMsg(disasters_, scenario, context_, risk_.message);
    risk_.publisher.publish(risk_.message);
    risk_.valid = true;
  } else {
    risk_.valid = false;
  }
  frames_.sendTransform(frame_messages_);
}

// Sea layers are constant. They are sent again at the start of each episode, so that a bag that is
// cut there contains them.
void FarmPublisher::SendSeas() {
  const aquafarm::Scenario& scenario = ranch_.scenario();
  for (std::size_t i = 0; i < seas_.size(); ++i) {
    const aquafarm::SeaLayer& layer = scenario.seas->layers[i];
    nav_msgs::OccupancyGrid grid;
    SeaToMsg(layer, scenario, context_, grid);
    seas_[i].grid.publish(grid);
    seas_[i].values.publish(SeaToMsg(layer, scenario));
  }
}

}  // namespace aquafarm_sim
