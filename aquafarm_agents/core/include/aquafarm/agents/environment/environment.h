// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The one door between learners and farms: N farms × S agents, in this process or behind ROS
/// services. Both give the same transitions, bit for bit.
///
/// A farm whose episode is over (its reason is not kNone) ignores the action of the next Step and
/// starts its next episode: that entry has started = 1, reward 0 and no transition to learn from.
///
/// An agent may be done before its farm is: a self-propelled device that is delivered is out of
/// play (as in PettingZoo's parallel API). The transition that takes it out of play terminates it;
/// what follows until the next episode is none of its own.

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "aquafarm/grid/action.h"

namespace aquafarm::agents {

/// Which encodings of an observation are wanted; bits. kOwnRewardsBit asks for each agent's own
/// reward where the scenario shares one sum among all (who did it is then in the reward).
/// kStatesBit asks for the whole farms, for planners; a learner never does.
enum EncodingBits : std::uint8_t {
  kIndexBit = 1,
  kFeaturesBit = 2,
  kPlanesBit = 4,
  kOwnRewardsBit = 16,
  kStatesBit = 128
};

/// What a learner may know of the farm before it starts.
struct EnvironmentSpec {
  std::string scenario_name;
  std::string scenario_yaml;  ///< canonical text; kept in run folders and checkpoints
  std::uint64_t scenario_hash{};
  std::string version;
  std::int32_t farms{};
  std::int32_t agents{};        ///< ships and self-propelled devices of one farm
  bool team_reward{};           ///< every agent is given the sum of all agents' rewards here
  std::uint32_t state_count{};  ///< tabular states; 0: too many for a table
  std::int32_t feature_count{};
  std::vector<std::string> feature_names;  ///< [feature_count] as Encoder::feature_names
  std::int32_t plane_count{};
  std::int32_t height{};
  std::int32_t width{};
  std::int32_t step_limit{};
};

/// How one episode ended.
struct EpisodeResult {
  std::int32_t farm{};
  std::uint64_t seed{};
  std::uint64_t episode{};
  std::int32_t steps{};
  float episode_return{};
  std::int32_t delivered{};
  std::int32_t devices{};
  float delivered_health{};  ///< mean health of delivered devices; 0 when there are none
  std::int32_t crashes{};
  std::int32_t collisions{};
  std::int32_t steps_in_disaster{};
  EndReason reason{};
  bool Success() const { return reason == EndReason::kAllRetrieved; }
};

/// Results of one Reset or Step; owned by the environment, valid until its next call. Row-major.
struct Results {
  /// Whether the work of an agent (entry farm · S + agent) is over after this transition.
  bool IsDone(std::size_t entry, std::size_t farm) const {
    return in_play[entry] == 0 || IsTerminated(static_cast<EndReason>(reasons[farm]));
  }

  std::vector<float> rewards;           ///< [N, S]
  std::vector<std::uint8_t> outcomes;   ///< [N, S] Outcome
  std::vector<ActionMask> legal;        ///< [N, S] for the next step
  std::vector<std::uint8_t> in_play;    ///< [N, S] 0: this agent is done until the next episode
  std::vector<std::uint8_t> reasons;    ///< [N] EndReason; kNone while the episode goes on
  std::vector<std::uint8_t> started;    ///< [N] 1: an episode's first observation
  std::vector<std::uint64_t> hashes;    ///< [N]; empty unless asked for
  std::vector<std::uint32_t> index;     ///< [N, S]; empty unless asked for
  std::vector<float> features;          ///< [N, S, F]; empty unless asked for
  std::vector<std::uint8_t> planes;     ///< [N, S, P, H, W]; empty unless asked for
  std::string states;                   ///< all farms as Save() gives them; empty unless asked for
  std::vector<EpisodeResult> finished;  ///< episodes that ended in this step, by farm
};

/// What an environment is asked to produce.
struct EnvironmentOptions {
  std::int32_t farms{1};
  std::uint8_t encodings{kIndexBit};
  bool hashes{false};
  std::int32_t threads{1};  ///< that step the farms; results do not depend on it
};

/// Thrown when the farm behind an environment is gone for longer than its stated limit.
class EnvironmentLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Each agent's own rewards, the sums of its terms.
/// @param terms [N, S, kRewardTermCount]
/// @param rewards [N, S]
void AddUpTerms(const std::vector<float>& terms, std::vector<float>& rewards);

class Environment {
 public:
  virtual ~Environment() = default;

  virtual const EnvironmentSpec& spec() const = 0;

  /// Starts the sequence `seed`: farm i at episode first_episode + i, then every N-th.
  virtual const Results& Reset(std::uint64_t seed, std::uint64_t first_episode = 0) = 0;

  /// Takes one step in every farm.
  /// @param actions [N, S], each in [0, kActionCount); anything else is a programmer's mistake
  virtual const Results& Step(const std::vector<std::uint8_t>& actions) = 0;

  /// All farms as bytes, mid-episode.
  virtual std::string Save() = 0;
  /// Continues saved farms bit for bit and returns the results that stand; nothing has finished.
  /// @throws InputError on bytes that do not fit; the farms are then as they were
  virtual const Results& Load(const std::string& bytes) = 0;

  /// True once after the farms were lost and came back fresh (a ROS node restarted): the results
  /// of the last call are first observations of new episodes.
  virtual bool TakeRestarted() { return false; }
};

}  // namespace aquafarm::agents
