// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Helpers of the programs: scenario lookup, Ctrl-C and exit codes.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/base/exit_code.h"
#include "aquafarm/agents/base/options.h"
#include "aquafarm/agents/base/storage.h"
#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm/scenario/validate.h"

namespace aquafarm::agents {

/// Whether Ctrl-C or SIGTERM has requested the end of the program.
inline std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // set in a signal handler

/// Times of the first SIGINT (element 0) and of the first SIGTERM (element 1) on the monotonic
/// clock [ms]; 0 until the signal arrives.
inline std::array<std::atomic<std::int64_t>, 2> first_signal_ms{};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

/// Installs handlers for SIGINT (Ctrl-C) and SIGTERM. The first signal sets stop_requested, so that
/// the program saves and exits. A repetition of the same signal ends the program at once if it
/// arrives at least half a second after the first one. An earlier repetition is ignored. Such early
/// repetitions occur if a benchmark is killed: the kernel then signals the programs that the
/// benchmark started (PR_SET_PDEATHSIG), once for each thread of the benchmark that ends.
inline void StopOnSignals() {
  const auto handler = [](int signal) {
    constexpr std::int64_t kSame_ms = 500;
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    const std::int64_t now_ms = std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000;
    std::atomic<std::int64_t>& first_ms = first_signal_ms[signal == SIGTERM ? 1 : 0];
    stop_requested = true;
    if (first_ms == 0) {
      first_ms = now_ms;
    } else if (now_ms - first_ms >= kSame_ms) {
      std::signal(signal, SIG_DFL);
      std::raise(signal);  // delivered when this handler returns
    }
  };
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
}

/// Returns the folder of the shipped scenarios: that of the workspace in which this program is
/// installed, else that of the sources.
inline std::string ScenarioFolder() {
  namespace fs = std::filesystem;
  std::error_code ignored;
  // <prefix>/lib/<package>/<program>
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path prefix = program.parent_path().parent_path().parent_path();
  const fs::path installed = prefix / "share" / "aquafarm_sim" / "scenarios";
  return fs::is_directory(installed, ignored) ? installed.string() : AQUAFARM_SCENARIO_DIR;
}

/// Loads a scenario by path, or by name from `folder` or `folder`/families.
/// @throws InputError if there is no such scenario or it is invalid
inline Scenario FindScenario(const std::string& name, const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const std::string shipped = folder + "/" + name + ".yaml";
  const bool is_name = name.find('/') == std::string::npos;
  if (is_name && fs::exists(shipped, ignored)) {
    return LoadScenario(shipped);
  }
  const std::string families = folder + "/families";
  const std::string family = families + "/" + name + ".yaml";
  if (is_name && fs::exists(family, ignored)) return LoadScenario(family);
  if (fs::exists(name, ignored)) return LoadScenario(name);
  std::vector<std::string> names;
  for (const std::string& place : {folder, families}) {
    for (const auto& entry : fs::directory_iterator(place, ignored)) {
      if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  throw InputError("scenario: got '" + name + "', expected a file or one of: " + Join(names));
}

/// Scenario selected on the command line.
struct ScenarioChoice {
  std::string name{"paper"};
  std::string folder{ScenarioFolder()};
  std::int32_t max_steps{};  ///< step limit of an episode; 0: the scenario's own
  bool tokens{};             ///< whether to observe by entity tokens even if the scenario does not

  /// Loads the scenario and applies the options.
  /// @throws InputError in the same cases as FindScenario, or if the scenario is invalid with the
  ///   options, for example if max_steps is above 10,000,000
  std::shared_ptr<const Scenario> Load() const {
    Scenario scenario = FindScenario(name, folder);
    if (tokens && !scenario.view.tokens) {
      scenario.view.tokens = true;  // the hash stays, because the farms do not change
      ValidateScenario(scenario);
    }
    if (max_steps == 0) return std::make_shared<const Scenario>(std::move(scenario));
    scenario.step_limit = max_steps;
    // Parsing the text of the scenario sets the hash to that of the text, as for a file.
    return std::make_shared<const Scenario>(ParseScenario(ToYaml(scenario), scenario.name));
  }
};

/// Adds the options --max-steps and --scenarios, which set members of `choice`.
inline void AddScenarioOptions(CLI::App& app, ScenarioChoice& choice) {
  app.add_option("--max-steps", choice.max_steps, "step limit of an episode; 0: the scenario's own")
      ->check(CLI::Range(0, 10000000));
  app.add_option("--scenarios", choice.folder, "folder of the shipped scenarios");
}

/// Runs `body`, which parses the arguments, runs the program and returns its exit code. If `body`
/// throws, prints the error to stderr and returns the exit code of bad input, storage or an
/// internal error. For --help, prints the help and returns 0.
template <typename Body>
int RunWithExitCodes(const CLI::App& app, Body body) {
  try {
    return body();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::kBadInput);
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(ExitCode::kBadInput);
  } catch (const StorageError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(ExitCode::kStorage);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "internal error: %s\n", error.what());
    return static_cast<int>(ExitCode::kInternal);
  }
}

}  // namespace aquafarm::agents
