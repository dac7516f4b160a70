// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/bag_policy.h"

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/PolicyChoice.h>
#include <aquafarm_msgs/SavedState.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "aquafarm/agents/best_moves.h"
#include "aquafarm/agents/local_environment.h"
#include "aquafarm/agents/storage.h"
#include "aquafarm/check.h"
#include "aquafarm/scenario_yaml.h"
#include "aquafarm/version.h"
#include "aquafarm_agents/values_messages.h"
#include "aquafarm_sim/bag_ranch.h"
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

/// A farm as recorded, and a policy that is asked along.
class Companion {
 public:
  /// @throws InputError when the policy does not fit
  Companion(const FarmSpec& spec, const agents::SavedPolicy& saved)
      : name_(saved.checkpoint.algorithm),
        scenario_(std::make_shared<const aquafarm::Scenario>(
            aquafarm::ParseScenario(spec.scenario_yaml, "spec.scenario_yaml"))),
        farms_(scenario_, 1),
        environment_(scenario_, {1, saved.encodings, false, 1}),
        policy_(agents::MakePolicy(saved, environment_.spec())),
        elsewhere_(agents::MakePolicy(saved, environment_.spec())) {
    farms_.Reset(spec.seed, spec.episode, {});
    policy_->Begin(spec.seed, 1);
    episode_.seed = spec.seed;
    episode_.episode = spec.episode;
    episode_.value_at_start = std::nanf("");
  }

  void Load(const SavedState& saved) {
    farms_.farm(0).Load(std::string(saved.data.begin(), saved.data.end()));
  }

  /// Follows the recording to a state. @returns why it cannot, or nothing
  std::string Follow(const FarmState& state) {
    const aquafarm::Farm& farm = farms_.farm(0);
    const auto step = static_cast<std::uint64_t>(farm.step());
    if (state.step == step + 1 && !farm.over()) {
      if (std::string fault = Step(state); !fault.empty()) return fault;
    } else if (state.step != step) {
      return "step " + Number(step + 1) + " is missing";
    }
    if (farm.Hash() == state.hash) return "";
    return "state.hash: got " + Number(state.hash) + ", simulated " + Number(farm.Hash());
  }

  /// Asks for the state where the farm stands.
  const PolicyChoice& Ask(const FarmState& state) {
    choice_.header = state.header;
    choice_.seed = state.seed;
    choice_.episode = state.episode;
    choice_.step = state.step;
    choice_.policy = name_;
    policy_->Act(environment_.Load(farms_.Save()), choice_.actions);
    choice_.values = policy_->values();
    float value = std::nanf("");
    if (!choice_.values.empty()) {
      value = std::accumulate(choice_.values.begin(), choice_.values.end(), 0.0F);
    }
    if (asked_++ == 0) episode_.value_at_start = value;
    value_sum_ += static_cast<double>(value);
    return choice_;
  }

  std::vector<agents::BestMove> Moves() {
    return agents::BestMoves(farms_.farm(0), elsewhere_->encodings(), *elsewhere_);
  }

  EpisodeChoices Summary() const {
    EpisodeChoices summary = episode_;
    const aquafarm::Farm& farm = farms_.farm(0);
    summary.steps = static_cast<std::uint64_t>(farm.step());
    summary.episode_return = farm.record().episode_return;
    summary.mean_value = asked_ > 0 ? value_sum_ / static_cast<double>(asked_) : std::nan("");
    return summary;
  }

  const aquafarm::Scenario& scenario() const { return *scenario_; }
  bool over() const { return farms_.farm(0).over(); }

 private:
  std::string Step(const FarmState& state) {
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
      if (!ships[i].in_play || choice_.step + 1 != state.step) continue;
      ++episode_.choices;
      episode_.agreed += choice_.actions[i] == action ? 1 : 0;
    }
    farms_.Step(actions.data(), {});
    return "";
  }

  const std::string name_;
  const std::shared_ptr<const aquafarm::Scenario> scenario_;
  aquafarm::FarmBatch farms_;
  agents::LocalEnvironment environment_;
  std::unique_ptr<agents::Policy> policy_;
  std::unique_ptr<agents::Policy> elsewhere_;  // for the maps: its memory is not the episode's
  PolicyChoice choice_;
  EpisodeChoices episode_;
  std::uint64_t asked_{};
  double value_sum_{};
};

/// A bag written beside its place and renamed when it is whole.
class Output {
 public:
  explicit Output(std::string path) : path_(std::move(path)), beside_(path_ + ".active") {
    Guard([this] {
      bag_.open(beside_, rosbag::bagmode::Write);
      bag_.setCompression(rosbag::compression::LZ4);
    });
  }
  ~Output() {
    if (done_) return;
    bag_.close();
    std::error_code ignored;
    fs::remove(beside_, ignored);
  }
  void Copy(const rosbag::MessageInstance& message) {
    Guard([&] {
      bag_.write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
    });
  }
  /// Just before a time, so that it is there when the state of that time is shown.
  template <typename Message>
  void Add(const std::string& topic, ros::Time time, const Message& message) {
    if (time.toNSec() > ros::TIME_MIN.toNSec()) time -= ros::Duration(0, 1);
    Guard([&] { bag_.write(topic, time, message); });
  }
  void Close() {
    Guard([this] {
      bag_.close();
      fs::rename(beside_, path_);
    });
    done_ = true;
  }

 private:
  // What goes wrong in writing is no fault of the bag that is read.
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
  rosbag::Bag bag_;
  bool done_{};
};

