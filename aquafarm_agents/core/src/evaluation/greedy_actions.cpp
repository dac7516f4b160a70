// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/evaluation/greedy_actions.h"

#include <algorithm>
#include <memory>
#include <string>

#include "aquafarm/agents/environment/local_environment.h"
#include "evaluation/free_cells.h"

namespace aquafarm::agents {

std::string WhyNoBestMoves(const Scenario& scenario) {
  const std::int64_t cells = std::int64_t{scenario.width} * scenario.height;
  if (cells <= kMaxCells) return "";
  return "the farm has " + std::to_string(cells) +
         " cells, but values and best moves are computed for at most " + std::to_string(kMaxCells);
}

std::vector<GreedyAction> GreedyActions(const Farm& farm, std::uint8_t observation_types,
                                        Policy& policy, const std::atomic<bool>* stop) {
  if (!WhyNoBestMoves(farm.scenario()).empty() || !farm.ships()[0].active) return {};
  const std::vector<Cell> cells = FreeCells(farm);
  std::vector<GreedyAction> moves;
  std::vector<std::uint8_t> actions;
  std::unique_ptr<LocalEnvironment> farms;  // remade only for the last group, which may be smaller
  while (moves.size() < cells.size() && (stop == nullptr || !*stop)) {
    const std::size_t first = moves.size();
    const auto count = static_cast<std::int32_t>(std::min(kCellsAtOnce, cells.size() - first));
    if (farms == nullptr || farms->spec().farms != count) {
      farms = std::make_unique<LocalEnvironment>(
          farm.shared_scenario(), EnvironmentOptions{count, observation_types, false, 1});
    }
    policy.Begin(farm.seed(), count);
    policy.Act(PlaceInEach(farm, cells, first, *farms), actions);
    const auto agents = static_cast<std::size_t>(farms->spec().agents);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      GreedyAction move{cells[first + i], actions[i * agents]};
      if (!policy.values().empty()) move.value = policy.values()[i * agents];
      moves.push_back(move);
    }
  }
  return moves;
}

}  // namespace aquafarm::agents
