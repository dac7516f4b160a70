// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace aquafarm_viz {

/// Optional layers of a picture, in addition to the chart, ships and devices. `trail`, `risk`,
/// `directions` and `labels` are also layers of the rviz markers. "Fig." refers to the figures of
/// the paper (docs/model.md).
struct Layers {
  bool trail{true};   ///< recent trail of each ship
  bool risk{true};    ///< rings of disasters, shaded by severity
  bool route{};       ///< whole trail of each ship; older parts are fainter (Fig. 11)
  bool sight{};       ///< sensor range of each ship, if the scenario has partial view
  bool values{};      ///< V_π of each cell, if a policy publishes it
  bool moves{};       ///< greedy actions of the policy, see ShownActions
  bool directions{};  ///< arrows of the legal moves at each port (Fig. 5)
  /// Labels such as "F2" of deployed devices (Fig. 5); in pictures, also of fetched devices.
  bool labels{true};
  std::string sea{};  ///< sea layer of the scenario, drawn below all others; empty: none
};

/// Parses names of layers separated by commas, such as "risk,route,sea:warmth". "none" selects no
/// layer.
/// @throws std::invalid_argument "layers: got 'rain', expected some of: trail, risk, …; or none"
Layers ParseLayers(const std::string& names);

/// Returns the names of all layers: "trail, risk, …, sea:NAME".
std::string LayerNames();

}  // namespace aquafarm_viz