/// @throws InputError when the bag's messages are not those of this version
template <typename Message>
void CheckMessage(const rosbag::ConnectionInfo& connection, const std::string& path) {
  namespace traits = ros::message_traits;
  if (connection.datatype != traits::datatype<Message>() ||
      connection.md5sum == traits::md5sum<Message>()) {
    return;
  }
  throw InputError(path + ": topic " + connection.topic + " has another " + connection.datatype +
                   " than this version; use the version that it was recorded by");
}

std::map<Key, FarmSpec> ReadSpecs(const rosbag::Bag& bag, const std::string& topic,
                                  const std::string& path) {
  std::map<Key, FarmSpec> specs;
  for (const auto& message : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    const auto spec = message.instantiate<FarmSpec>();
    if (!spec) continue;
    if (spec->version != aquafarm::kVersion) {
      throw InputError(path + ": recorded by version " + spec->version + ", this is " +
                       aquafarm::kVersion + "; use the version that it was recorded by");
    }
    specs.insert({{spec->seed, spec->episode}, *spec});
  }
  return specs;
}

/// Goes through the messages of a bag, in order.
class Walk {
 public:
  Walk(std::map<Key, FarmSpec> specs, const agents::SavedPolicy& saved,
       const BagPolicyOptions& options, std::string ranch, std::string path)
      : specs_(std::move(specs)),
        saved_(saved),
        options_(options),
        ranch_(std::move(ranch)),
        path_(std::move(path)) {
    if (!options.output.empty()) output_.emplace(options.output);
  }

  /// @returns false at the first difference
  bool Take(const rosbag::MessageInstance& message) {
    bool goes_on = true;
    const std::string& topic = message.getTopic();
    if (topic == ranch_ + names::kSavedState) {
      if (const auto saved = message.instantiate<SavedState>()) {
        Enter({saved->seed, saved->episode}, saved->step);
        companion_->Load(*saved);
      }
    } else if (topic == ranch_ + names::kState) {
      if (const auto state = message.instantiate<FarmState>()) {
        goes_on = TakeState(*state, message.getTime());
      }
    }
    // What an earlier policy left is not copied along.
    const bool is_old = topic == ranch_ + names::kChoice || topic == ranch_ + names::kValues ||
                        topic == ranch_ + names::kValuePoints;
    if (goes_on && output_ && !is_old) output_->Copy(message);
    return goes_on;
  }

  BagChoices End() {
    EndEpisode();
    if (result_.episodes.empty() && result_.difference.empty()) {
      throw InputError(path_ + ": no state follows its spec");
    }
    if (output_ && result_.difference.empty()) output_->Close();
    return std::move(result_);
  }

 private:
  bool TakeState(const FarmState& state, const ros::Time& time) {
    Enter({state.seed, state.episode}, state.step);
    const std::string fault = companion_->Follow(state);
    if (!fault.empty()) {
      result_.difference =
          "episode " + Number(state.episode) + " step " + Number(state.step) + ": " + fault;
      return false;
    }
    if (companion_->over()) return true;
    const PolicyChoice& choice = companion_->Ask(state);
    if (!output_) return true;
    output_->Add(ranch_ + names::kChoice, time, choice);
    const bool has_values = !choice.values.empty();
    if (has_values && options_.values_every > 0 && state.step % options_.values_every == 0) {
      const auto moves = companion_->Moves();
      const aquafarm::Scenario& scenario = companion_->scenario();
      output_->Add(ranch_ + names::kValues, time, ValuesToGrid(moves, scenario, state.header));
      output_->Add(ranch_ + names::kValuePoints, time,
                   ValuesToPoints(moves, scenario, state.header));
    }
    return true;
  }

  void Enter(const Key& key, std::uint64_t step) {
    if (companion_ && key == key_ && (step != 0 || companion_->Summary().steps == 0)) return;
    EndEpisode();
    const auto spec = specs_.find(key);
    if (spec == specs_.end()) {
      throw InputError(path_ + ": episode " + Number(key.second) + " of seed " + Number(key.first) +
                       ": the bag holds no spec of it");
    }
    key_ = key;
    companion_.emplace(spec->second, saved_);
  }

  void EndEpisode() {
    if (companion_) result_.episodes.push_back(companion_->Summary());
    companion_.reset();
  }

  const std::map<Key, FarmSpec> specs_;
  const agents::SavedPolicy& saved_;
  const BagPolicyOptions& options_;
  const std::string ranch_;
  const std::string path_;
  std::optional<Output> output_;
  std::optional<Companion> companion_;
  Key key_;
  BagChoices result_;
};

}  // namespace

BagChoices AskAlong(const std::string& path, const agents::SavedPolicy& policy,
                    const BagPolicyOptions& options) {
  try {
    rosbag::Bag bag(path, rosbag::bagmode::Read);
    rosbag::View all(bag);
    for (const auto* connection : all.getConnections()) {
      CheckMessage<FarmSpec>(*connection, path);
      CheckMessage<FarmState>(*connection, path);
      CheckMessage<SavedState>(*connection, path);
    }
    const std::string ranch = aquafarm_sim::FindRanch(bag, path, options.ns);
    std::error_code ignored;
    if (!options.output.empty() && fs::equivalent(path, options.output, ignored)) {
      throw InputError(options.output + ": is the bag that is read; expected another file");
    }
    Walk walk(ReadSpecs(bag, ranch + names::kSpec, path), policy, options, ranch, path);
    for (const rosbag::MessageInstance& message : all) {
      if (!walk.Take(message)) break;
    }
    return walk.End();
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError(path + ": its recording was killed; 'rosbag reindex' it first");
  } catch (const rosbag::BagException& error) {
    throw InputError(path + ": damaged or no bag: " + error.what());
  } catch (const ros::Exception& error) {
    throw InputError(path + ": damaged: " + error.what());
  }
}

}  // namespace aquafarm_agents
