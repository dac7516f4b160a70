// SPDX-License-Identifier: BSD-3-Clause
#include "maddpg/maddpg_options.h"

#include "base/option_words.h"

namespace aquafarm::agents {

MaddpgOptions MaddpgOptions::Parse(const std::string& text, std::string& resolved) {
  OptionReader reader(text);
  MaddpgOptions options;
  ReadWhole(reader, "hidden_size", 1, 4096, options.hidden_size);
  options.actor_rate = reader.GetSchedule("actor_rate", options.actor_rate, 0.0, 1.0);
  options.critic_rate = reader.GetSchedule("critic_rate", options.critic_rate, 0.0, 1.0);
  ReadNumber(reader, "gamma", 0.0, 1.0, options.gamma);
  options.exploration = ParseExploration(reader.Text("exploration", ToString(options.exploration)));
  reader.Resolve("exploration", ToString(options.exploration));
  ReadWhole(reader, "batch_size", 1, 65536, options.batch_size);
  ReadNumber(reader, "train_interval", 0.01, 1e6, options.train_interval);
  ReadWhole(reader, "learning_starts", 0, 1e9, options.learning_starts);
  ReadWhole(reader, "buffer_size", 100, 1e9, options.buffer_size);
  ReadNumber(reader, "priority_exponent", 0.0, 1.0, options.priority_exponent);
  ReadNumber(reader, "importance_exponent", 0.0, 1.0, options.importance_exponent);
  ReadNumber(reader, "tau", 1e-6, 1.0, options.tau);
  ReadWhole(reader, "n_step", 1, 100, options.n_step);
  ReadNumber(reader, "temperature", 0.01, 100.0, options.temperature);
  ReadNumber(reader, "logit_penalty", 0.0, 1e3, options.logit_penalty);
  ReadNumber(reader, "reward_scale", 1e-9, 1e9, options.reward_scale);
  ReadNumber(reader, "max_grad_norm", 0.0, 1e9, options.max_grad_norm);
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
