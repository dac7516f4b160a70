// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/bag/bag_policy.h"

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/PolicyChoice.h>
#include <aquafarm_msgs/SavedState.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/evaluation/greedy_actions.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/version.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_agents/values/values_messages.h"
#include "aquafarm_sim/bags/bag_ranch.h"
#include "aquafarm_sim/bags/close_after_error.h"
#include "aquafarm_sim/bags/read_bag.h"
#include "aquafarm_sim/names.h"

namespace aquafarm_agents {
namespace {

namespace agents = aquafarm::agents;
namespace fs = std::filesystem;
namespace names = aquafarm_sim::names;
using aquafarm::InputError;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;
using aquafarm_msgs::PolicyChoice;
using aquafarm_msgs::SavedState;
using Key = std::pair<std::uint64_t, std::uint64_t>;  // seed and episode

std::string Number(std::uint64_t value) { return std::to_string(value); }

/// Returns the scenario of a spec. @param path path of the bag, for error messages
std::shared_ptr<const aquafarm::Scenario> ScenarioOf(const FarmSpec& spec,
                                                     const std::string& path) {
  return aquafarm_sim::NamingBag(path, [&] {
    return std::make_shared<const aquafarm::Scenario>(
        aquafarm::ParseScenario(spec.scenario_yaml, "spec.scenario_yaml"));
  });
}

/// Simulates a recorded farm again and queries a policy at each state.
class PolicyProbe {
 public:
  /// @param path path of the bag, for error messages
  /// @param rewinds true if the recording may contain external changes (SavedState.msg); the probe
  ///        then stores each state of the episode in which it queries the policy
  /// @throws InputError if the spec contains no valid scenario, or the policy does not fit it
  PolicyProbe(const FarmSpec& spec, const std::string& path, const agents::SavedPolicy& saved,
              bool rewinds)
      : rewinds_(rewinds),
        name_(saved.checkpoint.algorithm),
        scenario_(ScenarioOf(spec, path)),
        farms_(scenario_, 1),
        environment_(scenario_, {1, saved.observation_types, false, 1}),
        policy_(agents::MakePolicy(saved, environment_.spec())),
        elsewhere_(agents::MakePolicy(saved, environment_.spec())) {
    aquafarm_sim::NamingBag(path, [&] { farms_.Reset(spec.seed, spec.episode, {}); });
    policy_->Begin(spec.seed, 1);
    episode_.seed = spec.seed;
    episode_.episode = spec.episode;
    episode_.value_at_start = std::nanf("");
  }

  /// Loads a state after an external change. @returns an error message, or an empty string
  std::string Load(const SavedState& saved) {
    const std::uint64_t step = Step();
    if (begun_ && saved.step > step) return Missing(seen_ ? step + 1 : step, saved.step);
    if (begun_ && saved.step < step) return "steps are out of order";
    try {
      farms_.farm(0).Load(std::string(saved.data.begin(), saved.data.end()));
    } catch (const InputError& error) {
      return std::string("saved_state.data: ") + error.what();
    }
    if (Step() != saved.step) {
      return "saved_state.step: got " + Number(saved.step) + ", its data has " + Number(Step());
    }
    begun_ = true;
    seen_ = false;  // the state after the change follows
    return "";
  }

  /// Simulates the recording up to a state, and compares the hash of the state.
  /// @returns an error message, or an empty string
  std::string Follow(const FarmState& state) {
    const std::uint64_t step = Step();
    const std::uint64_t expected = seen_ ? step + 1 : step;
    if (state.step > expected) return Missing(expected, state.step - 1);
    if (state.step < step) return "steps are out of order";
    if (state.step > step) {
      if (std::string fault = Take(state); !fault.empty()) return fault;
    }
    begun_ = seen_ = true;
    const std::uint64_t hash = farms_.farm(0).Hash();
    if (hash == state.hash) return "";
    return "state.hash: got " + Number(state.hash) + ", simulated " + Number(hash);
  }

  /// Returns whether the last query was for `state`. A ranch may publish a state more than once.
  bool HasAsked(const FarmState& state) const {
    return asked_ > 0 && choice_.step == state.step && asked_hash_ == state.hash;
  }

