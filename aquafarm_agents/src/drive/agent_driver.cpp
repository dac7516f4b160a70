// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/drive/agent_driver.h"

#include <aquafarm_msgs/Command.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/GetState.h>
#include <aquafarm_msgs/Outcome.h>
#include <aquafarm_msgs/Reset.h>
#include <ros/callback_queue.h>
#include <ros/console.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_agents/link/service_link.h"
#include "aquafarm_agents/link/ship_claim.h"
#include "aquafarm_agents/link/slow_warning.h"
#include "aquafarm_sim/checked_topics.h"
#include "aquafarm_sim/convert/observation.h"
#include "aquafarm_sim/names.h"

namespace aquafarm_agents {
namespace {

namespace names = aquafarm_sim::names;
using namespace aquafarm::agents;  // NOLINT: the file uses most of its names
using aquafarm::InputError;
using aquafarm_msgs::FarmState;
using aquafarm_msgs::Outcome;

// After this time without a new observation, the command for the last observation is repeated.
constexpr double kSilence_s = 2.0;
constexpr std::uint32_t kQueue = 10;

}  // namespace

class AgentDriver::Impl {
 public:
  Impl(const ros::NodeHandle& node, std::uint8_t observation_types, AgentDriverOptions options)
      : options_(options),
        observation_types_(observation_types),
        node_(node),
        get_(node, options.wait_limit_s, options.stop),
        reset_(node, options.wait_limit_s, options.stop) {
    aquafarm_msgs::GetState get;
    get.request.with_spec = true;
    get_.Call(names::kGetState, get);
    if (!get.response.ok) throw EnvironmentLost("sim node: get_state: " + get.response.message);
    const aquafarm_msgs::FarmSpec& spec = get.response.spec;
    scenario_ = std::make_shared<const aquafarm::Scenario>(
        aquafarm::ParseScenario(spec.scenario_yaml, spec.scenario_name));
    if (options_.ship < 0 || options_.ship >= spec.agents) {
      throw InputError("~ship: got " + std::to_string(options_.ship) +
                       ", expected -1 for all, or [0, " + std::to_string(spec.agents - 1) + "]");
    }
    farm_ = std::make_unique<aquafarm::Farm>(scenario_);
    encoder_ = std::make_unique<aquafarm::Encoder>(*scenario_);
    spec_ = MakeSpec(*scenario_, *encoder_, 1);
    if ((observation_types_ & kIndexBit) != 0 && spec_.state_count == 0) {
      throw InputError("policy: scenario " + spec_.scenario_name +
                       " has too many states for its table, expected a policy with a network");
    }
    SizeResults();
    const double limit_s = CommandLimit_s(get.response.barrier_timeout_s);
    command_.emplace(node_, options_.wait_limit_s, options_.stop, limit_s);
  }

  const EnvironmentSpec& spec() const { return spec_; }

  std::vector<bool> Drive(Policy& policy, std::uint64_t seed, std::int32_t episodes) {
    std::vector<bool> ended;
    try {
      DriveEpisodes(policy, seed, episodes, ended);
    } catch (const EnvironmentLost&) {
      if (!Stopped()) throw;  // after a stop, the most likely cause is the call that was stopped
    }
    return ended;
  }

 private:
  bool Stopped() const { return !ros::ok() || (options_.stop != nullptr && *options_.stop); }

