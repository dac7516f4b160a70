// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/saved_policy.h"

#include <filesystem>

#include "aquafarm/agents/training/algorithms.h"
#include "aquafarm/agents/training/run_folder.h"
#include "aquafarm/base/check.h"

namespace aquafarm::agents {

SavedPolicy FindPolicy(const std::string& where) {
  SavedPolicy saved;
  saved.path = where;
  for (const Algorithm& algorithm : Algorithms()) {
    if (algorithm.learns || where != algorithm.name) continue;
    saved.checkpoint.algorithm = where;
    saved.encodings = algorithm.encodings("");
    return saved;
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(where, ignored)) {
    saved.path = where + "/policy.ckpt";
    if (!std::filesystem::exists(saved.path, ignored)) {
      const auto newest = RunFolder::NewestCheckpoint(where);
      if (!newest) {
        throw InputError(where +
                         ": contains neither policy.ckpt nor a checkpoint; expected a run "
                         "folder, a checkpoint file, random, planner, clairvoyant, do_nothing or "
                         "fetch_by_value");
      }
      saved.path = *newest;
    }
  }
  saved.checkpoint = ReadCheckpoint(saved.path);
  saved.encodings = FindAlgorithm(saved.checkpoint.algorithm).encodings(saved.checkpoint.options);
  return saved;
}

std::unique_ptr<Policy> MakePolicy(const SavedPolicy& saved, const EnvironmentSpec& spec) {
  const std::string& version = saved.checkpoint.version;  // empty for policies that do not learn
  if (!version.empty() && version != spec.version) {
    throw InputError(saved.path + ": was trained by aquafarm " + version + ", expected " +
                     spec.version +
                     ": train it again, or evaluate it with the version that trained it");
  }
  try {
    return FindAlgorithm(saved.checkpoint.algorithm).make_policy(saved.checkpoint, spec);
  } catch (const InputError& error) {
    throw InputError(saved.path + ": " + error.what());
  }
}

}  // namespace aquafarm::agents