  /// Queries the policy at the current state of the farm, which `state` describes. Does not repeat
  /// the query if the state is repeated. After an external change the policy starts from the
  /// recurrent state that it had before the queries of this step.
  const PolicyChoice& Ask(const FarmState& state) {
    choice_.header = state.header;
    if (HasAsked(state)) return choice_;
    if (asked_ > 0 && choice_.step == state.step) Rewind();
    choice_.seed = state.seed;
    choice_.episode = state.episode;
    choice_.step = state.step;
    choice_.policy = name_;
    asked_hash_ = state.hash;
    policy_->Act(environment_.CopyStatesFrom({&farms_.farm(0)}), choice_.actions);
    if (rewinds_) asked_states_.push_back(farms_.Save());
    choice_.values = policy_->values();
    value_ = std::nanf("");
    if (!choice_.values.empty()) {
      value_ = std::accumulate(choice_.values.begin(), choice_.values.end(), 0.0F);
    }
    if (asked_++ == 0) episode_.value_at_start = value_;
    value_sum_ += static_cast<double>(value_);
    return choice_;
  }

  std::vector<agents::GreedyAction> Moves() {
    return agents::GreedyActions(farms_.farm(0), elsewhere_->observation_types(), *elsewhere_);
  }

  EpisodeChoices Summary() const {
    EpisodeChoices summary = episode_;
    const aquafarm::Farm& farm = farms_.farm(0);
    summary.steps = Step();
    summary.episode_return = farm.record().episode_return;
    summary.mean_value = asked_ > 0 ? value_sum_ / static_cast<double>(asked_) : std::nan("");
    return summary;
  }

  const aquafarm::Scenario& scenario() const { return *scenario_; }
  bool over() const { return farms_.farm(0).over(); }

 private:
  std::uint64_t Step() const { return static_cast<std::uint64_t>(farms_.farm(0).step()); }

  static std::string Missing(std::uint64_t first, std::uint64_t last) {
    if (first == last) return "step " + Number(first) + " is missing";
    return "steps " + Number(first) + " to " + Number(last) + " are missing";
  }

  /// Undoes the last query.
  void Rewind() {
    asked_states_.pop_back();
    policy_->Begin(episode_.seed, 1);
    std::vector<std::uint8_t> ignored;
    for (const std::string& farms : asked_states_) policy_->Act(environment_.Load(farms), ignored);
    value_sum_ -= static_cast<double>(value_);
    --asked_;
  }

  /// Simulates the step that leads to `state`, with the recorded actions that `state` contains.
  std::string Take(const FarmState& state) {
    if (over()) {
      return "the episode ended with step " + Number(Step()) + ", expected no later one";
    }
    const auto& ships = farms_.farm(0).ships();
    if (state.ships.size() != ships.size()) {
      return "state.ships: got " + Number(state.ships.size()) + " entries, simulated " +
             Number(ships.size());
    }
    std::vector<std::uint8_t> actions;
    for (std::size_t i = 0; i < ships.size(); ++i) {
      const std::uint8_t action = state.ships[i].action;
      if (action > static_cast<std::uint8_t>(aquafarm::Action::kHold)) {
        return "state.ships[" + Number(i) + "].action: got " + Number(action) +
               ", expected [0, 10]";
      }
      actions.push_back(action);
      if (!ships[i].active) continue;
      ++episode_.choices;
      episode_.agreed += choice_.actions[i] == action ? 1 : 0;
    }
    farms_.Step(actions.data(), {});
    return "";
  }

