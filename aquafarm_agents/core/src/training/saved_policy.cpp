// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/saved_policy.h"

#include <filesystem>

#include "aquafarm/agents/training/algorithms.h"
#include "aquafarm/agents/training/run_folder.h"
#include "aquafarm/base/check.h"
#include "ppo/token_layout.h"
#include "training/token_policy.h"

namespace aquafarm::agents {
namespace {

namespace fs = std::filesystem;

// Returns the path of generalist.ckpt: in the workspace where this program is installed, else in
// the sources.
std::string GeneralistPath() {
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);  // <prefix>/lib/<package>/
  const fs::path prefix = program.parent_path().parent_path().parent_path();
  const fs::path installed = prefix / "share/aquafarm_agents/policies/generalist.ckpt";
  return fs::exists(installed, ignored) ? installed.string()
                                        : AQUAFARM_POLICY_DIR "/generalist.ckpt";
}

std::uint8_t ObservationTypesOf(const Checkpoint& checkpoint) {
  const Algorithm& algorithm = FindAlgorithm(checkpoint.algorithm);
  std::uint8_t bits = algorithm.observation_types(checkpoint.options);
  bits &= static_cast<std::uint8_t>(~algorithm.only_for_training);
  // On farms with other features, a policy that reads tokens needs the states (TokenPolicy).
  return ReadsTokens(checkpoint) ? bits | kStatesBit : bits;
}

}  // namespace

bool ReadsTokens(const Checkpoint& checkpoint) { return HasTokens(checkpoint.spec); }

SavedPolicy FindPolicy(const std::string& where) {
  SavedPolicy saved;
  saved.path = where;
  if (where == kGeneralist) {
    saved.checkpoint = ReadCheckpoint(GeneralistPath());
    saved.observation_types = ObservationTypesOf(saved.checkpoint);
    // The check in MakePolicy is skipped for an empty version. The algorithm's make_policy compares
    // the names of the features, so the generalist fits every version with these features.
    saved.checkpoint.version.clear();
    return saved;
  }
  if (IsPythonPolicy(where)) {
    saved.process = std::make_shared<PolicyProcess>(where);
    saved.checkpoint.algorithm = "python";
    saved.observation_types = saved.process->observation_types();
    return saved;
  }
  for (const Algorithm& algorithm : Algorithms()) {
    if (algorithm.learns || where != algorithm.name) continue;
    saved.checkpoint.algorithm = where;
    saved.observation_types = algorithm.observation_types("");
    return saved;
  }
  std::error_code ignored;
  if (fs::is_directory(where, ignored)) {
    saved.path = where + "/policy.ckpt";
    if (!fs::exists(saved.path, ignored)) {
      const auto newest = RunFolder::NewestCheckpoint(where);
      if (!newest) {
        throw InputError(where +
                         ": contains neither policy.ckpt nor a checkpoint; expected a run "
                         "folder, a checkpoint file, FILE.py, FILE.zip, generalist, random, "
                         "planner, clairvoyant, "
                         "do_nothing or fetch_by_value");
      }
      saved.path = *newest;
    }
  }
  saved.checkpoint = ReadCheckpoint(saved.path);
  saved.observation_types = ObservationTypesOf(saved.checkpoint);
  return saved;
}

std::unique_ptr<Policy> MakePolicy(const SavedPolicy& saved, const EnvironmentSpec& spec) {
  if (saved.process != nullptr) return MakePythonPolicy(saved.process, spec);
  const std::string& version = saved.checkpoint.version;  // empty: any version fits
  if (!version.empty() && version != spec.version) {
    throw InputError(saved.path + ": was trained by aquafarm " + version + ", expected " +
                     spec.version +
                     ": train it again, or evaluate it with the version that trained it");
  }
  try {
    const auto make = [&saved](const EnvironmentSpec& farms) {
      return FindAlgorithm(saved.checkpoint.algorithm).make_policy(saved.checkpoint, farms);
    };
    if (!ReadsTokens(saved.checkpoint) || HasTokens(spec)) return make(spec);
    return std::make_unique<TokenPolicy>(spec, make);
  } catch (const InputError& error) {
    throw InputError(saved.path + ": " + error.what());
  }
}

}  // namespace aquafarm::agents
