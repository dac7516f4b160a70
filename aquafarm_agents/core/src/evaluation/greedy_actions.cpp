// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/evaluation/greedy_actions.h"

#include <algorithm>
#include <memory>
#include <string>

#include "aquafarm/agents/environment/local_environment.h"

namespace aquafarm::agents {
namespace {

// Cells that ship 0 can occupy.
std::vector<Cell> FreeCells(const Farm& farm) {
  std::vector<Cell> cells;
  for (std::int32_t y = 0; y < farm.scenario().height; ++y) {
    for (std::int32_t x = 0; x < farm.scenario().width; ++x) {
      const Cell cell{x, y};
      bool is_free = (farm.layout().bits(cell) & kBlockedBits) == 0;
      for (std::size_t id = 1; id < farm.ships().size(); ++id) {
        is_free = is_free && farm.ships()[id].cell != cell;
      }
      if (is_free) cells.push_back(cell);
    }
  }
  return cells;
}

constexpr std::size_t kCellsAtOnce = 64;

}  // namespace

std::string WhyNoBestMoves(const Scenario& scenario) {
  const std::int64_t cells = std::int64_t{scenario.width} * scenario.height;
  if (cells <= kMaxCells) return "";
  return "the farm has " + std::to_string(cells) +
         " cells, and values and best moves are of farms " + "with up to " +
         std::to_string(kMaxCells);
}

// One farm per cell, in batches, so that one call of the policy covers many cells.
std::vector<GreedyAction> GreedyActions(const Farm& farm, std::uint8_t encodings, Policy& policy,
                                        const std::atomic<bool>* stop) {
  const auto scenario = std::make_shared<const Scenario>(farm.scenario());
  if (!WhyNoBestMoves(*scenario).empty() || !farm.ships()[0].in_play) return {};
  const std::vector<Cell> cells = FreeCells(farm);
  const std::string state = farm.Save();
  std::vector<GreedyAction> moves;
  std::vector<std::uint8_t> actions;
  std::unique_ptr<FarmBatch> farms;  // made again only for the last, smaller batch
  std::unique_ptr<LocalEnvironment> environment;
  while (moves.size() < cells.size() && (stop == nullptr || !*stop)) {
    const std::size_t first = moves.size();
    const auto count = static_cast<std::int32_t>(std::min(kCellsAtOnce, cells.size() - first));
    if (farms == nullptr || farms->farms() != count) {
      farms = std::make_unique<FarmBatch>(scenario, count);
      environment = std::make_unique<LocalEnvironment>(
          scenario, EnvironmentOptions{count, encodings, false, 1});
    }
    for (std::int32_t i = 0; i < count; ++i) {
      Farm& one = farms->farm(i);
      one.Load(state);
      one.PlaceShip(0, cells[first + static_cast<std::size_t>(i)]);
    }
    policy.Begin(farm.seed(), count);
    policy.Act(environment->Load(farms->Save()), actions);
    const auto agents = static_cast<std::size_t>(environment->spec().agents);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      GreedyAction move{cells[first + i], actions[i * agents]};
      if (!policy.values().empty()) move.value = policy.values()[i * agents];
      moves.push_back(move);
    }
  }
  return moves;
}

}  // namespace aquafarm::agents
