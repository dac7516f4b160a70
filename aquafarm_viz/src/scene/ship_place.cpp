// SPDX-License-Identifier: BSD-3-Clause
#include "scene/ship_place.h"

#include <algorithm>
#include <cmath>

#include "aquafarm_viz/base/checks.h"

namespace aquafarm_viz {

using aquafarm_msgs::DeviceState;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

cv::Point2d ShipPlace(const FarmSpec& spec, const FarmState& state, int x, int y, double aside) {
  const auto port = std::find_if(spec.ports.begin(), spec.ports.end(), [x, y](const auto& one) {
    return one.cell.x == x && one.cell.y == y;
  });
  if (port == spec.ports.end()) return {double(x), double(y)};
  // Returns the distance from a cell to the nearest other port, deployed device, or ship outside
  // this port.
  const auto free_around = [&](int column, int row) {
    double nearest = spec.width + spec.height;
    const auto keep_off = [&](int other_x, int other_y) {
      nearest = std::min(nearest, std::hypot(other_x - column, other_y - row));
    };
    for (const auto& other : spec.ports) {
      if (other.id != port->id) keep_off(other.cell.x, other.cell.y);
    }
    for (const auto& ship : state.ships) {
      const bool is_here = ship.x == x && ship.y == y;
      if (ship.visible && ship.active && !is_here) keep_off(ship.x, ship.y);
    }
    for (const auto& device : state.devices) {
      if (device.status == DeviceState::DEPLOYED) keep_off(device.x, device.y);
    }
    return nearest;
  };
  const auto is_land = [&spec](cv::Point at) {
    const auto is_there = [at](const auto& cell) { return cell.x == at.x && cell.y == at.y; };
    return std::any_of(spec.islands.begin(), spec.islands.end(), is_there) ||
           std::any_of(spec.rocks.begin(), spec.rocks.end(),
                       [&](const auto& rock) { return is_there(rock.cell); });
  };
  constexpr double kEnough = 2.0;  // [cells]
  const int away = -DeliveredSide(spec, y);
  cv::Point best(-1, away);
  double widest = -2.0;
  for (const cv::Point shift : {cv::Point(-1, away), {1, away}, {-1, -away}, {1, -away}}) {
    const cv::Point to(cv::Point2d(x, y) + aside * cv::Point2d(shift));  // rounded
    const double room = !InGrid(spec, to.x, to.y) ? -1.0
                        : is_land(to)             ? -0.5
                                                  : std::min(kEnough, free_around(to.x, to.y));
    if (room <= widest) continue;
    widest = room;
    best = shift;
  }
  return cv::Point2d(x, y) + aside * cv::Point2d(best);
}

}  // namespace aquafarm_viz
