// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/planning/optimum.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "aquafarm/agents/base/text.h"
#include "aquafarm/agents/planning/planner.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/rng.h"

namespace aquafarm::agents {
namespace {

constexpr std::size_t kResamples = 1000;

struct Pair {
  double got{};
  double best{};
};

// Returns the number of states of a plan. A planner would allocate memory for all of them, so this
// function computes the number without a planner. Each device is deployed, aboard (as paid or as
// unpaid) or gone, and the number aboard is at most the capacity.
double StatesOf(const Scenario& scenario) {
  const std::int32_t devices = scenario.devices.Total();
  double sets = 0.0;
  double chosen = 1.0;  // number of ways to choose the devices aboard
  double aboard_ways = 1.0;
  for (std::int32_t aboard = 0; aboard <= std::min(devices, scenario.ships.capacity); ++aboard) {
    double rest = 1.0;
    for (std::int32_t i = aboard; i < devices; ++i) rest *= 2.0;
    sets += chosen * aboard_ways * rest;
    chosen *= static_cast<double>(devices - aboard) / (aboard + 1.0);
    aboard_ways *= 2.0;
  }
  return sets * scenario.CellCount();
}

// Plays the best plan. Returns the farm at the end of the episode, or nullopt if the plan has too
// many devices or states. Throws InputError if the planner does not support the scenario.
std::optional<Farm> PlayBest(Farm farm, std::size_t max_states) {
  const std::size_t most = std::min(max_states, kMaxPlanStates);
  if (farm.scenario().devices.Total() > kMaxPlanDevices ||
      StatesOf(farm.scenario()) > static_cast<double>(most)) {
    return std::nullopt;
  }
  Planner planner(farm.scenario());
  const Plan plan = planner.Solve(farm, Foresight::kOracle);
  for (const std::uint8_t action : plan.actions) {
    if (!farm.over()) farm.Step(&action);
  }
  const std::uint8_t any = 0;
  while (!farm.over()) farm.Step(&any);  // a plan may end before the episode
  return farm;
}

void Bootstrap(const std::vector<Pair>& pairs, std::uint64_t seed, OptimumShare& share) {
  RandomStream rng({seed, 0, RngStream::kExploration, 0});
  std::vector<double> shares;
  for (std::size_t i = 0; i < kResamples; ++i) {
    Pair sum;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const Pair& pair = pairs[rng.Below(static_cast<std::uint32_t>(pairs.size()))];
      sum.got += pair.got;
      sum.best += pair.best;
    }
    if (sum.best > 0.0) shares.push_back(sum.got / sum.best);
  }
  if (shares.empty()) {
    share.low = share.high = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  std::sort(shares.begin(), shares.end());
  share.low = shares[shares.size() / 40];
  share.high = shares[shares.size() - 1 - shares.size() / 40];
}

}  // namespace

OptimumShare CompareWithOptimum(
    const std::vector<EpisodeSummary>& episodes,
    const std::function<Farm(std::uint64_t seed, std::uint64_t episode)>& make_farm,
    std::size_t max_states, std::uint64_t seed, const std::atomic<bool>* stop) {
  OptimumShare share;
  std::vector<Pair> pairs;
  for (const EpisodeSummary& result : episodes) {
    if (stop != nullptr && *stop) break;
    Farm farm = make_farm(result.seed, result.episode);
    if (farm.scenario().AgentCount() > 1) {
      throw InputError("optimum: got " + std::to_string(farm.scenario().AgentCount()) +
                       " agents, expected one; use --bound, an upper bound for several");
    }
    const std::optional<Farm> best = PlayBest(std::move(farm), max_states);
    if (!best) {
      ++share.too_large;
      continue;
    }
    pairs.push_back({static_cast<double>(result.episode_return),
                     static_cast<double>(best->record().episode_return)});
    share.mean_return += pairs.back().got;
    share.mean_optimum += pairs.back().best;
    if (!best->record().Success()) continue;
    ++share.solvable;
    share.solved += result.Success() ? 1 : 0;
  }
  share.planned = pairs.size();
  if (pairs.empty()) return share;
  share.mean_return /= static_cast<double>(pairs.size());
  share.mean_optimum /= static_cast<double>(pairs.size());
  if (!(share.mean_optimum > 0.0)) {
    throw InputError("optimum: the best plans have the mean return " +
                     FormatNumber(share.mean_optimum) +
                     ", expected more than 0, because a share of it is printed; evaluate without "
                     "--optimum");
  }
  share.share = share.mean_return / share.mean_optimum;
  Bootstrap(pairs, seed, share);
  return share;
}

}  // namespace aquafarm::agents
