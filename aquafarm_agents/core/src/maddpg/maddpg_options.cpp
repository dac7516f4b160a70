// SPDX-License-Identifier: BSD-3-Clause
#include "maddpg/maddpg_options.h"

#include "base/option_words.h"

namespace aquafarm::agents {

MaddpgOptions MaddpgOptions::Parse(const std::string& text, std::string& resolved) {
  OptionReader reader(text);
  MaddpgOptions options;
  ReadWhole(reader, "hidden", 1, 4096, options.hidden);
  options.actor_rate = reader.GetSchedule("actor_rate", options.actor_rate, 0.0, 1.0);
  options.critic_rate = reader.GetSchedule("critic_rate", options.critic_rate, 0.0, 1.0);
  ReadNumber(reader, "discount", 0.0, 1.0, options.discount);
  options.exploration = ParseExploration(reader.Text("exploration", ToString(options.exploration)));
  reader.Resolve("exploration", ToString(options.exploration));
  ReadWhole(reader, "batch", 1, 65536, options.batch);
  ReadNumber(reader, "steps_per_update", 0.01, 1e6, options.steps_per_update);
  ReadWhole(reader, "start", 0, 1e9, options.start);
  ReadWhole(reader, "replay", 100, 1e9, options.replay);
  ReadNumber(reader, "priority", 0.0, 1.0, options.priority);
  ReadNumber(reader, "importance", 0.0, 1.0, options.importance);
  ReadNumber(reader, "target_rate", 1e-6, 1.0, options.target_rate);
  ReadWhole(reader, "n_step", 1, 100, options.n_step);
  ReadNumber(reader, "temperature", 0.01, 100.0, options.temperature);
  ReadNumber(reader, "logit_penalty", 0.0, 1e3, options.logit_penalty);
  ReadNumber(reader, "reward_scale", 1e-9, 1e9, options.reward_scale);
  ReadNumber(reader, "gradient_limit", 0.0, 1e9, options.gradient_limit);
  options.best_response = reader.Flag("best_response", options.best_response);
  options.mask_illegal = reader.Flag("mask_illegal", options.mask_illegal);
  options.mask_blocked = reader.Flag("mask_blocked", options.mask_blocked);
  options.shared = reader.Flag("shared", options.shared);
  options.recurrent = reader.Flag("recurrent", options.recurrent);
  ReadWhole(reader, "window", 1, 100, options.window);
  if (!options.recurrent) options.window = 1;
  options.device = ReadDevice(reader);
  ReadWhole(reader, "threads", 1, 256, options.threads);
  reader.Finish();
  resolved = reader.Resolved();
  return options;
}

}  // namespace aquafarm::agents