  const bool rewinds_;
  const std::string name_;
  const std::shared_ptr<const aquafarm::Scenario> scenario_;
  aquafarm::FarmBatch farms_;
  agents::LocalEnvironment environment_;
  std::unique_ptr<agents::Policy> policy_;
  std::unique_ptr<agents::Policy> elsewhere_;  // for the maps; has a separate recurrent state
  PolicyChoice choice_;
  EpisodeChoices episode_;
  bool begun_{};  // a message of this episode was read, so `farms_` is at the state of the message
  bool seen_{};   // the current state was read and, unless the episode is over, the policy queried
  std::uint64_t asked_{};
  std::uint64_t asked_hash_{};  // hash of the state of choice_
  std::vector<std::string> asked_states_;
  float value_{};  // sum of choice_.values
  double value_sum_{};
};

/// A bag that is written under a temporary name and renamed when it is complete.
class Output {
 public:
  explicit Output(std::string path) : path_(std::move(path)), beside_(path_ + ".active") {
    try {
      Guard([this] {
        bag_->open(beside_, rosbag::bagmode::Write);
        bag_->setCompression(rosbag::compression::LZ4);
      });
    } catch (...) {
      CloseAfterError();
      throw;
    }
  }
  ~Output() {
    if (!done_) CloseAfterError();
  }
  void Copy(const rosbag::MessageInstance& message) {
    Guard([&] {
      bag_->write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
    });
  }
  /// Writes a message with the time stamp `time` − 1 ns, so that a player publishes it before the
  /// state of `time`.
  template <typename Message>
  void Add(const std::string& topic, ros::Time time, const Message& message) {
    if (time.toNSec() > ros::TIME_MIN.toNSec()) time -= ros::Duration(0, 1);
    Guard([&] { bag_->write(topic, time, message); });
  }
  void Close() {
    Guard([this] {
      bag_->close();
      fs::rename(beside_, path_);
    });
    done_ = true;
  }

 private:
  void CloseAfterError() {
    aquafarm_sim::AbandonBag(std::move(bag_));
    std::error_code ignored;
    fs::remove(beside_, ignored);
  }

  // Converts errors to StorageError, so that they are not reported as errors of the input bag.
  template <typename Work>
  void Guard(const Work& work) const {
    try {
      work();
    } catch (const std::exception& error) {
      throw agents::StorageError(beside_ + ": could not be written: " + error.what());
    }
  }

  const std::string path_;
  const std::string beside_;
  std::unique_ptr<rosbag::Bag> bag_{std::make_unique<rosbag::Bag>()};
  bool done_{};
};

std::map<Key, FarmSpec> ReadSpecs(const rosbag::Bag& bag, const std::string& topic,
                                  const std::string& path) {
  std::map<Key, FarmSpec> specs;
  for (const auto& message : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    const auto spec = aquafarm_sim::Instantiate<FarmSpec>(message);
    if (!spec) continue;
    if (spec->version != aquafarm::kVersion) {
      throw InputError(path + ": " + aquafarm_sim::RecordedBy(spec->version) + ", this is " +
                       aquafarm::kVersion + "; use the version that recorded the bag");
    }
    specs.insert({{spec->seed, spec->episode}, *spec});
  }
  return specs;
}

/// Returns the reason why a policy has no maps of values and actions on farms of a scenario; empty
/// if it has them.
std::string WhyNoMaps(const agents::SavedPolicy& saved, const aquafarm::Scenario& scenario) {
  const std::string& name = saved.checkpoint.algorithm;
  if (saved.observation_types == 0)
    return name + " reads no observation, so it has no values or greedy actions";
  if ((saved.observation_types & agents::kStatesBit) != 0) {
    return name + " reads whole farms, so it has no values and best moves of cells";
  }
  return agents::WhyNoBestMoves(scenario);
}

/// Processes the messages of a bag in order.
class Walk {
 public:
  Walk(std::map<Key, FarmSpec> specs, const agents::SavedPolicy& saved,
       const BagPolicyOptions& options, std::string ranch, std::string path, bool rewinds)
      : specs_(std::move(specs)),
        saved_(saved),
        options_(options),
        ranch_(std::move(ranch)),
        path_(std::move(path)),
        rewinds_(rewinds) {
    if (!options.output.empty()) output_.emplace(options.output);
  }

  /// @returns false at the first difference
  bool Take(const rosbag::MessageInstance& message) {
    bool goes_on = true;
    const std::string& topic = message.getTopic();
    if (topic == ranch_ + names::kSavedState) {
      if (const auto saved = aquafarm_sim::Instantiate<SavedState>(message)) {
        Enter({saved->seed, saved->episode}, saved->step);
        goes_on = Holds(saved->step, probe_->Load(*saved));
      }
    } else if (topic == ranch_ + names::kState) {
      if (const auto state = aquafarm_sim::Instantiate<FarmState>(message)) {
        goes_on = TakeState(*state, message.getTime());
      }
    }
    // Messages of an earlier policy are not copied.
    const bool is_old = topic == ranch_ + names::kChoice || topic == ranch_ + names::kValues ||
                        topic == ranch_ + names::kValuePoints;
    if (goes_on && output_ && !is_old) output_->Copy(message);
    return goes_on;
  }