  void DriveEpisodes(Policy& policy, std::uint64_t seed, std::int32_t episodes,
                     std::vector<bool>& ended) {
    Board();
    policy.Begin(seed, 1);
    const auto is_done = [&] {
      return episodes != 0 && ended.size() >= static_cast<std::size_t>(episodes);
    };
    while (!Stopped() && !is_done()) {
      const FarmState::ConstPtr now = WaitForObservation();
      for (const FarmState::ConstPtr& over : std::exchange(over_, {})) {
        const bool success = over->reason == FarmState::ALL_RETRIEVED;
        ROS_INFO("episode %llu: %s, return %.1f", static_cast<unsigned long long>(over->episode),
                 success ? "all retrieved" : "over", static_cast<double>(over->joint_return));
        if (acted_in_ == std::pair(over->seed, over->episode)) ended.push_back(success);
        // A late agent must not reset an episode that the others have started meanwhile.
        const bool is_now = newest_->seed == over->seed && newest_->episode == over->episode;
        if (is_now) StartNext(*over);
      }
      if (is_done() || !now || now->reason != FarmState::NONE) continue;
      if (!now->ships[static_cast<std::size_t>(options_.ship)].active) continue;
      if (now != acted_on_) {  // else the last actions are repeated; the policy must not act twice
        Look(*now);
        policy.Act(results_, actions_);
        acted_on_ = now;
      }
      Send(*now, actions_[static_cast<std::size_t>(options_.ship)]);
    }
  }

  void SizeResults() {
    const auto agents = static_cast<std::size_t>(spec_.agents);
    results_.rewards.resize(agents);
    results_.outcomes.resize(agents);
    results_.legal.assign(agents, aquafarm::kMoveMask);
    results_.active.assign(agents, 0);
    results_.active[static_cast<std::size_t>(options_.ship)] = 1;
    results_.end_reasons.resize(1);
    results_.is_first.assign(1, 1);
    if ((observation_types_ & kIndexBit) != 0) results_.index.resize(agents);
    if ((observation_types_ & kFeaturesBit) != 0) {
      results_.features.resize(agents * static_cast<std::size_t>(spec_.feature_count));
    }
    if ((observation_types_ & kPlanesBit) != 0)
      results_.planes.resize(agents * encoder_->planes_size());
  }

  void Board() {
    claim_.emplace(node_, options_.ship, options_.wait_limit_s, options_.stop);
    node_.setCallbackQueue(&queue_);
    observation_ = aquafarm_sim::Subscribe<FarmState>(
        node_, names::Observation(options_.ship), kQueue,
        [this](const FarmState::ConstPtr& message) { Take(message); },
        ros::TransportHints().tcpNoDelay());
  }

  // Stores ended episodes, because another ship's agent may start the next one before this agent
  // processes the end.
  void Take(const FarmState::ConstPtr& message) {
    newest_ = message;
    if (message->reason == FarmState::NONE) {
      over_seen_.reset();  // the same episode may be played again
      return;
    }
    if (over_seen_ && *over_seen_ == std::pair(message->seed, message->episode)) return;
    over_seen_ = {message->seed, message->episode};
    over_.push_back(message);
  }

  // Waits for a new observation. Returns the last one again if its command must be repeated.
  // Returns null if no observation arrives within kSilence_s, or if the driver is stopped.
  FarmState::ConstPtr WaitForObservation() {
    const ros::WallTime start = ros::WallTime::now();
    while (!Stopped()) {
      queue_.callAvailable(ros::WallDuration(0.05));
      claim_->RenewWhenDue();
      if (newest_ && (again_ || newest_ != seen_)) {
        seen_ = newest_;
        again_ = false;
        return newest_;
      }
      if ((ros::WallTime::now() - start).toSec() < kSilence_s) continue;
      again_ = true;  // the command may be lost; a superfluous retry returns STALE
      return nullptr;
    }
    return nullptr;
  }

  // The layout follows from seed and episode number. All other inputs are in the observation.
  void Look(const FarmState& message) {
    if (farm_->seed() != message.seed || farm_->episode() != message.episode) {
      farm_->Reset(message.seed, message.episode);
      results_.is_first[0] = 1;
    }
    if (message.step == 0) results_.is_first[0] = 1;  // also if the same episode is restarted
    const auto ship = static_cast<std::size_t>(options_.ship);
    aquafarm_sim::FromMsg(message, *scenario_, farm_->layout(), view_);
    results_.legal[ship] = message.ships[ship].legal_actions;
    results_.rewards[ship] = message.ships[ship].reward;
    if (!results_.index.empty()) results_.index[ship] = encoder_->Index(view_);
    if (!results_.features.empty()) {
      encoder_->Features(
          view_, results_.features.data() + ship * static_cast<std::size_t>(spec_.feature_count));
    }
    if (!results_.planes.empty()) {
      encoder_->Planes(view_, results_.planes.data() + ship * encoder_->planes_size());
    }
  }

