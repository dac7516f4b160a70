// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Writes the scenario file of a ranch from a RanchPlan.

#include <cstdio>
#include <string>
#include <vector>

#include "aquafarm/charts/chart.h"
#include "aquafarm/ranch/ranch_request.h"
#include "aquafarm/sea/expression.h"
#include "aquafarm/sea/sea_field.h"
#include "aquafarm/storms/to_disaster.h"

namespace aquafarm::internal {

/// The parts of the scenario file that do not follow from the request alone.
struct RanchPlan {
  std::int32_t width{};
  std::int32_t height{};
  double cell_size_m{};
  std::optional<GeoPoint> origin;
  double step_s{};
  std::int64_t start{};  ///< UTC of step 0; 0 if neither a track nor a start is given
  std::int32_t step_limit{};
  Terrain terrain;
  std::vector<Cell> ports;        ///< empty: drawn at random
  std::vector<DeviceSite> sites;  ///< empty: drawn at random
  StormRings storm;               ///< no waypoints: no storm from a track
  std::string storm_text;         ///< name and source of the storm
  StormKnowledge knowledge;
  std::int32_t storm_steps{};
  std::vector<StormForecast> forecasts;  ///< forecasts of the storm, sorted by time of issue
  std::vector<DisasterSpec> presets;
  /// Tracks of the archive's storms in reach, in the format of tracks/archive.h. Empty until the
  /// storms are selected. While it is empty, the scenario file lists the files of the archive.
  std::string archive;
  std::int32_t archive_steps{};  ///< duration of an archive storm [steps]; 0: no archive
  std::vector<NamedLayer> layers;
  std::vector<std::string> sea_units;  ///< one for each layer
  bool routes{};                       ///< view.routes of the scenario
};

/// Returns the text of the scenario file.
/// @param decided written as YAML comments, one line each
std::string WriteRanch(const RanchRequest& request, const RanchPlan& plan,
                       const std::vector<std::string>& decided);

/// Formats as printf does. The result has at most 399 bytes; a longer one is cut.
template <typename... Args>
std::string Text(const char* format, Args... args) {
  char text[400];
  std::snprintf(text, sizeof(text), format, args...);
  return text;
}

/// Returns the last part of a path.
std::string FileName(const std::string& path);
/// Replaces control characters, such as line breaks, with '?'.
std::string OneLine(std::string text);
/// Formats a number with at most `digits` decimals.
std::string Short(double value, int digits);

}  // namespace aquafarm::internal
