// SPDX-License-Identifier: BSD-3-Clause
#include "farm/farm_records.h"

#include <cmath>
#include <memory>

namespace aquafarm::internal {
namespace {

// Reads the rings by quadrant and the rings of the last bulletin.
void ReadRings(Reader& a, SavedDisaster& d) {
  d.by_quadrant = a.state.contains("quadrants");
  if (d.by_quadrant) {
    decltype(d.quadrant) sides{};
    a.Field("quadrants", sides);
    for (std::size_t k = 0; k < static_cast<std::size_t>(d.rings); ++k) {
      SetRing(d, k, {sides[0][k], sides[1][k], sides[2][k], sides[3][k]});
    }
  }
  CopyRings(d, d.bulletin);
  if (a.state.contains("bulletin_rings")) {
    a.Fields("bulletin_rings", d.bulletin.radius, d.bulletin.quadrant);
  } else if (RingsMayHaveChanged(d, d.bulletin)) {
    throw InputError(
        "state: disaster: bulletin_rings: missing, expected the rings of the last bulletin; "
        "states saved by older versions lack them: use another saved state");
  }
}

// Rejects values from forged bytes that would cause access out of bounds or endless loops.
void CheckDisaster(const SavedDisaster& d) {
  const auto is_heading = [](std::int32_t degrees) { return degrees >= 0 && degrees <= 359; };
  if (!is_heading(d.heading_deg) || !is_heading(d.bulletin.heading_deg)) {
    throw InputError("state: a heading is not in [0, 359]; use another saved state");
  }
  bool finite = true;
  const auto check = [&finite](const auto& values) {
    for (const float value : values) finite = finite && std::isfinite(value);
  };
  check(std::array<float, 10>{d.x, d.y, d.dx, d.dy, d.speed, d.radius_growth, d.margin,
                              d.bulletin.x, d.bulletin.y, d.bulletin.speed});
  for (const auto& values : {d.radius, d.radius_squared, d.risk, d.bulletin.radius}) check(values);
  for (const auto& side : d.bulletin.quadrant) check(side);
  for (const auto& side : d.quadrant) check(side);
  if (!finite)
    throw InputError("state: a number of a disaster is not finite; use another saved state");
}

}  // namespace

SavedDisaster DisasterFrom(const json& j) {
  SavedDisaster d;
  Reader reader(j);
  FieldsOf<SavedDisaster>::Visit(reader, d);
  if (d.rings < 0 || d.rings > kMaxRings) {
    throw InputError("state: rings of a disaster: got " + std::to_string(d.rings) +
                     ", expected [0, " + std::to_string(kMaxRings) + "]; use another saved state");
  }
  ReadRings(reader, d);
  CheckDisaster(d);
  return d;
}

json TrackToJson(const std::vector<Waypoint>& track) {
  json points = json::array();
  for (const Waypoint& point : track) {
    points.push_back({point.step, point.x, point.y, point.grade, point.radii, point.risks});
    if (!point.quadrants.empty()) points.back().push_back(point.quadrants);
  }
  return points;
}

std::vector<Waypoint> TrackFromJson(const json& points) {
  std::vector<Waypoint> track;
  for (const json& point : points) {
    track.push_back({point.at(0).get<float>(), point.at(1).get<float>(), point.at(2).get<float>(),
                     point.at(3).get<std::int32_t>(), point.at(4).get<std::vector<float>>(),
                     point.at(5).get<std::vector<float>>(),
                     point.size() > 6 ? point.at(6).get<std::vector<QuadrantRadii>>()
                                      : std::vector<QuadrantRadii>()});
  }
  return track;
}

json ForecastsToJson(const Forecasts& forecasts) {
  json list = json::array();
  if (forecasts == nullptr) return list;
  for (const IssuedForecast& forecast : *forecasts) {
    list.push_back({forecast.step, TrackToJson(forecast.points)});
  }
  return list;
}

Forecasts ForecastsFromJson(const json& list) {
  if (list.empty()) return nullptr;
  std::vector<IssuedForecast> forecasts;
  for (const json& forecast : list) {
    forecasts.push_back({forecast.at(0).get<float>(), TrackFromJson(forecast.at(1))});
  }
  return std::make_shared<const std::vector<IssuedForecast>>(std::move(forecasts));
}

}  // namespace aquafarm::internal
