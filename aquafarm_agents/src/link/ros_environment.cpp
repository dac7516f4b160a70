// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/link/ros_environment.h"

#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/Outcome.h>
#include <ros/init.h>

#include <algorithm>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/observation/encoder.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_sim/names.h"

namespace aquafarm_agents {
namespace {

namespace names = aquafarm_sim::names;
using aquafarm::EpisodeSummary;
using aquafarm::InputError;
using aquafarm::agents::EnvironmentLost;
using aquafarm::agents::EnvironmentSpec;
using aquafarm::agents::StepResults;
using aquafarm_msgs::Outcome;
using aquafarm_msgs::StepResult;

static_assert(int{StepResult::INDEX} == int{aquafarm::kIndexField});
static_assert(int{StepResult::FEATURES} == int{aquafarm::kFeaturesField});
static_assert(int{StepResult::PLANES} == int{aquafarm::kPlanesField});
static_assert(int{StepResult::HASHES} == int{aquafarm::kHashesField});
static_assert(int{StepResult::TERMS} == int{aquafarm::kTermsField});

// Max number of restarts without a completed episode. More restarts mean that another client uses
// the farms at the same time.
constexpr int kMaxRestarts = 20;
// Observation types that the sim node computes. This class fills StepResults::states itself, with
// copies of the farms made from saved states.
constexpr int kFarmObservationTypes =
    aquafarm::agents::kIndexBit | aquafarm::agents::kFeaturesBit | aquafarm::agents::kPlanesBit;

EnvironmentSpec FromMsg(const aquafarm_msgs::FarmSpec& message) {
  EnvironmentSpec spec;
  spec.scenario_name = message.scenario_name;
  spec.scenario_yaml = message.scenario_yaml;
  spec.scenario_hash = message.scenario_hash;
  spec.version = message.version;
  spec.farms = message.farms;
  spec.agents = message.agents;
  spec.team_reward = message.rewards.team;
  spec.state_count = message.state_count;
  spec.feature_count = message.feature_count;
  const aquafarm::Scenario scenario =
      aquafarm::ParseScenario(message.scenario_yaml, message.scenario_name);
  spec.feature_names = aquafarm::Encoder(scenario).feature_names();
  spec.plane_count = message.plane_count;
  spec.height = message.height;
  spec.width = message.width;
  spec.step_limit = message.step_limit;
  return spec;
}

EpisodeSummary FromMsg(const aquafarm_msgs::EpisodeSummary& message, std::int32_t first_farm) {
  EpisodeSummary summary;
  aquafarm::CopyEpisodeFields(message, summary);
  summary.farm = first_farm + message.farm;
  return summary;
}

std::string Seconds(double seconds) {
  return std::to_string(static_cast<long>(seconds + 0.5)) + " s";
}

}  // namespace

RosEnvironment::RosEnvironment(const ros::NodeHandle& node, RosEnvironmentOptions options)
    : node_(node),
      options_(std::move(options)),
      observation_types_(
          static_cast<std::uint8_t>((options_.observation_types & kFarmObservationTypes) |
                                    (options_.hashes ? int{StepResult::HASHES} : 0))),
      limit_(options_.call_limit_s),
      // The request ids must differ from those of an earlier process with the same node name.
      sequence_(ros::WallTime::now().toNSec()) {
  aquafarm_msgs::GetState::Response now = GetState(0, true);
  if (now.state.pace == aquafarm_msgs::FarmState::PACED) {
    throw InputError(
        "sim node: runs paced, expected pace lockstep; call set_pace, or drive the ships one by "
        "one "
        "(agent.launch)");
  }
  spec_ = FromMsg(now.spec);
  if (options_.farms > 0) spec_.farms = options_.farms;
  share_ = aquafarm::agents::WholeOr(options_.share, spec_.farms);
  own_rewards_ = aquafarm::agents::WantsOwnRewards(options_.observation_types, spec_);
  if (own_rewards_) observation_types_ |= StepResult::TERMS;
  if ((options_.observation_types & aquafarm::agents::kIndexBit) != 0 && spec_.state_count == 0) {
    throw InputError(
        "scenario " + spec_.scenario_name +
        ": too many states for a table, expected a learner with a network; use algorithm auto");
  }
  if ((options_.observation_types & aquafarm::agents::kStatesBit) != 0) {
    copies_ = std::make_unique<aquafarm::FarmBatch>(
        std::make_shared<const aquafarm::Scenario>(
            aquafarm::ParseScenario(spec_.scenario_yaml, spec_.scenario_name)),
        spec_.farms);
    results_.states.resize(static_cast<std::size_t>(spec_.farms));
  }
  Connect<aquafarm_msgs::Step>(step_client_, names::kStep);
  Connect<aquafarm_msgs::Reset>(reset_client_, names::kReset);
  Connect<aquafarm_msgs::SaveState>(save_client_, names::kSaveState);
  Connect<aquafarm_msgs::LoadState>(load_client_, names::kLoadState);
  if (now.spec.farms != spec_.farms) Reset(now.state.seed);
}

const StepResults& RosEnvironment::Reset(std::uint64_t seed, std::uint64_t first_episode) {
  aquafarm_msgs::Reset reset;
  reset.request.has_seed = true;
  reset.request.seed = seed;
  reset.request.has_episode = true;
  reset.request.episode = first_episode + static_cast<std::uint64_t>(share_.first);
  reset.request.stride = static_cast<std::uint32_t>(share_.total);
  reset.request.farms = spec_.farms;
  reset.request.observation_types = observation_types_;
  reset.request.sequence = ++sequence_;
  reset.request.with_spec = true;
  CallOrThrow(reset_client_, names::kReset, reset);
  if (!reset.response.ok) throw InputError("sim node: reset refused: " + reset.response.message);
  if (reset.response.spec.scenario_hash != spec_.scenario_hash) {
    throw InputError("sim node: plays scenario " + reset.response.spec.scenario_name +
                     " now, expected " + spec_.scenario_name + " as before");
  }
  seed_ = seed;
  offset_ = first_episode % static_cast<std::uint64_t>(share_.total);
  next_episode_ = first_episode + static_cast<std::uint64_t>(share_.total);
  Take(reset.response.result);
  return results_;
}

const StepResults& RosEnvironment::Step(const std::vector<std::uint8_t>& actions) {
  AQUAFARM_CHECK_EQ(actions.size(),
                    static_cast<std::size_t>(spec_.farms) * static_cast<std::size_t>(spec_.agents));
  AQUAFARM_CHECK_LE(*std::max_element(actions.begin(), actions.end()),
                    static_cast<int>(aquafarm::Action::kHold));
  step_.request.actions.assign(actions.begin(), actions.end());
  step_.request.observation_types = observation_types_;
  step_.request.sequence = ++sequence_;
  step_.request.state_id = state_id_;
  double waited_s = 0.0;
  Outage outage;
  for (;;) {
    const bool answered = Try(step_client_, names::kStep, step_);
    if (answered && step_.response.ok) break;
    const int code = answered ? int{step_.response.code} : int{Outcome::SHUTTING_DOWN};
    if (code == Outcome::STALE) {
      Restart(step_.response.message);
      return results_;
    }
    if (code == Outcome::SHUTTING_DOWN) {
      WaitForResponse(names::kStep, outage);
    } else if (code == Outcome::PAUSED || code == Outcome::WRONG_PACE || code == Outcome::CLAIMED) {
      outage = {};
      WaitToResume(step_.response.message, waited_s);
    } else {
      throw EnvironmentLost("sim node: step refused: " + step_.response.message);
    }
  }
  Take(step_.response.result);
  if (!results_.finished.empty()) restarts_ = 0;
  for (const EpisodeSummary& ended : results_.finished) {  // its farm now plays episode + total
    next_episode_ =
        std::max(next_episode_, ended.episode + static_cast<std::uint64_t>(share_.total) + 1);
  }
  return results_;
}

// Results with states of the farms need a second call in each step, which saves all farms.
void RosEnvironment::Take(StepResult& result) {
  if (copies_ != nullptr) {
    copies_->Load(Save());
    for (std::int32_t i = 0; i < spec_.farms; ++i) {
      results_.states[static_cast<std::size_t>(i)] = &copies_->farm(i);
    }
  }
  state_id_ = result.state_id;
  aquafarm::VisitStepFields([](const aquafarm::StepField&, auto& to, auto& from) { to.swap(from); },
                            results_, result);
  if (own_rewards_) aquafarm::agents::UseOwnRewards(results_);
  results_.finished.clear();
  for (const auto& summary : result.finished) {
    results_.finished.push_back(FromMsg(summary, share_.first));
  }
}

std::string RosEnvironment::Save() {
  aquafarm_msgs::SaveState save;
  CallOrThrow(save_client_, names::kSaveState, save);
  if (!save.response.ok) throw EnvironmentLost("sim node: save refused: " + save.response.message);
  return {save.response.data.begin(), save.response.data.end()};
}

const StepResults& RosEnvironment::Load(const std::string& bytes) {
  const std::string own = aquafarm::agents::TakeSavedFarms(bytes, share_, spec_.farms);
  if (share_.total != spec_.farms) Reset(seed_);  // sets the stride, which states do not contain
  aquafarm_msgs::LoadState load;
  load.request.data.assign(own.begin(), own.end());
  load.request.observation_types = observation_types_;
  CallOrThrow(load_client_, names::kLoadState, load);
  if (!load.response.ok) throw InputError("sim node: load refused: " + load.response.message);
  ReadProgress();
  Take(load.response.result);
  results_.finished.clear();
  return results_;
}

bool RosEnvironment::ConsumeRestart() { return std::exchange(restarted_, false); }

void RosEnvironment::ReadProgress() {
  for (std::int32_t farm = spec_.farms - 1; farm >= 0; --farm) {
    const auto state = GetState(farm, false).state;
    seed_ = state.seed;
    next_episode_ = std::max(next_episode_, state.episode + 1);
    const auto total = static_cast<std::uint64_t>(share_.total);
    offset_ = (state.episode + total - static_cast<std::uint64_t>(share_.first + farm)) % total;
  }
}

// Returns the first episode of the next round. If other environments have a part of the farms, each
// farm must continue with the episodes of its own index.
std::uint64_t RosEnvironment::NextRound() const {
  if (share_.total == spec_.farms) return next_episode_;
  const auto total = static_cast<std::uint64_t>(share_.total);
  return next_episode_ + (offset_ + total - next_episode_ % total) % total;
}

aquafarm_msgs::GetState::Response RosEnvironment::GetState(std::int32_t farm, bool with_spec) {
  aquafarm_msgs::GetState get;
  get.request.farm = farm;
  get.request.with_spec = with_spec;
  CallOrThrow(get_client_, names::kGetState, get);
  if (!get.response.ok) throw EnvironmentLost("sim node: get_state: " + get.response.message);
  return get.response;
}

void RosEnvironment::Restart(const std::string& why) {
  if (++restarts_ > kMaxRestarts) {
    throw EnvironmentLost("sim node: another client keeps changing the farms: " + why);
  }
  const std::uint64_t next = NextRound();
  Notice("the farms have changed since the last step (" + why +
         "); continuing with new episodes from number " + std::to_string(next));
  Reset(seed_, next);
  restarted_ = true;
}

// Sleeps until the next attempt to call a service. A sim node that has responded before is reported
// as gone at once. One that has not may still be starting, and is reported after a second.
void RosEnvironment::WaitForResponse(const std::string& name, Outage& outage) {
  const ros::WallTime now = ros::WallTime::now();
  if (outage.since.isZero()) outage.since = now;
  const double waited_s = (now - outage.since).toSec();
  const bool was_there = spec_.farms > 0;
  if (!outage.is_reported && (was_there || waited_s >= 1.0)) {
    outage.is_reported = true;
    const std::string limit = "waiting up to " + Seconds(options_.wait_limit_s) + " for ";
    Notice(was_there ? "the sim node is gone; " + limit + "its return"
                     : "no response from service " + node_.resolveName(name) + "; " + limit +
                           "the sim node");
  }
  if (Stopped() || waited_s >= options_.wait_limit_s) {
    throw EnvironmentLost("sim node: no response from service " + node_.resolveName(name) +
                          " for " + Seconds(waited_s));
  }
  Sleep();
}

void RosEnvironment::WaitToResume(const std::string& why, double& waited_s) {
  if (waited_s == 0.0) {
    Notice("waiting up to " + Seconds(options_.pause_limit_s) + " for the sim node: " + why);
  }
  if (Stopped() || waited_s >= options_.pause_limit_s) {
    throw EnvironmentLost("sim node: " + why + "; waited " + Seconds(waited_s));
  }
  Sleep();
  waited_s += kRetryPeriod_s;
}

template <typename Service>
void RosEnvironment::Connect(ros::ServiceClient& client, const std::string& name) {
  client = node_.serviceClient<Service>(name, true);
}

template <typename Service>
bool RosEnvironment::Try(ros::ServiceClient& client, const std::string& name, Service& service) {
  if (!client.isValid()) Connect<Service>(client, name);
  return client.isValid() && limit_.Call(client, service);
}

template <typename Service>
void RosEnvironment::CallOrThrow(ros::ServiceClient& client, const std::string& name,
                                 Service& service) {
  Outage outage;
  while (!Try(client, name, service)) WaitForResponse(name, outage);
}

bool RosEnvironment::Stopped() const {
  return !ros::ok() || (options_.stop != nullptr && *options_.stop);
}

void RosEnvironment::Notice(const std::string& text) const {
  if (options_.on_notice) options_.on_notice(text);
}

void RosEnvironment::Sleep() const { ros::WallDuration(kRetryPeriod_s).sleep(); }

}  // namespace aquafarm_agents
