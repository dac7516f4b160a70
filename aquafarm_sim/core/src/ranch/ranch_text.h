// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The text of a ranch's file, once everything is decided.

#include <cstdio>
#include <string>
#include <vector>

#include "aquafarm/charts/chart.h"
#include "aquafarm/ranch/ranch_request.h"
#include "aquafarm/sea/expression.h"
#include "aquafarm/sea/sea_field.h"
#include "aquafarm/storms/to_disaster.h"

namespace aquafarm::internal {

/// What goes into the file, collected part by part.
struct RanchPlan {
  std::int32_t width{};
  std::int32_t height{};
  double cell_size_m{};
  std::optional<GeoPoint> origin;
  double step_s{};
  std::int64_t start{};  ///< UTC of step 0, where there is a storm or one was asked for
  std::int32_t step_limit{};
  Terrain terrain;
  std::vector<Cell> ports;  ///< empty: drawn
  StormRings storm;         ///< without waypoints: calm
  std::string storm_text;   ///< what it is, for people
  StormKnowledge knowledge;
  std::int32_t storm_steps{};
  std::vector<StormForecast> forecasts;  ///< of the storm, in order of issue
  std::vector<DisasterSpec> presets;
  std::vector<NamedLayer> layers;
  std::vector<std::string> sea_units;  ///< by layer
  bool waterways{};
};

/// @param decided lines for people, which go into comments
std::string WriteRanch(const RanchRequest& request, const RanchPlan& plan,
                       const std::vector<std::string>& decided);

/// The line of the file that leaves the devices to be drawn.
std::string DevicesLine(const RanchRequest& request);

template <typename... Args>
std::string Text(const char* format, Args... args) {
  char text[400];
  std::snprintf(text, sizeof(text), format, args...);
  return text;
}

/// The last part of a path.
std::string FileName(const std::string& path);
/// What a file says of itself, on one line.
std::string OneLine(std::string text);
/// A number as a file should show it: of so many digits, no more.
std::string Short(double value, int digits);
/// "[2, 3]"
std::string CellText(Cell cell);

}  // namespace aquafarm::internal
