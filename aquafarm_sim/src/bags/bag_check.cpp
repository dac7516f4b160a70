// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/bags/bag_check.h"

#include <aquafarm_msgs/EpisodeSummary.h>
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/SavedState.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/base/hash.h"
#include "aquafarm/base/version.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_sim/bags/bag_ranch.h"
#include "aquafarm_sim/bags/message_difference.h"
#include "aquafarm_sim/bags/read_bag.h"
#include "aquafarm_sim/convert/conversions.h"
#include "aquafarm_sim/names.h"

namespace aquafarm_sim {
namespace {

// Returns whether a definition in a bag has the text of this version or one of the earlier texts
// that this version can check.
bool IsSameText(const std::string& type, const std::string& in_bag,
                const std::string& in_this_version) {
  // Checksums of the texts of version 0.1.0 (commit 859eafa) and of commit 99c88b87.
  static const std::map<std::string, std::array<std::uint64_t, 2>> kEarlier{
      {"aquafarm_msgs/FarmSpec", {0xc74863b23d59b24eU, 0x19d768721bc846c1U}},
      {"aquafarm_msgs/FarmState", {0x5225216189e06b76U, 0x36f6cee81a8b74bbU}},
      {"aquafarm_msgs/SavedState", {0xfea0953b02051c1aU, 0x77a70a13a617ff5bU}},
      {"aquafarm_msgs/EpisodeSummary", {0x49c1b3db06029400U, 0xa691dd61f0e3793eU}}};
  if (in_bag == in_this_version) return true;
  const auto known = kEarlier.find(type);
  return known != kEarlier.end() &&
         std::count(known->second.begin(), known->second.end(), aquafarm::HashBytes(in_bag)) > 0;
}

using aquafarm::Farm;
using aquafarm::InputError;
using aquafarm_msgs::EpisodeSummary;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;
using aquafarm_msgs::SavedState;
using nav_msgs::OccupancyGrid;

std::string Number(std::uint64_t value) { return std::to_string(value); }

std::string Missing(std::uint64_t first, std::uint64_t last) {
  if (first == last) return "step " + Number(first) + " is missing";
  return "steps " + Number(first) + " to " + Number(last) + " are missing";
}

/// Message definitions of earlier versions that a bag contains, by message type.
using Definitions = std::map<std::string, std::string>;

Definitions OlderDefinitions(const rosbag::Bag& bag) {
  Definitions definitions;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    if (IsOlderMessage(connection->datatype, connection->md5sum)) {
      definitions.emplace(connection->datatype, connection->msg_def);
    }
  }
  return definitions;
}

/// Simulates one episode of a bag and compares the messages of the bag with the simulation.
class Simulation {
 public:
  /// @param definitions message definitions of earlier versions in the bag; must outlive the object
  /// @throws InputError if the spec does not contain a valid scenario
  Simulation(const FarmSpec& spec, const Definitions& definitions)
      : definitions_(definitions),
        scenario_(std::make_shared<const aquafarm::Scenario>(
            aquafarm::ParseScenario(spec.scenario_yaml, "spec.scenario_yaml"))),
        farm_(scenario_),
        spec_stamp_(spec.header.stamp) {
    farm_.Reset(spec.seed, spec.episode);
  }

  /// Each Check returns the first difference between a message and the simulation; empty if they
  /// are equal.
  std::string Check(const FarmSpec& spec) const {
    const aquafarm::Encoder encoder(*scenario_);
    FarmSpec simulated;
    // A bag of an earlier version may contain old names of scenario keys.
    const bool old_names = spec.scenario_yaml == aquafarm::ToYaml(*scenario_, true);
    ToMsg(farm_, encoder, spec.farms, aquafarm::ToYaml(*scenario_, old_names), {}, simulated);
    simulated.header = spec.header;
    const std::string difference = Difference(spec, simulated);
    return difference.empty() ? "" : "spec." + difference;
  }

