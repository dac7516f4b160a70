// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/ppo/ppo_options.h"

#include <algorithm>
#include <array>
#include <string>

#include "aquafarm/base/check.h"
#include "learning/common_options.h"

namespace aquafarm::agents {
namespace {

constexpr std::array<std::string_view, kPolicyModeCount> kPolicyModes{"greedy", "sampled"};

constexpr std::array<std::string_view, kTeacherPolicyCount> kTeacherPolicies{"rule", "planner"};

enum class Preset : std::uint8_t { kTuned, kLarge };
constexpr std::array<std::string_view, 2> kPresets{"tuned", "large"};

constexpr std::int32_t kMaxShards = 4096;
constexpr std::int32_t kMinHorizon = 8;  // steps; advantages need several consecutive steps

PpoOptions Defaults(Preset preset) {
  PpoOptions options;
  if (preset == Preset::kTuned) return options;
  options.hidden_size = 256;
  options.gamma = 0.99;
  options.batch_size = 1024;
  options.learning_rate = {ScheduleKind::kLinear, 7e-4, 0.0, 1.0};
  options.exploration.level = {ScheduleKind::kLinear, 0.004, 0.0, 1.0};
  return options;
}

}  // namespace

std::string_view ToString(PolicyMode value) {
  return kPolicyModes[static_cast<std::size_t>(value)];
}

std::string_view ToString(TeacherPolicy value) {
  return kTeacherPolicies[static_cast<std::size_t>(value)];
}

std::int32_t PpoOptions::Horizon(std::size_t slots) const {
  const auto steps = static_cast<std::int32_t>(static_cast<std::size_t>(rollout_size) / slots);
  const std::int32_t horizon = std::max(kMinHorizon, steps);
  if (!recurrent) return horizon;
  // The rollout holds complete sequences, so that each starts with a stored state.
  return (horizon + sequence_length - 1) / sequence_length * sequence_length;
}

PpoOptions PpoOptions::Parse(const std::string& text, std::string& resolved, bool central) {
  OptionReader reader(text);
  PpoOptions options = Defaults(ReadWord(reader, "preset", Preset::kTuned, kPresets));
  options.central = central;
  ReadNetworkOptions(reader, options);
  ReadExploration(reader, options.exploration, ExplorationOf::kPolicies);
  ReadFlag(reader, "recurrent", options.recurrent);
  ReadWhole(reader, "sequence_length", 1, 1000, options.sequence_length);
  ReadSchedule(reader, "learning_rate", 0.0, 1.0, options.learning_rate);
  ReadNumber(reader, "gae_lambda", 0.0, 1.0, options.gae_lambda);
  ReadWhole(reader, "rollout_size", 1, 1e8, options.rollout_size);
  ReadWhole(reader, "batch_size", 1, 1e8, options.batch_size);
  ReadWhole(reader, "epochs", 1, 100, options.epochs);
  ReadSchedule(reader, "clip_range", 1e-6, 1.0, options.clip_range);
  ReadNumber(reader, "value_clip_range", 0.0, 1e9, options.value_clip_range);
  ReadNumber(reader, "value_coef", 0.0, 1e6, options.value_coef);
  ReadFlag(reader, "normalize_advantages", options.normalize_advantages);
  ReadSchedule(reader, "teacher", 0.0, 1000.0, options.teacher);
  options.teacher_policy =
      ReadWord(reader, "teacher_policy", options.teacher_policy, kTeacherPolicies);
  ReadWhole(reader, "teacher_interval", 1, 1000000, options.teacher_interval);
  ReadSchedule(reader, "team_share", 0.0, 1.0, options.team_share);
  ReadFlag(reader, "augment", options.augment);
  ReadFlag(reader, "symmetric", options.symmetric);
  ReadNumber(reader, "repetition_penalty", 0.0, 1e6, options.repetition_penalty);
  ReadWhole(reader, "max_visits", 0, 1000000, options.max_visits);
  options.policy = ReadWord(reader, "policy", options.policy, kPolicyModes);
  ReadWhole(reader, "shards", 1, kMaxShards, options.shards);
  if ((options.shards & (options.shards - 1)) != 0) {
    throw InputError("shards: got " + std::to_string(options.shards) +
                     ", expected a power of two: 1, 2, 4, 8, …");
  }
  reader.Finish();
  resolved = reader.Resolved();
  return options;
}

}  // namespace aquafarm::agents