  BagChoices End() {
    EndEpisode();
    if (result_.episodes.empty() && result_.difference.empty()) {
      throw InputError(path_ + ": got no episode with a spec and states, expected at least one");
    }
    if (output_ && result_.difference.empty()) output_->Close();
    return std::move(result_);
  }

 private:
  bool TakeState(const FarmState& state, const ros::Time& time) {
    Enter({state.seed, state.episode}, state.step);
    if (!Holds(state.step, probe_->Follow(state))) return false;
    if (probe_->over()) return true;
    const bool is_new = !probe_->HasAsked(state);
    const PolicyChoice& choice = probe_->Ask(state);
    if (!output_) return true;
    output_->Add(ranch_ + names::kChoice, time, choice);
    if (is_new && IsMapWanted(state.step)) {
      const auto moves = probe_->Moves();
      const aquafarm::Scenario& scenario = probe_->scenario();
      output_->Add(ranch_ + names::kValues, time, ValuesToGrid(moves, scenario, state.header));
      output_->Add(ranch_ + names::kValuePoints, time,
                   ValuesToPoints(moves, scenario, state.header));
    }
    return true;
  }

  /// Records a fault as the difference. @param fault empty if there is none
  /// @returns true if there is no fault
  bool Holds(std::uint64_t step, const std::string& fault) {
    if (fault.empty()) return true;
    result_.difference = "episode " + Number(key_.second) + " step " + Number(step) + ": " + fault;
    return false;
  }

  bool IsMapWanted(std::uint64_t step) {
    const bool is_asked_for = options_.values_at.empty()
                                  ? options_.values_every > 0 && step % options_.values_every == 0
                                  : options_.values_at.count(step) != 0;
    if (!is_asked_for) return false;
    result_.no_maps = WhyNoMaps(saved_, probe_->scenario());
    return result_.no_maps.empty();
  }

  void Enter(const Key& key, std::uint64_t step) {
    if (probe_ && key == key_ && (step != 0 || probe_->Summary().steps == 0)) return;
    EndEpisode();
    const auto spec = specs_.find(key);
    if (spec == specs_.end()) {
      throw InputError(path_ + ": episode " + Number(key.second) + " of seed " + Number(key.first) +
                       ": the bag has no spec for it");
    }
    key_ = key;
    probe_.emplace(spec->second, path_, saved_, rewinds_);
  }

  void EndEpisode() {
    if (probe_) result_.episodes.push_back(probe_->Summary());
    probe_.reset();
  }

  const std::map<Key, FarmSpec> specs_;
  const agents::SavedPolicy& saved_;
  const BagPolicyOptions& options_;
  const std::string ranch_;
  const std::string path_;
  const bool rewinds_;
  std::optional<Output> output_;
  std::optional<PolicyProbe> probe_;
  Key key_;
  BagChoices result_;
};

}  // namespace

BagChoices AskAlong(const std::string& path, const agents::SavedPolicy& policy,
                    const BagPolicyOptions& options) {
  return aquafarm_sim::ReadingBag(path, [&] {
    rosbag::Bag bag;
    aquafarm_sim::OpenBag<FarmSpec, FarmState, SavedState>(bag, path);
    rosbag::View all(bag);
    const auto connections = all.getConnections();
    const bool rewinds = std::any_of(connections.begin(), connections.end(), [](const auto* one) {
      return one->datatype == ros::message_traits::datatype<SavedState>();
    });
    const std::string ranch = aquafarm_sim::FindRanch(bag, path, options.ns);
    std::error_code ignored;
    if (!options.output.empty() && fs::equivalent(path, options.output, ignored)) {
      throw InputError(options.output + ": is the input bag, expected another file");
    }
    Walk walk(ReadSpecs(bag, ranch + names::kSpec, path), policy, options, ranch, path, rewinds);
    for (const rosbag::MessageInstance& message : all) {
      if (!walk.Take(message)) break;
    }
    return walk.End();
  });
}

}  // namespace aquafarm_agents