  /// Simulates a step before the comparison if the state is that of the next step.
  std::string Check(const FarmState& state) {
    const auto step = static_cast<std::uint64_t>(farm_.step());
    const std::uint64_t expected = seen_ ? step + 1 : step;
    if (state.step > expected) return Missing(expected, state.step - 1);
    if (state.step + 1 < expected) return "steps are out of order";
    if (state.step > step) {
      if (const std::string fault = Step(state); !fault.empty()) return fault;
    }
    seen_ = begun_ = true;
    stamp_ = state.header.stamp;
    MessageContext context;
    context.paced = state.pace == FarmState::PACED;
    context.rate_hz = state.rate_hz;
    context.paused = state.paused != 0;
    FarmState simulated;
    ToMsg(farm_, context, simulated);
    simulated.header = state.header;
    const std::string difference = Difference(state, simulated);
    return difference.empty() ? "" : "state." + difference;
  }

  std::string Check(const EpisodeSummary& summary) const {
    EpisodeSummary simulated = ToMsg(farm_.record(), farm_.SettleAccounts(), summary.farm, {});
    simulated.header = summary.header;
    const std::string difference = Difference(summary, simulated);
    return difference.empty() ? "" : "episode." + difference;
  }

  /// Compares the chart of the episode, or the risk of the current state. Skips a chart without the
  /// stamp of the spec, and a risk without the stamp of the current state.
  std::string Check(const OccupancyGrid& grid, bool is_chart) const {
    OccupancyGrid simulated;
    if (is_chart) {
      if (grid.header.stamp != spec_stamp_) return "";
      simulated = ChartToMsg(farm_, {});
    } else {
      if (!seen_ || grid.header.stamp != stamp_) return "";
      RiskToMsg(farm_.disasters(), *scenario_, {}, simulated);
    }
    simulated.header = grid.header;
    simulated.info.map_load_time = grid.info.map_load_time;
    const std::string difference = FirstDifference(grid, simulated);
    if (difference.empty()) return "";
    return (is_chart ? "chart." : "risk.") + difference;
  }

  /// Loads a saved state. The episode continues from it. Returns a description of the fault if the
  /// state cannot be loaded, else an empty text.
  std::string Load(const SavedState& saved) {
    const auto step = static_cast<std::uint64_t>(farm_.step());
    if (begun_ && saved.step > step) return Missing(step + 1, saved.step);
    if (begun_ && saved.step < step) return "steps are out of order";
    try {
      Farm loaded(scenario_);
      loaded.Reset(farm_.seed(), farm_.episode());
      loaded.Load(std::string(saved.data.begin(), saved.data.end()));
      if (static_cast<std::uint64_t>(loaded.step()) != saved.step) {
        return "saved_state.step: got " + Number(saved.step) + ", its data has " +
               std::to_string(loaded.step());
      }
      farm_.Load(std::string(saved.data.begin(), saved.data.end()));
    } catch (const InputError& error) {
      return std::string("saved_state.data: ") + error.what();
    }
    seen_ = false;  // the next state of the bag must be the loaded state
    begun_ = true;
    return "";
  }

  const Farm& farm() const { return farm_; }

 private:
  std::string Step(const FarmState& state) {
    if (farm_.over()) {
      return "the episode ended with step " + std::to_string(farm_.step()) +
             ", expected no later one";
    }
    const std::size_t agents = farm_.ships().size();
    if (state.ships.size() != agents) {
      return "state.ships: got " + Number(state.ships.size()) + " entries, simulated " +
             Number(agents);
    }
    std::vector<std::uint8_t> actions;
    for (const auto& ship : state.ships) {
      if (ship.action > static_cast<std::uint8_t>(aquafarm::Action::kHold)) {
        return "state.ships[" + Number(actions.size()) + "].action: got " + Number(ship.action) +
               ", expected [0, 10]";
      }
      actions.push_back(ship.action);
    }
    farm_.Step(actions.data());
    return "";
  }

  // Compares only the fields that the bag's definition contains.
  template <typename Message>
  std::string Difference(Message got, Message& simulated) const {
    const auto found = definitions_.find(ros::message_traits::datatype<Message>());
    if (found == definitions_.end()) return FirstDifference(got, simulated);
    DropAddedFields(found->second, got);  // a bag may contain messages of two versions
    DropAddedFields(found->second, simulated);
    return FirstDifference(got, simulated);
  }

