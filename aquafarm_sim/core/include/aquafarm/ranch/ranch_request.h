// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "aquafarm/scenario/scenario.h"
#include "aquafarm/storms/to_disaster.h"

namespace aquafarm {

/// A field of the sea that becomes a layer of the scenario's `seas`. Expressions may use it.
struct SeaLayerRequest {
  std::string name;      ///< name in expressions
  std::string file;      ///< netCDF file
  std::string variable;  ///< name or standard_name of the variable in the file
};

/// Recorded storms. Every episode draws one of them.
struct ArchiveRequest {
  std::vector<std::string> files;   ///< files of tracks; if empty, no archive is used
  Range<std::int32_t> years{0, 0};  ///< years of the storms for training
  /// Years of the storms for evaluation; if unset, all years after years.max.
  std::optional<Range<std::int32_t>> evaluation_years;
  double within_km{300.0};  ///< max distance of the closest approach to the ranch's middle
};

/// Inputs of BuildRanch. BuildRanch chooses values for unset fields. BuiltRanch::decided lists
/// these choices.
struct RanchRequest {
  std::string name{"my_ranch"};
  std::string chart;  ///< GeoJSON, map_server YAML or ASCII grid; empty for open sea
  /// Middle of the ranch. Required with a track, an archive, port_places, sea fields, or a chart in
  /// degrees.
  std::optional<GeoPoint> center;
  std::int32_t width{25};   ///< [cells]; a chart in metres replaces width, height and cell_size_m
  std::int32_t height{25};  ///< [cells]
  double cell_size_m{200.0};
  float sea_level{0.0F};  ///< heights of an ASCII grid above this are land

  std::string track;  ///< file with the storm; empty if unused
  std::string storm;  ///< name or id of the storm; may be empty if the file has only one
  std::string radii;  ///< file with radii for fixes without radii; empty if unused
  RingReduction reduction{RingReduction::kEqualArea};
  /// File of bulletins with forecast points. Agents receive these forecasts; the storm itself
  /// follows the track. If the track contains no forecast, the newest of these forecasts continues
  /// it, unless the track is a best track of the CMA or JMA. If no file is given, agents receive
  /// the present motion of the storm.
  std::string forecasts;

  ArchiveRequest archive;  ///< alternative to `track`; a request with both is an error

  std::vector<std::string> disasters;  ///< other disasters, in the format of storms/presets.h

  std::int32_t ports{4};
  std::vector<GeoPoint>
      port_places;     ///< each is moved to the nearest water next to land; replaces `ports`
  bool exact_ports{};  ///< whether places of `port_places` on land or off the map are errors
  std::int32_t devices{4};
  DevicePlacement placement{DevicePlacement::kRandom};
  std::int32_t ships{1};
  /// Speed of a ship that tows a device. The speed determines the duration of a step, because a
  /// ship moves one cell per step.
  double speed_kn{4.0};
  std::optional<double> step_s;  ///< duration of a step [s]; replaces speed_kn
  /// Hours from the start until the widest ring reaches the ranch. If no ring reaches the ranch,
  /// the start is 12 hours before the storm is nearest. The start is rounded down to a full hour
  /// and is not before the first position of the storm.
  double lead_h{3.0};
  std::optional<std::int64_t> start;  ///< UTC of step 0 [s since 1970]; replaces lead_h
  std::uint64_t seed{1};              ///< seed of the layout

  /// Fields of the sea. The time nearest to the start is read; without a start, the first time of
  /// the file.
  std::vector<SeaLayerRequest> sea;
  double sea_depth_m{0.0};  ///< depth of the fields below the surface
  std::string value;     ///< expression over the layers for the value of each device; empty: random
  std::string sea_risk;  ///< expression over the layers for the risk of each cell; empty if unused

  /// File of warnings or anchorage forecasts. BuiltRanch::decided lists the notices in force during
  /// the episode, or all notices if the episode has no date.
  std::string notices;
};

}  // namespace aquafarm
