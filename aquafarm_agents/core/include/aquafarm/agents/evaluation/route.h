// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The route of ship 0 in one episode that a policy plays, and the policy's greedy action in each
/// cell. The package aquafarm_benchmark draws them like Fig. 11 of the paper.

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

/// Makes a new policy for farms of a spec.
using MakePolicyFor = std::function<std::unique_ptr<Policy>(const EnvironmentSpec&)>;

/// State of the farm before a step, or at the end of the episode.
struct RouteStep {
  Cell cell{};               ///< of ship 0
  std::int32_t aboard{};     ///< devices aboard ship 0
  std::int32_t delivered{};  ///< devices delivered so far, by all agents
  float episode_return{};    ///< sum of the individual rewards of all agents so far
  std::vector<Disaster> disasters;
  std::uint8_t action{};  ///< action of ship 0 in this step; unused in the last entry
};

/// A recorded episode.
struct Route {
  std::shared_ptr<const Layout> layout;
  std::vector<RouteStep> steps;  ///< [number of steps + 1]
  /// [number of steps, agents] actions of all agents, from which the episode can be replayed
  std::vector<std::uint8_t> actions;
  EpisodeSummary result;
  std::vector<GreedyAction> at_start;      ///< GreedyActions at the start of the episode
  std::vector<GreedyAction> after_pickup;  ///< those after ship 0's first pickup; empty without one
};

/// Plays the episode with number `episode` of EvaluationSeed(seed) and records the route of ship 0.
/// The policy controls all agents.
/// @param stop may be set by a signal handler; the route then ends early. Null if the function
///        cannot be stopped
/// @throws InputError if the scenario does not support the observation types, or if the policy does
///   not fit the scenario
Route TraceRoute(const std::shared_ptr<const Scenario>& scenario, std::uint8_t observation_types,
                 const MakePolicyFor& make_policy, std::uint64_t seed, std::uint64_t episode,
                 const std::atomic<bool>* stop = nullptr);

/// Writes a JSON file: the scenario, the result, the layout of the farm (key `chart`), an entry for
/// each element of route.steps, the actions of all agents, and the greedy actions.
/// @throws StorageError
void WriteRoute(const std::string& path, const Route& route, const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