  const Definitions& definitions_;
  std::shared_ptr<const aquafarm::Scenario> scenario_;
  Farm farm_;
  ros::Time spec_stamp_;
  bool begun_{};     // a state was read; a saved state must then be that of the current step
  bool seen_{};      // the current state of the farm was compared
  ros::Time stamp_;  // stamp of the last state that was compared
};

/// Seed and index of an episode.
using Key = std::pair<std::uint64_t, std::uint64_t>;

/// Checks a bag's messages in order. Each topic has a separate connection, so a live recording may
/// contain an episode's first state before its spec, and its summary before its last state.
class Checker {
 public:
  /// @param path path of the bag, for error messages
  Checker(std::map<Key, FarmSpec> specs, std::multimap<Key, EpisodeSummary> summaries,
          Definitions definitions, std::string path)
      : specs_(std::move(specs)),
        summaries_(std::move(summaries)),
        definitions_(std::move(definitions)),
        path_(std::move(path)) {}

  /// @returns false at the first difference
  bool Take(const rosbag::MessageInstance& message, bool is_chart) {
    if (const auto state = Instantiate<FarmState>(message)) {
      return Enter({state->seed, state->episode}, state->step) &&
             Compared(state->step, simulation_->Check(*state));
    }
    if (const auto saved = Instantiate<SavedState>(message)) {
      return Enter({saved->seed, saved->episode}, saved->step) &&
             Compared(saved->step, simulation_->Load(*saved)) && NoteChange(saved->step);
    }
    const auto grid = Instantiate<OccupancyGrid>(message);
    if (!grid) return true;
    if (is_chart) early_chart_ = *grid;
    return !simulation_ || Compared(Step(), simulation_->Check(*grid, is_chart));
  }

  /// @param starts_again true: the next state is the start of the same episode, so that a summary
  ///     belongs to the next run if this one is not over
  /// @returns false if there is a difference
  bool EndEpisode(bool starts_again = false) {
    if (!simulation_) return true;
    const Farm& farm = simulation_->farm();
    const auto found = summaries_.find(key_);
    if (found != summaries_.end() && (farm.over() || !starts_again)) {
      const EpisodeSummary summary = found->second;
      summaries_.erase(found);
      if (summary.steps > farm.step()) {
        return Compared(static_cast<std::uint64_t>(summary.steps),
                        "missing: the bag's states end with step " + std::to_string(farm.step()));
      }
      if (!Compared(Step(), simulation_->Check(summary))) return false;
    } else if (farm.over()) {
      return Compared(Step(), "the episode is over, but its summary is missing");
    }
    char words[160];
    std::snprintf(words, sizeof(words), "episode %llu of seed %llu: %d steps, return %g, %s",
                  static_cast<unsigned long long>(farm.episode()),
                  static_cast<unsigned long long>(farm.seed()), farm.step(),
                  static_cast<double>(farm.record().episode_return),
                  farm.over() ? std::string(ToString(farm.reason())).c_str() : "not over");
    check_.episodes_in_words.emplace_back(words);
    ++check_.episodes;
    check_.steps += Step();
    check_.unfinished += farm.over() ? 0 : 1;
    simulation_.reset();
    return true;
  }

  /// Ends the last episode. Then reports a remaining summary, which has no states, as a difference
  /// unless it is that of another farm.
  /// @returns false if there is a difference
  bool End() {
    if (!EndEpisode()) return false;
    for (const auto& [key, summary] : summaries_) {
      // A live recording of many farms contains the summaries of all farms, but only the states of
      // farm 0.
      const bool of_other_farm = summary.farm != 0 && specs_.count(key) == 0 && check_.episodes > 0;
      if (of_other_farm && specs_.begin()->second.farms > 1) continue;
      check_.difference = "episode " + Number(key.second) + " of seed " + Number(key.first) +
                          ": a summary without states";
      return false;
    }
    return true;
  }

  const BagCheck& check() const { return check_; }

 private:
  bool NoteChange(std::uint64_t step) {
    check_.changed_at.push_back(step);
    return true;
  }

  std::uint64_t Step() const { return static_cast<std::uint64_t>(simulation_->farm().step()); }

  /// Continues or starts the episode of a message. A message of step 0 after later steps restarts
  /// the episode.
  bool Enter(const Key& key, std::uint64_t step) {
    if (simulation_ && key == key_ && (step != 0 || Step() == 0)) return true;
    if (!EndEpisode(/*starts_again=*/key == key_)) return false;
    key_ = key;
    const auto spec = specs_.find(key);
    if (spec == specs_.end()) return Compared(step, "the bag contains no spec of this episode");
    NamingBag(path_, [&] { simulation_.emplace(spec->second, definitions_); });
    if (!Compared(0, simulation_->Check(spec->second))) return false;
    return !early_chart_ || Compared(0, simulation_->Check(*early_chart_, /*is_chart=*/true));
  }

