// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace aquafarm {

/// Conversion of an image's grey values to occupancy.
enum class MapMode : std::uint8_t { kTrinary, kScale, kRaw };
std::string_view ToString(MapMode value);

namespace internal {

/// Content of a YAML file of map_server.
struct MapYaml {
  std::string image;
  double resolution{};
  std::vector<double> origin{0.0, 0.0, 0.0};
  std::int32_t negate{};
  double occupied{0.65};
  double free{0.196};
  MapMode mode{};
};

/// Parses a YAML file of map_server. @throws InputError "map.yaml:3: origin: …"
MapYaml ParseMapYaml(const std::string& text, const std::string& origin_name);

}  // namespace internal
}  // namespace aquafarm
