// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/ppo/ppo_options.h"

#include <algorithm>
#include <array>
#include <string>

#include "aquafarm/base/check.h"
#include "base/option_words.h"

namespace aquafarm::agents {
namespace {

constexpr std::array<std::string_view, kPolicyModeCount> kPolicyModes{"greedy", "sampled"};

enum class Preset : std::uint8_t { kTuned, kLarge };
constexpr std::array<std::string_view, 2> kPresets{"tuned", "large"};

constexpr std::int32_t kMaxShards = 4096;
constexpr std::int32_t kMinHorizon = 8;  // steps; advantages need some steps of each episode

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

std::int32_t PpoOptions::Horizon(std::size_t entries) const {
  const auto steps = static_cast<std::int32_t>(static_cast<std::size_t>(rollout_size) / entries);
  const std::int32_t horizon = std::max(kMinHorizon, steps);
  if (!recurrent) return horizon;
  // Only complete sequences, so that each begins with a stored state.
  return (horizon + sequence_length - 1) / sequence_length * sequence_length;
}

PpoOptions PpoOptions::Parse(const std::string& text, std::string& resolved, bool central) {
  OptionReader reader(text);
  PpoOptions options = Defaults(ReadWord(reader, "preset", Preset::kTuned, kPresets));
  options.central = central;
  ReadWhole(reader, "hidden_size", 1, 4096, options.hidden_size);
  options.recurrent = reader.Flag("recurrent", options.recurrent);
  ReadWhole(reader, "sequence_length", 1, 1000, options.sequence_length);
  options.learning_rate = reader.GetSchedule("learning_rate", options.learning_rate, 0.0, 1.0);
  ReadNumber(reader, "gamma", 0.0, 1.0, options.gamma);
  ReadNumber(reader, "gae_lambda", 0.0, 1.0, options.gae_lambda);
  ReadWhole(reader, "rollout_size", 1, 1e8, options.rollout_size);
  ReadWhole(reader, "batch_size", 1, 1e8, options.batch_size);
  ReadWhole(reader, "epochs", 1, 100, options.epochs);
  options.clip_range = reader.GetSchedule("clip_range", options.clip_range, 1e-6, 1.0);
  ReadNumber(reader, "value_clip_range", 0.0, 1e9, options.value_clip_range);
  ReadNumber(reader, "value_coef", 0.0, 1e6, options.value_coef);
  ReadNumber(reader, "max_grad_norm", 0.0, 1e9, options.max_grad_norm);
  ReadNumber(reader, "reward_scale", 1e-9, 1e9, options.reward_scale);
  options.normalize_advantages = reader.Flag("normalize_advantages", options.normalize_advantages);
  options.mask_illegal = reader.Flag("mask_illegal", options.mask_illegal);
  options.mask_blocked = reader.Flag("mask_blocked", options.mask_blocked);
  options.exploration = ParseExploration(reader.Text("exploration", ToString(options.exploration)),
                                         ExplorationOf::kPolicies);
  reader.Resolve("exploration", ToString(options.exploration));
  options.teacher = reader.GetSchedule("teacher", options.teacher, 0.0, 1000.0);
  options.team_share = reader.GetSchedule("team_share", options.team_share, 0.0, 1.0);
  options.policy = ReadWord(reader, "policy", options.policy, kPolicyModes);
  ReadWhole(reader, "threads", 1, 256, options.threads);
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
