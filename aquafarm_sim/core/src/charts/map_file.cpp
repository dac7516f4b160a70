// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/charts/map_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/layout.h"
#include "base/files.h"
#include "base/text.h"
#include "charts/map_image.h"
#include "charts/map_yaml.h"
#include "scenario/yaml_reader.h"

namespace aquafarm {

std::string_view ToString(MapMode value) {
  constexpr std::array<std::string_view, 3> kNames{"trinary", "scale", "raw"};
  return kNames[static_cast<std::size_t>(value)];
}
namespace internal {
template <>
inline constexpr std::size_t kNameCount<MapMode> = 3;
}

using internal::MapYaml;

MapYaml internal::ParseMapYaml(const std::string& text, const std::string& origin_name) {
  MapYaml map;
  internal::ReadYaml(
      text, origin_name, "a map of map_server",
      [&map](internal::YamlReader& a) {
        using internal::Interval;
        using internal::Need;
        const Interval<double> part{0.0, 1.0};
        a.Field("image", map.image, internal::TextOf{1, 4096}, Need::kRequired);
        a.Field("resolution", map.resolution, Interval<double>{0.01, 1.0e6}, Need::kRequired);
        a.Field("origin", map.origin, internal::ListOf<Interval<double>>{{-1.0e9, 1.0e9}, 3, 3},
                Need::kRequired);
        a.Field("negate", map.negate, Interval<std::int32_t>{0, 1}, Need::kRequired);
        a.Field("occupied_thresh", map.occupied, part, Need::kRequired);
        a.Field("free_thresh", map.free, part, Need::kRequired);
        a.Field("mode", map.mode, internal::OneOfNames{});
      },
      [&map] {
        if (map.free < map.occupied) return;
        throw internal::FieldError("free_thresh", "got " + internal::Format(map.free) +
                                                      ", expected less than occupied_thresh = " +
                                                      internal::Format(map.occupied));
      });
  return map;
}

namespace {

namespace fs = std::filesystem;

// Converts a pixel to occupancy in percent, by the mode and the thresholds of the YAML file.
// Returns -1 for unknown.
std::int8_t Occupancy(const MapYaml& map, std::uint8_t grey, bool opaque) {
  constexpr std::int8_t kUnknown = -1;
  const int light = map.negate != 0 ? 255 - grey : grey;
  if (map.mode == MapMode::kRaw) {
    return light <= 100 ? static_cast<std::int8_t>(light) : kUnknown;
  }
  const double occupied = (255 - light) / 255.0;
  if (occupied > map.occupied) return 100;
  if (occupied < map.free) return 0;
  if (map.mode == MapMode::kTrinary || !opaque) return kUnknown;
  return static_cast<std::int8_t>(1.0 + 98.0 * (occupied - map.free) / (map.occupied - map.free));
}

}  // namespace

MapFile LoadMap(const std::string& yaml_path) {
  const MapYaml yaml = internal::ParseMapYaml(internal::ReadTextFile(yaml_path), yaml_path);
  const fs::path image_path = fs::path(yaml_path).parent_path() / yaml.image;
  const internal::MapImage image =
      internal::ParseMapImage(internal::ReadTextFile(image_path.string()), image_path.string());
  MapFile map;
  map.cell_size_m = yaml.resolution;
  std::copy(yaml.origin.begin(), yaml.origin.end(), map.origin.begin());
  const Eigen::Index rows = image.grey.rows();
  map.occupancy.resize(rows, image.grey.cols());
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (Eigen::Index x = 0; x < image.grey.cols(); ++x) {
      const bool opaque = image.alpha.size() == 0 || image.alpha(row, x) == 255;
      map.occupancy(rows - 1 - row, x) = Occupancy(yaml, image.grey(row, x), opaque);
    }
  }
  return map;
}

void SaveMap(const MapFile& map, const std::string& yaml_path) {
  fs::path picture = yaml_path;
  picture.replace_extension(".pgm");
  const Eigen::Index rows = map.occupancy.rows();
  std::string bytes =
      "P5\n" + std::to_string(map.occupancy.cols()) + " " + std::to_string(rows) + "\n255\n";
  for (Eigen::Index row = rows; row-- > 0;) {
    for (Eigen::Index x = 0; x < map.occupancy.cols(); ++x) {
      const std::int8_t value = map.occupancy(row, x);
      const int grey = value < 0 ? 205 : value >= 65 ? 0 : value <= 19 ? 254 : 205;
      bytes += static_cast<char>(static_cast<unsigned char>(grey));
    }
  }
  internal::WriteFile(picture.string(), bytes);
  using internal::Format;
  internal::WriteFile(yaml_path, "image: " + picture.filename().string() +
                                     "\nresolution: " + Format(map.cell_size_m) + "\norigin: [" +
                                     Format(map.origin[0]) + ", " + Format(map.origin[1]) + ", " +
                                     Format(map.origin[2]) +
                                     "]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

LandShare ShareOfLand(const MapFile& map) {
  if (map.origin[2] != 0.0) {
    throw InputError("origin[2]: got a yaw of " + internal::Format(map.origin[2]) +
                     ", expected 0: a ranch's grid points north");
  }
  return (map.occupancy < 0)
      .select(LandShare::Ones(map.occupancy.rows(), map.occupancy.cols()),
              map.occupancy.cast<float>() / 100.0F);
}

MapFile ToMap(const Scenario& scenario) {
  Layout layout;
  LayoutGenerator(scenario).Generate(scenario.layout_seed, 0, layout);
  MapFile map;
  map.cell_size_m = scenario.cell_size_m;
  // The origin of a map is the corner of cell (0, 0); the origin of the farm is the centre of that
  // cell.
  map.origin = {-scenario.cell_size_m / 2.0, -scenario.cell_size_m / 2.0, 0.0};
  map.occupancy = layout.cells.unaryExpr([](std::uint8_t bits) {
    return static_cast<std::int8_t>((bits & kBlockedBits) != 0 ? 100 : 0);
  });
  return map;
}

}  // namespace aquafarm
