// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The only interface between learners and farms. An environment has N farms with S agents each.
/// The farms run in this process or behind ROS services, with bit-identical transitions. A slot is
/// one agent of one farm, with the index farm · S + agent.
///
/// If the episode of a farm is over (its end reason is not kNone), the next Step ignores the
/// actions of this farm and starts its next episode. In the results of that Step, the farm has
/// is_first = 1, its rewards are 0, and its slots hold no transition.
///
/// An agent may be done before the episode ends: a delivered self-propelled device is no longer
/// active (as in PettingZoo's parallel API). Its last transition, the delivery, is terminal. From
/// then until the next episode, the slot of this agent holds no transition. Its reward is 0, or the
/// team's reward if the scenario has a team reward.

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "aquafarm/grid/action.h"
#include "aquafarm/grid/episode_summary.h"
#include "aquafarm/grid/step_fields.h"

namespace aquafarm {
class Farm;
}

namespace aquafarm::agents {

/// Bits of a mask of observation types. kOwnRewardsBit requests individual rewards in scenarios
/// that give every agent the sum of the team's rewards. kStatesBit requests StepResults::states,
/// which planners use.
enum ObservationTypeBits : std::uint8_t {
  kIndexBit = kIndexField,
  kFeaturesBit = kFeaturesField,
  kPlanesBit = kPlanesField,
  kOwnRewardsBit = kTermsField,
  kStatesBit = 128
};

/// Static properties of the farms, available to a learner before it starts.
struct EnvironmentSpec {
  std::string scenario_name;
  std::string scenario_yaml;  ///< canonical text of the scenario; run folders contain it
  std::uint64_t scenario_hash{};
  std::string version;
  std::int32_t farms{};
  std::int32_t agents{};  ///< ships and self-propelled devices of one farm
  bool team_reward{};     ///< every agent receives the sum of all agents' rewards
  /// Number of tabular states; 0 if there are too many, or if the scenario describes a family of
  /// ranches (scenario/family.h).
  std::uint32_t state_count{};
  std::int32_t feature_count{};
  std::vector<std::string> feature_names;  ///< [feature_count] as Encoder::feature_names
  std::int32_t plane_count{};
  std::int32_t height{};      ///< of the map [cells]; for a family, the largest height
  std::int32_t width{};       ///< of the map [cells]; for a family, the largest width
  std::int32_t step_limit{};  ///< max length of an episode [steps]
};

/// Returns the number of slots: one for each agent of each farm.
inline std::size_t SlotCount(const EnvironmentSpec& spec) {
  return static_cast<std::size_t>(spec.farms) * static_cast<std::size_t>(spec.agents);
}

/// Results of one Reset, Step or Load. The environment owns them; they are valid until its next
/// Reset, Step or Load. Arrays are row-major. F is feature_count, P is plane_count, and H and W are
/// the height and the width of the map.
struct StepResults {
  /// Returns whether the agent in `slot` of `farm` is in a terminal state, whose value is 0. False
  /// for an active agent whose episode was truncated at the step limit.
  bool IsDone(std::size_t slot, std::size_t farm) const {
    return active[slot] == 0 || IsTerminated(static_cast<EndReason>(end_reasons[farm]));
  }

  std::vector<float> rewards;             ///< [N, S]
  std::vector<float> terms;               ///< [N, S, kRewardTermCount]; empty unless requested
  std::vector<float> energy;              ///< [N, S] consumed in the step [kWh]
  std::vector<float> distance;            ///< [N, S] travelled in the step [km]
  std::vector<std::uint8_t> outcomes;     ///< [N, S] Outcome
  std::vector<ActionMask> legal;          ///< [N, S] actions that are legal in the next step
  std::vector<std::uint8_t> active;       ///< [N, S] 0 from an agent's delivery to the next episode
  std::vector<std::uint8_t> end_reasons;  ///< [N] EndReason; kNone while the episode continues
  std::vector<std::uint8_t> is_first;     ///< [N] 1 at an episode's first observation
  std::vector<std::uint64_t> hashes;      ///< [N]; empty unless requested
  std::vector<std::uint32_t> index;       ///< [N, S]; empty unless requested
  std::vector<float> features;            ///< [N, S, F]; empty unless requested
  std::vector<std::uint8_t> planes;       ///< [N, S, P, H, W]; empty unless requested
  std::vector<const Farm*>
      states;  ///< [N] the farms, or copies of remote ones; empty unless requested
  std::vector<EpisodeSummary> finished;  ///< episodes that ended in this step, ordered by farm
};

/// Number of farms and threads, and the optional results that an environment must produce.
struct EnvironmentOptions {
  std::int32_t farms{1};
  std::uint8_t observation_types{kIndexBit};  ///< mask of ObservationTypeBits
  bool hashes{false};                         ///< whether to fill StepResults::hashes
  std::int32_t threads{1};                    ///< threads that step the farms; no effect on results
};

/// Thrown when an environment cannot continue with its farms, for example because the sim node has
/// not answered within the time limit.
class EnvironmentLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns whether `observation_types` contains kOwnRewardsBit and the scenario has a team reward.
/// If so, sets spec.team_reward to false. The environment must then request kTermsField from the
/// farms and call UseOwnRewards after each step.
bool WantsOwnRewards(std::uint8_t observation_types, EnvironmentSpec& spec);

/// Replaces each agent's reward with the sum of its reward terms.
/// @param results must contain `terms`
void UseOwnRewards(StepResults& results);

/// A batch of farms, in this process or behind ROS services.
class Environment {
 public:
  virtual ~Environment() = default;

  virtual const EnvironmentSpec& spec() const = 0;

  /// Starts the episode sequence of `seed`: farm i plays the episodes first_episode + i,
  /// first_episode + i + N, first_episode + i + 2N, … (If several environments share the farms, i
  /// and N count the farms of all of them.)
  /// @throws InputError if the layout of an episode cannot be generated
  virtual const StepResults& Reset(std::uint64_t seed, std::uint64_t first_episode = 0) = 0;

  /// Takes one step in every farm.
  /// @param actions [N, S], each an Action, kHold included; other values are a programming error
  /// @throws InputError if the layout of a new episode cannot be generated
  virtual const StepResults& Step(const std::vector<std::uint8_t>& actions) = 0;

  /// Serializes all farms, also in the middle of an episode.
  virtual std::string Save() = 0;
  /// Restores saved farms, which continue bit-identically. Returns their current results, with an
  /// empty `finished`.
  /// @throws InputError if the bytes do not match this environment; farms in this process are then
  ///   unchanged
  virtual const StepResults& Load(const std::string& bytes) = 0;

  /// Returns true once after a Step that had to abandon the current episodes and start new ones in
  /// all farms. This happens if the sim node has restarted or another client has changed its farms.
  /// The results of that Step are first observations.
  virtual bool ConsumeRestart() { return false; }
};

}  // namespace aquafarm::agents
