// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "aquafarm/scenario/scenario.h"
#include "aquafarm/storms/to_disaster.h"

namespace aquafarm {

/// A sea field over the ranch, for `seas` and expressions.
struct SeaLayerRequest {
  std::string name;      ///< name in expressions
  std::string file;      ///< netCDF file
  std::string variable;  ///< name or standard_name
};

/// Recorded storms, one of which is drawn in every episode.
struct ArchiveRequest {
  std::vector<std::string> files;   ///< of tracks; empty: no archive
  Range<std::int32_t> years{0, 0};  ///< of storms for training
  /// Of storms for evaluation; if unset, all years after `years`.
  std::optional<Range<std::int32_t>> evaluation_years;
  double within_km{300.0};  ///< max distance of a storm's closest approach to the middle
};

/// Inputs of BuildRanch. Unset fields get defaults, which are listed in the result.
struct RanchRequest {
  std::string name{"my_ranch"};
  std::string chart;  ///< GeoJSON, map_server YAML or ASCII grid; empty for open sea
  /// Centre of the ranch; optional only for a chart in metres without a storm.
  std::optional<GeoPoint> center;
  std::int32_t width{25};  ///< cells; a chart in metres has its own size
  std::int32_t height{25};
  double cell_size_m{200.0};
  float sea_level{0.0F};  ///< of an ASCII grid

  std::string track;  ///< file with the storm; empty for calm weather
  std::string storm;  ///< name or id of the storm; may be empty if the file has only one
  std::string radii;  ///< file with radii for a track without radii; empty if unused
  RingReduction reduction{RingReduction::kEqualArea};
  /// File of bulletins with forecast points. Agents receive these forecasts, while the storm
  /// follows the track. If empty, agents receive the present motion of the storm.
  std::string forecasts;

  ArchiveRequest archive;  ///< instead of `track`

  std::vector<std::string> disasters;  ///< other disasters, in the format of presets.h

  std::int32_t ports{4};
  std::vector<GeoPoint>
      port_places;     ///< each is moved to the nearest shore water; replaces `ports`
  bool exact_ports{};  ///< a place of `port_places` on land or outside of the ranch is refused
  std::int32_t devices{4};
  DevicePlacement placement{DevicePlacement::kRandom};
  std::int32_t ships{1};
  double speed_kn{4.0};               ///< of a ship that tows a device: one cell per step
  std::optional<double> step_s;       ///< replaces speed_kn
  double lead_h{3.0};                 ///< from the start until the widest ring reaches the ranch
  std::optional<std::int64_t> start;  ///< UTC of step 0; replaces lead_h
  std::uint64_t seed{1};

  std::vector<SeaLayerRequest> sea;  ///< at the time of the start, or at the first time of the file
  double sea_depth_m{0.0};
  std::string value;     ///< expression over the layers for the value of each device; empty: random
  std::string sea_risk;  ///< expression over the layers for the risk of each cell; empty if unused

  std::string notices;  ///< file of warnings or anchorage forecasts; those in force are listed
};

}  // namespace aquafarm
