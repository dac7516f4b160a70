// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/agents/training/python_policy.h"

namespace aquafarm::agents {

/// Name of the policy that is shipped: trained on a family of ranches, it plays any ranch with one
/// ship. docs/generalist.md has its results.
inline constexpr const char* kGeneralist = "generalist";

/// A policy loaded from disk, or a built-in one.
struct SavedPolicy {
  std::string path;       ///< source file, or the name of a built-in policy
  Checkpoint checkpoint;  ///< contents of the file; a built-in policy has only the algorithm
  std::uint8_t observation_types{};
  std::shared_ptr<PolicyProcess> process;  ///< of a policy in Python, which is then the policy
};

/// Finds a policy by path or name.
/// @param where a run folder, a policy or checkpoint file, a policy in Python (FILE.py,
/// FILE.py:FUNCTION or FILE.zip, python_policy.h), or generalist, random, planner, clairvoyant,
/// do_nothing or fetch_by_value
/// @throws InputError if there is no such policy, or the file is damaged
SavedPolicy FindPolicy(const std::string& where);

/// Returns whether a policy reads entity tokens (observation/tokens.h).
bool ReadsTokens(const Checkpoint& checkpoint);

/// Makes a policy that plays on farms of `spec`. The scenario may differ from that of the training.
/// @throws InputError with the reason if it does not fit
std::unique_ptr<Policy> MakePolicy(const SavedPolicy& saved, const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
