// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/scene/layers.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace aquafarm_viz {

namespace {

constexpr std::pair<const char*, bool Layers::*> kNames[]{
    {"trail", &Layers::trail},           {"risk", &Layers::risk},     {"route", &Layers::route},
    {"sight", &Layers::sight},           {"values", &Layers::values}, {"moves", &Layers::moves},
    {"directions", &Layers::directions}, {"labels", &Layers::labels}};

}  // namespace

std::string LayerNames() {
  std::string names;
  for (const auto& [name, member] : kNames) names += std::string(name) + ", ";
  return names + "sea:NAME";
}

Layers ParseLayers(const std::string& names) {
  Layers layers;
  for (const auto& [name, member] : kNames) layers.*member = false;
  if (names == "none") return layers;
  std::istringstream text(names);
  std::string name;
  do {
    std::getline(text, name, ',');
    if (name.rfind("sea:", 0) == 0 && name.size() > 4) {
      layers.sea = name.substr(4);
      continue;
    }
    if (name == "wake") {
      std::fprintf(stderr, "layers: wake is now called trail\n");
      name = "trail";
    }
    const auto found = std::find_if(std::begin(kNames), std::end(kNames),
                                    [&name](const auto& known) { return name == known.first; });
    if (found == std::end(kNames)) {
      throw std::invalid_argument("layers: got '" + name + "', expected some of: " + LayerNames() +
                                  "; or none");
    }
    layers.*(found->second) = true;
  } while (text.good());
  return layers;
}

}  // namespace aquafarm_viz
