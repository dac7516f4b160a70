// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/layers.h"

#include <sstream>
#include <stdexcept>

namespace aquafarm_viz {

Layers ParseLayers(const std::string& names) {
  Layers layers{false, false, false, false};
  if (names == "none") return layers;
  std::istringstream text(names);
  std::string name;
  do {
    std::getline(text, name, ',');
    if (name == "wake") {
      layers.wake = true;
    } else if (name == "risk") {
      layers.risk = true;
    } else if (name == "route") {
      layers.route = true;
    } else if (name == "sight") {
      layers.sight = true;
    } else {
      throw std::invalid_argument("layers: got '" + name +
                                  "', expected some of: wake, risk, route, sight; or none");
    }
  } while (text.good());
  return layers;
}

}  // namespace aquafarm_viz
