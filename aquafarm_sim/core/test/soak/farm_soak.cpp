// SPDX-License-Identifier: BSD-3-Clause
// Each episode is played by random actions, by legal random actions, or by a ship that heads for
// the nearest goal. soak.h checks the farm after each step.
//   farm_soak STEPS SEED SCENARIO.yaml…    (or folders of scenarios; STEPS for each)
#include <limits>

#include "soak/soak.h"

namespace {

using namespace aquafarm;

int Distance(Cell a, Cell b) { return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)); }

/// Returns the move towards the nearest port with a device aboard, else towards the nearest device.
Action Homing(const Farm& farm, const Ship& ship, ActionMask legal, std::mt19937_64& rng) {
  for (const Action act : {Action::kDropOff, Action::kPickup}) {
    if ((legal & MaskOf(act)) != 0) return act;
  }
  std::vector<Cell> goals;
  const bool laden = ship.aboard > 0 || ship.own_device != kNone;
  if (laden) goals = farm.layout().ports;
  for (const Device& device : farm.devices()) {
    const bool fetchable = device.status == DeviceStatus::kDeployed && !device.self_propelled;
    if (!laden && fetchable) goals.push_back(device.cell);
  }
  auto best = static_cast<Action>(rng() % kMoveCount);
  if (rng() % 2 == 0) return best;  // gets around obstacles
  int nearest = std::numeric_limits<int>::max();
  for (std::size_t move = 0; move < kMoves.size(); ++move) {
    const Cell to{ship.cell.x + kMoves[move].x, ship.cell.y + kMoves[move].y};
    if (!soak::OnMap(farm, to) || (farm.layout().bits(to) & kBlockedBits) != 0) continue;
    for (const Cell goal : goals) {
      if (Distance(to, goal) >= nearest) continue;
      nearest = Distance(to, goal);
      best = static_cast<Action>(move);
    }
  }
  return best;
}

void Choose(const Farm& farm, const std::vector<ActionMask>& legal, std::mt19937_64& rng,
            std::vector<std::uint8_t>& actions) {
  for (std::size_t i = 0; i < actions.size(); ++i) {
    std::uint64_t action = rng() % (kActionCount + 1);
    if (farm.episode() % 3 == 1) {
      while ((legal[i] & (1U << action)) == 0) action = rng() % kActionCount;
    } else if (farm.episode() % 3 == 2) {
      action = static_cast<std::uint64_t>(Homing(farm, farm.ships()[i], legal[i], rng));
    }
    actions[i] = static_cast<std::uint8_t>(action);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return soak::Main(argc, argv, "farm_soak",
                    [](const std::shared_ptr<const Scenario>&) { return soak::Chooser(Choose); });
}
