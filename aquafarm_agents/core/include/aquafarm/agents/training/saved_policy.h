// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/agents/learning/checkpoint.h"

namespace aquafarm::agents {

/// A policy as it was found on disk.
struct SavedPolicy {
  std::string path;       ///< file that it was read from, or the name of one that needs none
  Checkpoint checkpoint;  ///< what the file says; of one without a file its algorithm alone
  std::uint8_t encodings{};
};

/// Finds a policy.
/// @param where a run folder, a policy or checkpoint file, or random, planner or clairvoyant
/// @throws InputError when there is none, or it is damaged
SavedPolicy FindPolicy(const std::string& where);

/// Makes it play on farms of `spec`, which need not be the scenario that it was trained on.
/// @throws InputError when it does not fit, with the reason
std::unique_ptr<Policy> MakePolicy(const SavedPolicy& saved, const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
