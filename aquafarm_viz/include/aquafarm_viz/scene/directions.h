// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The legal moves of a ship at each port (Fig. 5 of the paper, see docs/model.md).

#include <aquafarm_msgs/FarmSpec.h>

#include <cstdint>
#include <vector>

namespace aquafarm_viz {

/// The legal moves of a ship at one port of the farm.
struct PortDirections {
  std::int32_t port{};                ///< id of the port
  aquafarm_msgs::Cell cell;           ///< cell of the port
  std::vector<std::uint8_t> actions;  ///< legal moves, 0 to 7 as in Move.srv, ascending
};

/// Returns the legal moves at each port inside the grid. A move is legal if its target cell is
/// inside the grid and contains neither an island nor a rock. Ships are ignored.
std::vector<PortDirections> LegalDirections(const aquafarm_msgs::FarmSpec& spec);

}  // namespace aquafarm_viz
