// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "aquafarm/scenario/scenario.h"
#include "aquafarm/storms/to_disaster.h"

namespace aquafarm {

/// A field of the sea over the ranch, for its `seas` and expressions.
struct SeaLayerRequest {
  std::string name;      ///< in expressions
  std::string file;      ///< netCDF
  std::string variable;  ///< name or standard_name
};

/// What a ranch shall be. What is left open is decided, and said.
struct RanchRequest {
  std::string name{"my_ranch"};
  std::string chart;               ///< GeoJSON, map_server YAML or ASCII grid; empty: open sea
  std::optional<GeoPoint> center;  ///< of the ranch; needed but for a chart in metres without storm
  std::int32_t width{25};          ///< cells; a chart in metres has its own
  std::int32_t height{25};
  double cell_size_m{200.0};
  float sea_level{0.0F};  ///< of an ASCII grid

  std::string track;  ///< file with the storm; empty: calm
  std::string storm;  ///< its name or id; may be empty where the file has one only
  std::string radii;  ///< file with radii for a track without; empty: none
  RingReduction reduction{RingReduction::kEqualArea};
  /// File of bulletins with forecast points, which agents are told while the truth follows the
  /// track; empty: they are told how the storm moves now
  std::string forecasts;

  std::vector<std::string> disasters;  ///< others, as disaster_preset.h has them

  std::int32_t ports{4};
  std::vector<GeoPoint>
      port_places;  ///< each is put on the nearest shore water; instead of `ports`
  std::int32_t devices{4};
  DevicePlacement placement{DevicePlacement::kRandom};
  std::int32_t ships{1};
  double speed_kn{4.0};               ///< of a ship with a device in tow: a cell a step
  std::optional<double> step_s;       ///< instead of speed_kn
  double lead_h{3.0};                 ///< from the start until the widest ring reaches the ranch
  std::optional<std::int64_t> start;  ///< UTC of step 0, instead of lead_h
  std::uint64_t seed{1};

  std::vector<SeaLayerRequest> sea;  ///< at the start's time, or the first of the file
  double sea_depth_m{0.0};
  std::string value;     ///< expression of the layers for each device's value; empty: drawn
  std::string sea_risk;  ///< expression of the layers for each cell's own risk; empty: none

  std::string notices;  ///< file of warnings or anchorage forecasts, said where they are in force
};

}  // namespace aquafarm
