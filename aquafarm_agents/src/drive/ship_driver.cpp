// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/drive/ship_driver.h"

#include <aquafarm_msgs/Command.h>
#include <aquafarm_msgs/EpisodeSummary.h>
#include <aquafarm_msgs/GetState.h>
#include <aquafarm_msgs/Outcome.h>
#include <aquafarm_msgs/Reset.h>
#include <aquafarm_msgs/SaveState.h>
#include <ros/callback_queue.h>
#include <ros/console.h>
#include <ros/init.h>

#include <future>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_agents/link/call_limit.h"
#include "aquafarm_agents/link/service_link.h"
#include "aquafarm_agents/link/ship_claim.h"
#include "aquafarm_agents/link/slow_warning.h"
#include "aquafarm_sim/checked_topics.h"
#include "aquafarm_sim/names.h"

namespace aquafarm_agents {
namespace {

namespace names = aquafarm_sim::names;
using namespace aquafarm::agents;  // NOLINT: the file uses most of its names
using aquafarm::EpisodeSummary;
using aquafarm::InputError;
using aquafarm_msgs::Outcome;

constexpr double kPollPeriod_s = 0.01;
constexpr double kSummaryLimit_s = 1.0;  // max wait for the summary of an ended episode
constexpr std::uint32_t kMaxSummaries = 100;

}  // namespace

class ShipDriver::Impl {
 public:
  Impl(const ros::NodeHandle& node, std::uint8_t observation_types, ShipDriverOptions options)
      : options_(options),
        node_(node),
        get_(node, options_.wait_limit_s, options_.stop),
        save_(node, options_.wait_limit_s, options_.stop),
        reset_(node, options_.wait_limit_s, options_.stop) {
    aquafarm_msgs::GetState get;
    get.request.with_spec = true;
    get_.Call(names::kGetState, get);
    if (!get.response.ok) throw EnvironmentLost("sim node: get_state: " + get.response.message);
    const aquafarm_msgs::FarmSpec& spec = get.response.spec;
    auto scenario = std::make_shared<const aquafarm::Scenario>(
        aquafarm::ParseScenario(spec.scenario_yaml, spec.scenario_name));
    EnvironmentOptions mirror;
    mirror.farms = spec.farms;
    mirror.observation_types = observation_types;
    mirror_ = std::make_unique<LocalEnvironment>(std::move(scenario), mirror);
    if (options_.ship >= spec.agents || options_.ship < -1) {
      throw InputError("~ship: got " + std::to_string(options_.ship) +
                       ", expected -1 for all, or [0, " + std::to_string(spec.agents - 1) + "]");
    }
    for (std::int32_t ship = 0; ship < spec.agents; ++ship) {
      if (options_.ship >= 0 && ship != options_.ship) continue;
      ships_.push_back(ship);
      commands_.push_back(
          std::make_unique<ServiceLink>(node, options_.wait_limit_s, options_.stop,
                                        CommandLimit_s(get.response.barrier_timeout_s)));
    }
    topics_.setCallbackQueue(&queue_);
    summaries_ = aquafarm_sim::Subscribe<aquafarm_msgs::EpisodeSummary>(
        topics_, names::kEpisode, kMaxSummaries,
        [this](const aquafarm_msgs::EpisodeSummary::ConstPtr& message) { Take(*message); });
  }

  const EnvironmentSpec& spec() const { return mirror_->spec(); }

  std::vector<EpisodeSummary> Drive(Policy& policy, std::uint64_t seed, std::int32_t episodes) {
    std::vector<EpisodeSummary> ended;
    try {
      DriveEpisodes(policy, seed, episodes, ended);
    } catch (const EnvironmentLost&) {
      if (!Stopped()) throw;  // after a stop, the most likely cause is the call that was stopped
    }
    claim_.reset();
    return ended;
  }

 private:
  bool Stopped() const { return !ros::ok() || (options_.stop != nullptr && *options_.stop); }

  void DriveEpisodes(Policy& policy, std::uint64_t seed, std::int32_t episodes,
                     std::vector<EpisodeSummary>& ended) {
    if (options_.ship >= 0) {
      claim_.emplace(node_, options_.ship, options_.wait_limit_s, options_.stop);
    }
    policy.Begin(seed, spec().farms);
    while (!Stopped() && (episodes == 0 || ended.size() < static_cast<std::size_t>(episodes))) {
      if (claim_) claim_->RenewWhenDue();
      const StepResults& results = Look();
      const aquafarm::Farm& farm = mirror_->batch().farm(0);
      const std::pair now{farm.seed(), farm.episode()};
      if (acted_in_ && *acted_in_ != now) {
        if (auto missed = FindMissed()) ended.push_back(*missed);
        continue;
      }
      const bool is_new = !seen_ || seen_->first != farm.episode() ||
                          seen_->second != static_cast<std::uint64_t>(farm.step());
      if (!is_new) {
        WaitForChange();
        continue;
      }
      seen_ = {farm.episode(), static_cast<std::uint64_t>(farm.step())};
      if (farm.over()) {
        ended.push_back(SummaryOf(farm.record(), 0));
        Report(ended.back());
        acted_in_.reset();
        StartNext();
        continue;
      }
      policy.Act(results, actions_);
      if (!acted_in_) queue_.callAvailable();  // skips the summaries of earlier episodes
      acted_in_ = now;
      Send();
      if (stale_.exchange(false)) seen_.reset();  // a new state may have the same episode and step
      if (!again_.exchange(false)) continue;
      seen_.reset();
      ros::WallDuration(kRetryPeriod_s).sleep();
    }
  }

