// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace aquafarm_viz {

/// What a picture shows besides the chart, ships and devices.
struct Layers {
  bool wake{true};    ///< the recent way of each ship
  bool risk{true};    ///< the rings of disasters, shaded by severity
  bool route{};       ///< the whole way of each ship, coloured in time order (Fig. 11)
  bool sight{};       ///< in partial view: how far each ship sees
  bool values{};      ///< V_π of each cell, where a policy publishes it
  bool moves{};       ///< the policy's best move in each cell
  std::string sea{};  ///< the layer of the scenario's sea painted below all; empty: none
};

/// Reads names with commas between them, such as "risk,route,sea:warmth"; "none" for nothing.
/// @throws std::invalid_argument "layers: got 'rain', expected some of: wake, risk, …"
Layers ParseLayers(const std::string& names);

/// "wake, risk, …": all there are.
std::string LayerNames();

}  // namespace aquafarm_viz
