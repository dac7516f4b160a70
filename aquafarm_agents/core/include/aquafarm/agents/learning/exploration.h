// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Exploration strategies of learners (Fig. 7).
///
///   ε-greedy (Eq. 7)   a uniform action with probability ε, else the greedy action
///   Boltzmann (Eq. 8)  P(a) ∝ exp(Q(a) / T); T → 0 is greedy, T → ∞ is uniform. T has the unit of
///                      the reward. The paper's equation has no temperature; it is the case T = 1
///   entropy            a policy learner samples its own policy and maximizes the return plus
///                      c · H(π)
///   curiosity          one of the above, with an intrinsic reward for prediction errors; see
///                      curiosity.h
///
/// ε, T, c and the weight of the intrinsic reward each follow a Schedule.

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "aquafarm/agents/base/schedule.h"
#include "aquafarm/agents/learning/agent_rng.h"
#include "aquafarm/base/rng.h"
#include "aquafarm/grid/action.h"

namespace aquafarm::agents {

/// Mask of all actions of the action space.
inline constexpr ActionMask kAllActions = (1U << kActionCount) - 1;

/// Exploration strategies, without curiosity. The head of this file describes them.
enum class ExplorationKind : std::uint8_t { kEpsilonGreedy, kBoltzmann, kEntropy };
inline constexpr int kExplorationKindCount = 3;
std::string_view ToString(ExplorationKind value);

/// An exploration strategy with its schedules.
struct ExplorationOptions {
  ExplorationKind kind{ExplorationKind::kEpsilonGreedy};
  Schedule level{ScheduleKind::kLinear, 1.0, 0.05, 0.5};  ///< ε, temperature or entropy coefficient
  /// Weight of the intrinsic reward, approximately its mean per step [reward]; 0: no curiosity.
  Schedule curiosity{ScheduleKind::kConstant, 0.0};
  /// Returns whether the intrinsic reward is above 0 at some time of the run.
  bool is_curious() const {
    const bool changes = curiosity.kind != ScheduleKind::kConstant;
    return curiosity.start > 0.0 || (changes && curiosity.end > 0.0);
  }
};

/// Kinds of learners, with the strategies that they accept.
enum class ExplorationOf : std::uint8_t {
  kValues,    ///< learners of action values: epsilon_greedy, boltzmann
  kPolicies,  ///< learners of policies: entropy
  kAny,       ///< all strategies
};

/// Parses "epsilon_greedy", "boltzmann" or "entropy", alone or with a schedule:
/// "epsilon_greedy:0.1", "boltzmann:exponential:10:0.5:0.5", "entropy:linear:0.02:0:1". The prefix
/// "icm+" adds curiosity, optionally with a schedule of its weight: "icm+epsilon_greedy:0.1",
/// "icm:linear:2:0:0.5+boltzmann". If no strategy follows "icm", the strategy is entropy for
/// kPolicies, else epsilon_greedy.
/// @param learners kind of the learner that explores
/// @throws InputError if `text` has another form, names a strategy that `learners` do not accept,
///   or has a value out of range
ExplorationOptions ParseExploration(const std::string& text,
                                    ExplorationOf learners = ExplorationOf::kValues);
/// Returns a text from which ParseExploration reads the same options.
std::string ToString(const ExplorationOptions& options);

/// A greedy action and its value.
struct Best {
  std::uint8_t action{};
  float value{};
};

/// Returns the greedy action among the allowed ones. Ties go to the lowest action number.
/// @param values [kActionCount]
/// @param allowed mask with at least one action
inline Best BestOf(const float* values, ActionMask allowed) {
  Best best{0, -std::numeric_limits<float>::infinity()};
  if (allowed == kAllActions) {  // the common case, without a branch per action
    best.value = values[0];
    for (std::uint8_t a = 1; a < kActionCount; ++a) {
      const bool better = values[a] > best.value;
      best.action = better ? a : best.action;
      best.value = better ? values[a] : best.value;
    }
    return best;
  }
  for (std::uint8_t a = 0; a < kActionCount; ++a) {
    const bool better = ((allowed >> a) & 1U) != 0 && values[a] > best.value;
    best.action = better ? a : best.action;
    best.value = better ? values[a] : best.value;
  }
  return best;
}

/// Draws one of the allowed actions, each with the same probability.
/// @param allowed mask with at least one action
std::uint8_t DrawAction(ActionMask allowed, RandomStream& stream);

/// Returns the action probabilities of Eq. 8 with temperature T. Forbidden actions have probability
/// 0. No intermediate result overflows.
/// @param values [kActionCount], finite
/// @param allowed mask with at least one action
/// @param temperature above 0, in the unit of `values`
std::array<double, kActionCount> BoltzmannProbabilities(const float* values, ActionMask allowed,
                                                        double temperature);

/// Chooses exploratory actions. A restored explorer continues bit-identically.
class Explorer {
 public:
  /// @param slots farms × agents; slot i draws from stream i of (seed, RngStream::kExploration)
  /// @param value_scale factor that converts rewards to the unit of the values passed to Choose. It
  ///   multiplies the temperature
  Explorer(const ExplorationOptions& options, std::uint64_t seed, std::size_t slots,
           double value_scale = 1.0);

  /// Sets ε or the temperature from the schedule.
  /// @param progress fraction of the run that is done, [0, 1]
  void SetProgress(double progress);
  /// Returns the current ε or temperature.
  double level() const { return level_; }

  /// Returns the exploratory action of an agent.
  /// @param values [kActionCount]
  /// @param best BestOf(values, allowed)
  std::uint8_t Choose(const float* values, ActionMask allowed, const Best& best, std::size_t slot) {
    if (kind_ == ExplorationKind::kBoltzmann) return ChooseBoltzmann(values, allowed, slot);
    RandomStream& stream = streams_[slot];
    if (stream.Unit() >= epsilon_) return best.action;
    if (allowed == kAllActions) return static_cast<std::uint8_t>(stream.Below(kActionCount));
    return DrawAction(allowed, stream);
  }

  void Save(Checkpoint& checkpoint) const { streams_.Save(checkpoint); }
  /// @throws InputError in the same cases as AgentRng::Load
  void Load(const Checkpoint& checkpoint) { streams_.Load(checkpoint); }

 private:
  std::uint8_t ChooseBoltzmann(const float* values, ActionMask allowed, std::size_t slot);

  ExplorationKind kind_;
  Schedule schedule_;
  double value_scale_;
  double level_{};
  float epsilon_{};
  AgentRng streams_;
};

}  // namespace aquafarm::agents
