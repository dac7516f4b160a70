// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/learning/exploration.h"

#include <algorithm>
#include <cmath>

#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

// At this temperature the choice is effectively greedy, and 1/T is still finite.
constexpr double kMinTemperature = 1e-6;
constexpr double kMaxTemperature = 1e6;

// The temperature falls from 20 to 0.5 in the first half of the run. Rewards are of the order of
// 100, so the choice changes from nearly uniform to nearly greedy.
const Schedule kBoltzmannDefault{ScheduleKind::kExponential, 20.0, 0.5, 0.5};

// At the start of the run, the mean intrinsic reward of a step is 1, which is about the cost of a
// step. In the second half of the run, the intrinsic reward is 0, so that the learner finally
// learns values of the farm's reward alone.
const Schedule kCuriosityDefault{ScheduleKind::kLinear, 1.0, 0.0, 0.5};
constexpr double kMaxCuriosity = 1e6;
constexpr std::string_view kCuriosity = "icm";

constexpr double kMaxEntropy = 1e3;
const Schedule kEntropyDefault{ScheduleKind::kLinear, 0.02, 0.0, 1.0};

[[noreturn]] void RefuseExploration(const std::string& text, ExplorationOf learners) {
  if (learners == ExplorationOf::kPolicies) {
    throw InputError("exploration: got '" + text +
                     "', expected entropy for a learner that samples its own policy, alone or with "
                     "a schedule such as entropy:linear:0.02:0:1; the prefix icm+ adds curiosity: "
                     "icm+entropy:0.01");
  }
  throw InputError("exploration: got '" + text +
                   "', expected epsilon_greedy or boltzmann, alone or with a schedule such as "
                   "epsilon_greedy:linear:1:0.05:0.5; the prefix icm+ adds curiosity: "
                   "icm+epsilon_greedy, icm:linear:1:0:0.5+boltzmann:1");
}

}  // namespace

std::string_view ToString(ExplorationKind value) {
  switch (value) {
    case ExplorationKind::kEpsilonGreedy:
      return "epsilon_greedy";
    case ExplorationKind::kBoltzmann:
      return "boltzmann";
    case ExplorationKind::kEntropy:
      return "entropy";
  }
  return "?";
}

ExplorationOptions ParseExploration(const std::string& text, ExplorationOf learners) {
  ExplorationOptions options;
  if (text.rfind(kCuriosity, 0) == 0) {
    const std::size_t plus = text.find('+');
    const std::string own = text.substr(0, plus);
    if (plus != std::string::npos) options = ParseExploration(text.substr(plus + 1), learners);
    if (plus == std::string::npos && learners == ExplorationOf::kPolicies) {
      options = ParseExploration("entropy", learners);
    }
    if (options.is_curious()) RefuseExploration(text, learners);
    options.curiosity = kCuriosityDefault;
    if (own != kCuriosity) {
      if (own[kCuriosity.size()] != ':') RefuseExploration(text, learners);
      options.curiosity =
          ParseSchedule(own.substr(kCuriosity.size() + 1), "exploration: icm", 0.0, kMaxCuriosity);
    }
    return options;
  }
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  double min = 0.0;
  double max = 1.0;
  const bool is_entropy = name == ToString(ExplorationKind::kEntropy);
  const auto refused = is_entropy ? ExplorationOf::kValues : ExplorationOf::kPolicies;
  if (learners == refused) RefuseExploration(text, learners);
  if (is_entropy) {
    options.kind = ExplorationKind::kEntropy;
    options.level = kEntropyDefault;
    max = kMaxEntropy;
  } else if (name == ToString(ExplorationKind::kBoltzmann)) {
    options.kind = ExplorationKind::kBoltzmann;
    options.level = kBoltzmannDefault;
    min = kMinTemperature;
    max = kMaxTemperature;
  } else if (name != ToString(ExplorationKind::kEpsilonGreedy)) {
    RefuseExploration(text, learners);
  }
  if (colon != std::string::npos) {
    options.level = ParseSchedule(text.substr(colon + 1), "exploration", min, max);
  }
  return options;
}

std::string ToString(const ExplorationOptions& options) {
  const std::string curious =
      options.is_curious() ? std::string(kCuriosity) + ":" + ToString(options.curiosity) + "+" : "";
  return curious + std::string(ToString(options.kind)) + ":" + ToString(options.level);
}

std::array<double, kActionCount> BoltzmannProbabilities(const float* values, ActionMask allowed,
                                                        double temperature) {
  // The largest exponent is 0, so nothing overflows and the sum is at least 1.
  const auto largest = static_cast<double>(BestOf(values, allowed).value);
  std::array<double, kActionCount> probabilities{};
  double sum = 0.0;
  for (std::size_t a = 0; a < kActionCount; ++a) {
    if (((allowed >> a) & 1U) == 0) continue;
    probabilities[a] = std::exp((static_cast<double>(values[a]) - largest) / temperature);
    sum += probabilities[a];
  }
  for (double& probability : probabilities) probability /= sum;
  return probabilities;
}

Explorer::Explorer(const ExplorationOptions& options, std::uint64_t seed, std::size_t slots,
                   double value_scale)
    : kind_(options.kind),
      schedule_(options.level),
      value_scale_(value_scale),
      streams_(seed, slots) {
  SetProgress(0.0);
}

void Explorer::SetProgress(double progress) {
  if (schedule_.kind == ScheduleKind::kConstant && level_ == schedule_.start) return;
  level_ = schedule_.At(progress);
  epsilon_ = static_cast<float>(level_);
}

std::uint8_t Explorer::ChooseBoltzmann(const float* values, ActionMask allowed, std::size_t slot) {
  const auto probabilities = BoltzmannProbabilities(values, allowed, level_ * value_scale_);
  auto left = static_cast<double>(streams_[slot].Unit());
  std::uint8_t chosen = 0;
  for (std::uint8_t a = 0; a < kActionCount; ++a) {
    if (probabilities[a] <= 0.0) continue;
    chosen = a;  // fallback if rounding leaves a remainder: the last allowed action
    left -= probabilities[a];
    if (left < 0.0) break;
  }
  return chosen;
}

std::uint8_t DrawAction(ActionMask allowed, RandomStream& stream) {
  std::array<std::uint8_t, kActionCount> actions{};
  std::uint32_t count = 0;
  for (std::uint8_t a = 0; a < kActionCount; ++a) {
    if (((allowed >> a) & 1U) != 0) actions[count++] = a;
  }
  return actions[stream.Below(count)];
}

}  // namespace aquafarm::agents