  // Another driver may have started the next episode before this driver saw the end of its episode.
  // Without this summary the driver would play an episode too many, which its partners do not play.
  // Returns the summary of the episode of the last command, or nothing if a reset aborted it.
  std::optional<EpisodeSummary> FindMissed() {
    const ros::WallTime start = ros::WallTime::now();
    while (!missed_ && !Stopped() && (ros::WallTime::now() - start).toSec() < kSummaryLimit_s) {
      queue_.callAvailable(ros::WallDuration(kPollPeriod_s));
    }
    acted_in_.reset();
    if (missed_) Report(*missed_);
    return std::exchange(missed_, std::nullopt);
  }

  void Take(const aquafarm_msgs::EpisodeSummary& message) {
    if (message.farm != 0 || acted_in_ != std::pair(message.seed, message.episode)) return;
    missed_.emplace();
    aquafarm::CopyEpisodeFields(message, *missed_);
  }

  const StepResults& Look() {
    aquafarm_msgs::SaveState save;
    save_.Call(names::kSaveState, save);
    if (!save.response.ok) throw EnvironmentLost("sim node: save_state: " + save.response.message);
    return mirror_->Load({save.response.data.begin(), save.response.data.end()});
  }

  aquafarm_msgs::FarmState State() {
    aquafarm_msgs::GetState get;
    get_.Call(names::kGetState, get);
    if (!get.response.ok) throw EnvironmentLost("sim node: get_state: " + get.response.message);
    return get.response.state;
  }

  void WaitForChange() {
    while (!Stopped()) {
      ros::WallDuration(kPollPeriod_s).sleep();
      if (claim_) claim_->RenewWhenDue();
      const aquafarm_msgs::FarmState state = State();
      if (state.episode != seen_->first || state.step != seen_->second) return;
    }
  }

  // Paced farms start their next episode by themselves.
  void StartNext() {
    if (State().pace == aquafarm_msgs::FarmState::PACED) return;
    aquafarm_msgs::Reset reset;
    reset.request.only_if_over = true;  // several drivers may request it
    reset_.Call(names::kReset, reset);
    if (!reset.response.ok) throw EnvironmentLost("sim node: reset: " + reset.response.message);
  }

  // In lockstep each ship's call waits for the other ships, so the calls are made in parallel.
  void Send() {
    std::vector<std::future<void>> calls;
    for (std::size_t i = 1; i < ships_.size(); ++i) {
      calls.push_back(std::async(std::launch::async, [this, i] { SendOne(i); }));
    }
    SendOne(0);
    for (auto& call : calls) call.get();
  }

  void SendOne(std::size_t i) {
    aquafarm_msgs::Command command;
    command.request.ship = ships_[i];
    command.request.action = actions_[static_cast<std::size_t>(ships_[i])];
    command.request.episode = seen_->first;
    command.request.step = seen_->second;
    command.request.token = ++token_;  // a retry after a lost connection is not executed again
    commands_[i]->Call(names::kCommand, command);
    const std::uint8_t code = command.response.result.code;
    // After a late or superseded command the driver continues with the farm's current state.
    const bool usual = command.response.result.ok || code == Outcome::STALE ||
                       code == Outcome::EPISODE_OVER || code == Outcome::PAUSED ||
                       code == Outcome::TIMEOUT || code == Outcome::SUPERSEDED;
    if (code == Outcome::CLAIMED) throw InputError("~ship: " + command.response.result.message);
    if (!usual) {
      throw EnvironmentLost("sim node: command refused: " + command.response.result.message);
    }
    if (code == Outcome::STALE) stale_ = true;
    if (code == Outcome::TIMEOUT || code == Outcome::PAUSED) {
      again_ = true;  // the command was dropped
      warning_.Say("ship " + std::to_string(ships_[i]) + ": " + command.response.result.message);
    }
  }

  static void Report(const EpisodeSummary& result) {
    ROS_INFO("episode %llu: %s, return %.1f, %d of %d delivered in %d steps",
             static_cast<unsigned long long>(result.episode),
             std::string(ToString(result.reason)).c_str(),
             static_cast<double>(result.episode_return), result.delivered, result.devices,
             result.steps);
  }

  const ShipDriverOptions options_;
  const ros::NodeHandle node_;
  ServiceLink get_;
  ServiceLink save_;
  ServiceLink reset_;
  std::optional<ShipClaim> claim_;  // set while Drive steers a single ship
  std::vector<std::int32_t> ships_;
  std::vector<std::unique_ptr<ServiceLink>> commands_;  // one per ship
  std::unique_ptr<LocalEnvironment> mirror_;
  std::vector<std::uint8_t> actions_;
  std::atomic<bool> again_{};  // a command was dropped: Drive must send it again
  std::atomic<bool> stale_{};  // a command was meant for another state
  std::atomic<std::uint64_t> token_{ros::WallTime::now().toNSec()};  // token of the last command
  SlowWarning warning_;
  std::optional<std::pair<std::uint64_t, std::uint64_t>> seen_;  // episode and step
  // Seed and episode of the last command, until the end of the episode is known.
  std::optional<std::pair<std::uint64_t, std::uint64_t>> acted_in_;
  std::optional<EpisodeSummary> missed_;  // the summary of acted_in_, as published
  ros::NodeHandle topics_{node_};
  ros::CallbackQueue queue_;
  ros::Subscriber summaries_;
};

ShipDriver::ShipDriver(const ros::NodeHandle& node, std::uint8_t observation_types,
                       ShipDriverOptions options)
    : impl_(std::make_unique<Impl>(node, observation_types, options)) {}

ShipDriver::~ShipDriver() = default;

const EnvironmentSpec& ShipDriver::spec() const { return impl_->spec(); }

std::vector<EpisodeSummary> ShipDriver::Drive(Policy& policy, std::uint64_t seed,
                                              std::int32_t episodes) {
  return impl_->Drive(policy, seed, episodes);
}

}  // namespace aquafarm_agents