  // Paced farms start their next episode by themselves.
  void StartNext(const FarmState& over) {
    results_.is_first[0] = 1;
    if (over.pace == FarmState::PACED) return;
    aquafarm_msgs::Reset reset;
    reset.request.only_if_over = true;
    reset_.Call(names::kReset, reset);
    if (!reset.response.ok) throw EnvironmentLost("sim node: reset: " + reset.response.message);
  }

  void Send(const FarmState& now, std::uint8_t action) {
    results_.is_first[0] = 0;
    acted_in_ = {now.seed, now.episode};
    aquafarm_msgs::Command command;
    command.request.ship = options_.ship;
    command.request.action = action;
    command.request.episode = now.episode;
    command.request.step = now.step;
    command.request.token = ++token_;  // a retry after a lost connection is not executed again
    command_->Call(names::kCommand, command);
    const auto& result = command.response.result;
    switch (result.code) {
      case Outcome::STALE:  // the command is late; the next observation contains the current state
      case Outcome::EPISODE_OVER:
      case Outcome::SUPERSEDED:
        return;
      case Outcome::TIMEOUT:
      case Outcome::PAUSED:
        again_ = true;  // the command was dropped
        warning_.Say("ship " + std::to_string(options_.ship) + ": " + result.message);
        ros::WallDuration(0.1).sleep();
        return;
      case Outcome::CLAIMED:
        throw InputError("~ship: " + result.message);
      default:
        if (!result.ok) throw EnvironmentLost("sim node: command refused: " + result.message);
    }
  }

  const AgentDriverOptions options_;
  const std::uint8_t observation_types_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ServiceLink get_;
  ServiceLink reset_;
  std::optional<ServiceLink> command_;
  std::optional<ShipClaim> claim_;
  SlowWarning warning_;
  std::shared_ptr<const aquafarm::Scenario> scenario_;
  std::unique_ptr<aquafarm::Farm> farm_;  // used only for its layout
  std::unique_ptr<aquafarm::Encoder> encoder_;
  EnvironmentSpec spec_;
  aquafarm::View view_;
  StepResults results_;  // of one farm; only the entries of this ship are filled
  std::vector<std::uint8_t> actions_;
  FarmState::ConstPtr newest_;
  std::vector<FarmState::ConstPtr> over_;  // last states of ended, unprocessed episodes
  std::optional<std::pair<std::uint64_t, std::uint64_t>> over_seen_;  // seed and episode
  FarmState::ConstPtr acted_on_;  // observation from which the policy chose actions_
  FarmState::ConstPtr seen_;      // last observation returned by WaitForObservation
  std::optional<std::pair<std::uint64_t, std::uint64_t>> acted_in_;  // seed and episode
  bool again_{};
  std::uint64_t token_{ros::WallTime::now().toNSec()};
  ros::Subscriber observation_;
};

AgentDriver::AgentDriver(const ros::NodeHandle& node, std::uint8_t observation_types,
                         AgentDriverOptions options)
    : impl_(std::make_unique<Impl>(node, observation_types, options)) {}

AgentDriver::~AgentDriver() = default;

const EnvironmentSpec& AgentDriver::spec() const { return impl_->spec(); }

std::vector<bool> AgentDriver::Drive(Policy& policy, std::uint64_t seed, std::int32_t episodes) {
  return impl_->Drive(policy, seed, episodes);
}

}  // namespace aquafarm_agents
