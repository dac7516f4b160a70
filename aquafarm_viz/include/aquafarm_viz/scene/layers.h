// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace aquafarm_viz {

/// Optional layers of a picture, in addition to the chart, ships and devices. `directions` and
/// `labels` are also layers of the markers.
struct Layers {
  bool trail{true};   ///< recent trail of each ship
  bool risk{true};    ///< rings of disasters, shaded by severity
  bool route{};       ///< whole trail of each ship, coloured in time order (Fig. 11)
  bool sight{};       ///< sensor range of each ship in partial view
  bool values{};      ///< V_π of each cell, if a policy publishes it
  bool moves{};       ///< greedy action of the policy in each cell
  bool directions{};  ///< arrows of the legal moves at each port (Fig. 5)
  bool labels{};      ///< F and the id of each device that is not delivered (Fig. 5)
  std::string sea{};  ///< sea layer of the scenario that is the background; empty: no sea layer
};

/// Parses names separated by commas, such as "risk,route,sea:warmth"; "none" for no layer.
/// @throws std::invalid_argument "layers: got 'rain', expected some of: trail, risk, …"
Layers ParseLayers(const std::string& names);

/// Returns the names of all layers: "trail, risk, …".
std::string LayerNames();

}  // namespace aquafarm_viz
