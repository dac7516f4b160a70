// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/bag/bag_policy.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>

#include "aquafarm/agents/base/exit_code.h"
#include "aquafarm/agents/base/storage.h"
#include "aquafarm/base/check.h"

namespace {

using aquafarm::agents::ExitCode;

constexpr int kDiffers = 1;

std::string Value(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f", value);
  return std::isfinite(value) ? text : "-";
}

void Print(const aquafarm_agents::BagChoices& choices) {
  std::printf("%10s %20s %7s %9s %9s %9s %9s\n", "episode", "seed", "steps", "agreed", "V start",
              "V mean", "return");
  unsigned long long agreed = 0;
  unsigned long long all = 0;
  for (const auto& one : choices.episodes) {
    agreed += one.agreed;
    all += one.choices;
    const double share =
        one.choices == 0 ? std::nan("") : 100.0 * double(one.agreed) / double(one.choices);
    std::printf(
        "%10llu %20llu %7llu %7s %% %9s %9s %9s\n", static_cast<unsigned long long>(one.episode),
        static_cast<unsigned long long>(one.seed), static_cast<unsigned long long>(one.steps),
        Value(share).c_str(), Value(double(one.value_at_start)).c_str(),
        Value(one.mean_value).c_str(), Value(double(one.episode_return)).c_str());
  }
  if (all > 0) std::printf("%llu of %llu choices agree with the recorded actions\n", agreed, all);
}

}  // namespace

int main(int argc, char** argv) {
  std::string bag;
  std::string policy;
  aquafarm_agents::BagPolicyOptions options;
  CLI::App app(
      "Compares the recorded actions of a bag with those that a saved policy chooses in the same\n"
      "states, and prints the policy's expected return (V, discounted). Needs no ROS master.\n"
      "Exit code 0: compared; 1: a recorded state differs from the simulated one, or steps are "
      "missing;\n"
      "2: the bag or the policy cannot be used; 3: the output bag could not be written.",
      "bag_policy");
  app.add_option("bag", bag, "bag with the topic spec and every message of the topic state")
      ->required();
  app.add_option("policy", policy,
                 "run folder, checkpoint file, FILE.py, FILE.zip (docs/python.md), random, "
                 "planner, clairvoyant, do_nothing, fetch_by_value or generalist")
      ->required();
  app.add_option("-o,--output", options.output,
                 "write a copy of the bag with the policy's choices (choice) and values");
  auto* every = app.add_option("--values-every", options.values_every,
                               "steps between two maps of values; 0: none")
                    ->capture_default_str();
  app.add_option("--values-at", options.values_at, "write a map of values at these steps only")
      ->excludes(every);
  app.add_option("--ns", options.ns, "namespace of the ranch (default: the only one in the bag)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::kBadInput);
  }
  try {
    const auto saved = aquafarm::agents::FindPolicy(policy);
    const aquafarm_agents::BagChoices choices = aquafarm_agents::AskAlong(bag, saved, options);
    Print(choices);
    if (!choices.no_maps.empty()) {
      std::fprintf(stderr, "bag_policy: %s: no maps of values are written: %s\n", bag.c_str(),
                   choices.no_maps.c_str());
    }
    if (choices.difference.empty()) return 0;
    std::fprintf(stderr, "bag_policy: %s: differs: %s\n", bag.c_str(), choices.difference.c_str());
    return kDiffers;
  } catch (const aquafarm::InputError& error) {
    std::fprintf(stderr, "bag_policy: %s\n", error.what());
    return static_cast<int>(ExitCode::kBadInput);
  } catch (const aquafarm::agents::StorageError& error) {
    std::fprintf(stderr, "bag_policy: %s\n", error.what());
    return static_cast<int>(ExitCode::kStorage);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bag_policy: %s: %s\n", bag.c_str(), error.what());
    return static_cast<int>(ExitCode::kBadInput);
  }
}
