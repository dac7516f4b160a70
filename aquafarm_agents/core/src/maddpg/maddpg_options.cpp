// SPDX-License-Identifier: BSD-3-Clause
#include "maddpg/maddpg_options.h"

#include "learning/common_options.h"

namespace aquafarm::agents {

MaddpgOptions MaddpgOptions::Parse(const std::string& text, std::string& resolved) {
  OptionReader reader(text);
  MaddpgOptions options;
  ReadNetworkOptions(reader, options);
  ReadReplayOptions(reader, 1.0, options);
  ReadExploration(reader, options.exploration);
  ReadSchedule(reader, "actor_rate", 0.0, 1.0, options.actor_rate);
  ReadSchedule(reader, "critic_rate", 0.0, 1.0, options.critic_rate);
  ReadNumber(reader, "train_interval", 0.01, 1e6, options.train_interval);
  ReadNumber(reader, "tau", 1e-6, 1.0, options.tau);
  ReadNumber(reader, "temperature", 0.01, 100.0, options.temperature);
  ReadNumber(reader, "logit_penalty", 0.0, 1e3, options.logit_penalty);
  ReadFlag(reader, "best_response", options.best_response);
  ReadFlag(reader, "shared", options.shared);
  ReadFlag(reader, "recurrent", options.recurrent);
  ReadWhole(reader, "window", 1, 100, options.window);
  if (!options.recurrent) options.window = 1;
  reader.Finish();
  resolved = reader.Resolved();
  return options;
}

}  // namespace aquafarm::agents
