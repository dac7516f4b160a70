// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Functions that read options of several learners.

#include "aquafarm/agents/learning/exploration.h"
#include "base/option_words.h"

namespace aquafarm::agents {

/// Reads the option `exploration`. Its default is the value of the parameter `exploration` before
/// the call.
/// @throws InputError in the same cases as ParseExploration
inline void ReadExploration(OptionReader& reader, ExplorationOptions& exploration,
                            ExplorationOf learners = ExplorationOf::kValues) {
  exploration = ParseExploration(reader.Text("exploration", ToString(exploration)), learners);
  reader.Resolve("exploration", ToString(exploration));
}

/// Reads the options that all learners with networks have, except `exploration`.
/// @throws InputError if a value is invalid or out of range
template <typename Options>
void ReadNetworkOptions(OptionReader& reader, Options& options) {
  ReadWhole(reader, "hidden_size", 1, 4096, options.hidden_size);
  ReadNumber(reader, "gamma", 0.0, 1.0, options.gamma);
  ReadNumber(reader, "max_grad_norm", 0.0, 1e9, options.max_grad_norm);
  ReadNumber(reader, "reward_scale", 1e-9, 1e9, options.reward_scale);
  ReadFlag(reader, "mask_illegal", options.mask_illegal);
  ReadFlag(reader, "mask_blocked", options.mask_blocked);
  ReadWhole(reader, "threads", 1, 256, options.threads);
}

/// Reads the options that all learners with a replay buffer have.
/// @param max_priority largest allowed value of priority_exponent
/// @throws InputError if a value is invalid or out of range
template <typename Options>
void ReadReplayOptions(OptionReader& reader, double max_priority, Options& options) {
  ReadWhole(reader, "batch_size", 1, 65536, options.batch_size);
  ReadWhole(reader, "learning_starts", 0, 1e9, options.learning_starts);
  ReadWhole(reader, "buffer_size", 100, 1e9, options.buffer_size);
  ReadWhole(reader, "n_step", 1, 100, options.n_step);
  ReadNumber(reader, "priority_exponent", 0.0, max_priority, options.priority_exponent);
  ReadNumber(reader, "importance_exponent", 0.0, 1.0, options.importance_exponent);
  options.device = ReadDevice(reader);
}

}  // namespace aquafarm::agents
