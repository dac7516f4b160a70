// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace aquafarm {

/// Conversion of grey values to occupancy, see aquafarm/charts/map_file.h.
enum class MapMode : std::uint8_t { kTrinary, kScale, kRaw };
/// Returns the name used in YAML files.
std::string_view ToString(MapMode value);

namespace internal {

/// Content of a YAML file of map_server; aquafarm/charts/map_file.h explains the keys.
struct MapYaml {
  std::string image;
  double resolution{};  ///< [m per pixel]
  std::vector<double> origin{0.0, 0.0, 0.0};
  std::int32_t negate{};
  double occupied{0.65};  ///< occupied_thresh
  double free{0.196};     ///< free_thresh
  MapMode mode{};
};

/// Parses a YAML file of map_server. Every key except mode is required.
/// @throws InputError "map.yaml:3: origin: …"
MapYaml ParseMapYaml(const std::string& text, const std::string& origin_name);

}  // namespace internal
}  // namespace aquafarm
