// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/agents/training/python_policy.h"

namespace aquafarm::agents {

/// Name of the shipped policy. It was trained on a family of ranches, for ranches with one ship.
/// Results: docs/results/generalist.md.
inline constexpr const char* kGeneralist = "generalist";

/// A policy loaded from disk, or a built-in one.
struct SavedPolicy {
  std::string path;       ///< source file, or the name of a built-in policy
  Checkpoint checkpoint;  ///< complete for a trained policy; for others, only `algorithm` is set
  std::uint8_t observation_types{};
  std::shared_ptr<PolicyProcess> process;  ///< process of a policy in Python; null for others
};

/// Finds a policy by path or name.
/// @param where a run folder, a policy or checkpoint file, a policy in Python (FILE.py,
///   FILE.py:FUNCTION or FILE.zip, see python_policy.h), `generalist`, or the name of an algorithm
///   that does not learn, such as random, planner, clairvoyant, do_nothing or fetch_by_value. In a
///   run folder without policy.ckpt, the newest checkpoint is used
/// @throws InputError if there is no such policy, if its file is damaged, or if its Python process
///   cannot start
SavedPolicy FindPolicy(const std::string& where);

/// Returns whether a policy reads entity tokens (observation/tokens.h).
bool ReadsTokens(const Checkpoint& checkpoint);

/// Makes a policy that plays on farms of `spec`. Their scenario may differ from that of the
/// training.
/// @throws InputError if the policy does not fit the farms, or if it was trained by another version
std::unique_ptr<Policy> MakePolicy(const SavedPolicy& saved, const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