  bool Compared(std::uint64_t step, const std::string& difference) {
    if (difference.empty()) return true;
    check_.difference =
        "episode " + Number(key_.second) + " step " + Number(step) + ": " + difference;
    return false;
  }

  const std::map<Key, FarmSpec> specs_;
  std::multimap<Key, EpisodeSummary> summaries_;  // summaries that are not yet compared
  const Definitions definitions_;
  const std::string path_;
  Key key_;  // key of the simulated episode
  std::optional<Simulation> simulation_;
  std::optional<OccupancyGrid> early_chart_;  // the last chart: it may precede its episode's states
  BagCheck check_;
};

using Specs = std::map<Key, FarmSpec>;
using Summaries = std::multimap<Key, EpisodeSummary>;

Summaries ReadSummaries(const rosbag::Bag& bag, const std::string& topic) {
  Summaries all;
  for (const auto& message : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    if (const auto one = Instantiate<EpisodeSummary>(message)) {
      all.insert({{one->seed, one->episode}, *one});
    }
  }
  return all;
}

/// @param difference set if a spec differs from an earlier one of the same episode
Specs ReadSpecs(const rosbag::Bag& bag, const std::string& topic, std::string& difference) {
  Specs all;
  for (const auto& message : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    const auto one = Instantiate<FarmSpec>(message);
    if (!one) continue;
    const auto [first, is_new] = all.insert({{one->seed, one->episode}, *one});
    if (is_new || !difference.empty()) continue;
    FarmSpec before = first->second;
    before.header = one->header;
    if (FirstDifference(*one, before).empty()) continue;
    difference = "episode " + Number(one->episode) + " of seed " + Number(one->seed) +
                 ": two specs that differ";
  }
  return all;
}

/// @throws InputError if an episode was recorded by another version
void CheckVersions(const std::map<Key, FarmSpec>& specs, const std::string& path) {
  for (const auto& [key, spec] : specs) {
    if (spec.version == aquafarm::kVersion) continue;
    throw InputError(path + ": " + RecordedBy(spec.version) + ", this is " + aquafarm::kVersion +
                     "; use the version that recorded the bag");
  }
}

}  // namespace

std::string ChangesInWords(const BagCheck& check) {
  std::string words;
  for (const std::uint64_t step : check.changed_at) {
    words += (words.empty() ? ", changed from outside at step " : ", ") + Number(step);
  }
  return words;
}

BagCheck CheckBag(const std::string& path, const std::string& ns) {
  return ReadingBag(path, [&] {
    rosbag::Bag bag;
    OpenBag<FarmSpec, FarmState, SavedState, EpisodeSummary, OccupancyGrid>(bag, path);
    CheckMessages(bag, path,
                  {TypeOf<FarmSpec>(), TypeOf<FarmState>(), TypeOf<SavedState>(),
                   TypeOf<EpisodeSummary>(), TypeOf<OccupancyGrid>()},
                  IsSameText);
    const std::string ranch = FindRanch(bag, path, ns);
    BagCheck refused;
    auto specs = ReadSpecs(bag, ranch + names::kSpec, refused.difference);
    CheckVersions(specs, path);
    if (!refused.difference.empty()) return refused;
    Checker checker(std::move(specs), ReadSummaries(bag, ranch + names::kEpisode),
                    OlderDefinitions(bag), path);
    const std::string chart = ranch + names::kChart;
    rosbag::View view(bag, rosbag::TopicQuery({ranch + names::kState, ranch + names::kSavedState,
                                               chart, ranch + names::kRisk}));
    for (const rosbag::MessageInstance& message : view) {
      if (!checker.Take(message, message.getTopic() == chart)) return checker.check();
    }
    if (!checker.EndEpisode()) return checker.check();
    if (checker.check().episodes == 0) {
      throw InputError(path + ": got no episode with a spec and states, expected at least one");
    }
    checker.End();
    return checker.check();
  });
}

}  // namespace aquafarm_sim
