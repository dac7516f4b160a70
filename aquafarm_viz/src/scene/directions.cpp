// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/scene/directions.h"

#include <algorithm>
#include <utility>

#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/base/palette.h"

namespace aquafarm_viz {
namespace {

using Place = std::pair<int, int>;

constexpr std::uint8_t kMoves = 8;

// East and North return the sign of the displacement of a move along their axis: -1, 0 or 1.
int East(int bearing_deg) { return bearing_deg % 180 == 0 ? 0 : bearing_deg < 180 ? 1 : -1; }
int North(int bearing_deg) { return East((bearing_deg + 90) % 360); }

}  // namespace

std::vector<PortDirections> LegalDirections(const aquafarm_msgs::FarmSpec& spec) {
  std::vector<Place> blocked;
  blocked.reserve(spec.islands.size() + spec.rocks.size());
  for (const auto& cell : spec.islands) blocked.emplace_back(cell.x, cell.y);
  for (const auto& rock : spec.rocks) blocked.emplace_back(rock.cell.x, rock.cell.y);
  std::sort(blocked.begin(), blocked.end());
  std::vector<PortDirections> ports;
  for (const auto& port : spec.ports) {
    if (!InGrid(spec, port.cell.x, port.cell.y)) continue;
    PortDirections at{port.id, port.cell, {}};
    for (std::uint8_t action = 0; action < kMoves; ++action) {
      const int bearing = MoveBearingDeg(action);
      const Place next{port.cell.x + East(bearing), port.cell.y + North(bearing)};
      if (InGrid(spec, next.first, next.second) &&
          !std::binary_search(blocked.begin(), blocked.end(), next)) {
        at.actions.push_back(action);
      }
    }
    ports.push_back(at);
  }
  return ports;
}

}  // namespace aquafarm_viz
