// SPDX-License-Identifier: BSD-3-Clause
#include "scene/port_shift.h"

#include <algorithm>
#include <cmath>

#include "aquafarm_viz/base/checks.h"

namespace aquafarm_viz {

using aquafarm_msgs::DeviceState;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

cv::Point PortShift(const FarmSpec& spec, const FarmState& state,
                    const aquafarm_msgs::PortInfo& port) {
  const auto is_ship_at = [&state](int x, int y) {
    return std::any_of(state.ships.begin(), state.ships.end(), [x, y](const auto& ship) {
      return ship.visible && ship.active && ship.x == x && ship.y == y;
    });
  };
  if (!is_ship_at(port.cell.x, port.cell.y)) return {0, 0};
  // Distance of a cell to the nearest ship, other port or deployed device.
  const auto free_around = [&](int x, int y) {
    double nearest = spec.width + spec.height;
    const auto keep_off = [&](int other_x, int other_y) {
      nearest = std::min(nearest, std::hypot(other_x - x, other_y - y));
    };
    for (const auto& other : spec.ports) {
      if (other.id != port.id) keep_off(other.cell.x, other.cell.y);
    }
    for (const auto& ship : state.ships) {
      const bool is_here = ship.x == port.cell.x && ship.y == port.cell.y;
      if (ship.visible && ship.active && !is_here) keep_off(ship.x, ship.y);
    }
    for (const auto& device : state.devices) {
      if (device.status == DeviceState::DEPLOYED) keep_off(device.x, device.y);
    }
    return nearest;
  };
  constexpr double kEnough = 2.0;  // [cells]
  const int away = -DeliveredSide(spec, port.cell.y);
  cv::Point best(-1, away);
  double widest = -1.0;
  for (const cv::Point shift : {cv::Point(-1, away), {1, away}, {-1, -away}, {1, -away}}) {
    const int x = port.cell.x + shift.x;
    const int y = port.cell.y + shift.y;
    const double room = InGrid(spec, x, y) ? std::min(kEnough, free_around(x, y)) : -1.0;
    if (room <= widest) continue;
    widest = room;
    best = shift;
  }
  return best;
}

}  // namespace aquafarm_viz
