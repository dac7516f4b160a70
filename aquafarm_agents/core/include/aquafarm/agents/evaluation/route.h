// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// One episode as a policy plays it, and what it would do if the ship were elsewhere: what Fig. 11
/// shows as a coloured route and an arrow at each cell.

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/agents/evaluation/greedy_actions.h"
#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

/// Makes the policy for farms of a spec, afresh: without anything carried from earlier steps.
using MakePolicyFor = std::function<std::unique_ptr<Policy>(const EnvironmentSpec&)>;

/// The farm before a step, or at the end.
struct RouteStep {
  Cell cell{};  ///< of ship 0
  std::int32_t aboard{};
  std::int32_t delivered{};
  float episode_return{};  ///< so far
  std::vector<Disaster> disasters;
  std::uint8_t action{};  ///< taken then; of the last entry, none
};

struct Route {
  std::shared_ptr<const Layout> layout;
  std::vector<RouteStep> steps;
  std::vector<std::uint8_t>
      actions;  ///< [steps, agents] of all agents: with them it is played again
  EpisodeResult result;
  /// The greedy action of ship 0 in every free cell, as the farm stands at the episode's start and
  /// (empty when that never comes) right after the first pickup. A policy with a memory is asked
  /// with an empty one.
  std::vector<BestMove> at_start;
  std::vector<BestMove> after_pickup;
};

/// Plays one episode of EvaluationSeed(seed), ship 0's route; other agents play along.
/// @param stop may be set by a signal handler: the route then ends where it is; null: never
/// @throws InputError when the scenario or the policy do not fit
Route TraceRoute(const std::shared_ptr<const Scenario>& scenario, std::uint8_t encodings,
                 const MakePolicyFor& make_policy, std::uint64_t seed, std::uint64_t episode,
                 const std::atomic<bool>* stop = nullptr);

/// Writes it as JSON: the chart, an entry a step, and the best moves. @throws StorageError
void WriteRoute(const std::string& path, const Route& route, const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
