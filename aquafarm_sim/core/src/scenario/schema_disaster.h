// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The keys of a disaster, of its track and forecasts, and of storms from an archive; part of
/// schema.h.

#include <algorithm>
#include <tuple>

#include "aquafarm/grid/geo_frame.h"
#include "scenario/domains.h"
#include "scenario/ranges.h"
#include "scenario/schema_kinds.h"

namespace aquafarm::internal {

/// A waypoint as published by an authority. Resolve converts it to a Waypoint in grid units.
struct GeoFix {
  std::int64_t time{};  ///< UTC [s since 1970]
  GeoPoint point;
  std::vector<float> radii_km;
  std::vector<QuadrantRadii> quadrants_km;  ///< replaces radii_km if not empty
  std::optional<float> pressure_hpa;        ///< has no effect
};

/// Parameters that convert a GeoFix to a Waypoint. Only files contain positions in degrees, so
/// functions accept nullptr instead of a frame if no file is read.
struct WorldFrame {
  std::optional<GeoFrame> grid;
  std::optional<std::int64_t> start_time;
  double step_duration_s{};
  double cell_size_m{};
  std::string folder;  ///< folder of the scenario file; other file names are relative to it
  double x{};          ///< middle of the farm [cells]
  double y{};
};

/// Converts a UTC time [s since 1970] to steps. @throws FieldError if the scenario has no
/// time.start
float ToStep(std::int64_t time, const WorldFrame* frame, const std::string& path);
/// Converts a GeoFix to step, position and rings of a Waypoint.
/// @throws FieldError if the scenario has no grid.origin or time.start, or if the fix is more than
///   about 60 degrees from the origin
void Resolve(const GeoFix& fix, const WorldFrame* frame, const std::string& path,
             Waypoint& waypoint);

template <typename Archive, typename Point>
void VisitGeoPoint(Archive& a, Point& point) {
  a.Field("latitude", point.latitude, Interval<double>{-90.0, 90.0}, Need::kRequired);
  a.Field("longitude", point.longitude, Interval<double>{-180.0, 180.0}, Need::kRequired);
}

/// Reads recorded storms. Stores in disaster.storms the storms of the requested years that have
/// gales and whose distance from the middle of the farm falls to within_km or less. Also sets the
/// track of the disaster to that of the first storm for training.
/// @param files files of tracks; if empty, storms.tracks contains the text of an archive
/// @throws FieldError if a file is unreadable, grid.origin is missing, times or years contradict
///   each other, or the years for training or the years for evaluation have no such storm
void Resolve(const std::vector<std::string>& files, const WorldFrame* frame,
             const std::string& path, DisasterSpec& disaster);

/// Returns the largest radius of each ring.
inline std::vector<float> Largest(const std::vector<QuadrantRadii>& quadrants) {
  std::vector<float> radii;
  radii.reserve(quadrants.size());
  for (const QuadrantRadii& ring : quadrants) {
    radii.push_back(*std::max_element(ring.begin(), ring.end()));
  }
  return radii;
}

inline constexpr Interval<float> kWind_mps{0.0F, 150.0F};

template <typename Archive, typename W>
void VisitWaypoint(Archive& a, W& waypoint, const WorldFrame* frame, const GradeRisks& by_grade) {
  const ListOf<Interval<float>> radii{kRadius, 1, kMaxRings};
  const bool real = a.Has("time", false);
  const ListOf<Interval<float>> quadrants{kRadius, 0, kMaxRings};
  const bool by_quadrant = a.Has("quadrants", !waypoint.quadrants.empty());
  a.When(!real, "'time' is not set");
  a.Field("step", waypoint.step, kStep, Need::kRequired);
  a.Field("x", waypoint.x, kPlace, Need::kRequired);
  a.Field("y", waypoint.y, kPlace, Need::kRequired);
  a.When(!real && !by_quadrant, real ? "'time' is not set" : "'quadrants' is not set");
  a.Field("radii", waypoint.radii, radii, Need::kRequired);
  a.When(!real && by_quadrant, real ? "'time' is not set" : "'quadrants' is set");
  a.Field("quadrants", waypoint.quadrants, quadrants);
  if constexpr (Archive::kReads) {
    if (by_quadrant) waypoint.radii = Largest(waypoint.quadrants);
    GeoFix fix;
    const bool by_quadrant_km = a.Has("quadrants_km", false);
    a.When(real, "'time' is set");
    a.Field("time", fix.time, UtcTime{}, Need::kRequired);
    VisitGeoPoint(a, fix.point);
    a.When(real && !by_quadrant_km, real ? "'quadrants_km' is not set" : "'time' is set");
    a.Field("radii_km", fix.radii_km, radii, Need::kRequired);
    a.When(real, "'time' is set");
    a.Field("quadrants_km", fix.quadrants_km, quadrants);
    a.Field("pressure_hpa", fix.pressure_hpa, Interval<float>{800.0F, 1100.0F});
    if (real) Resolve(fix, frame, a.path(), waypoint);
  }
  a.Always();
  a.Field("wind_mps", waypoint.wind_mps, kWind_mps);
  a.Field("grade", waypoint.grade, kGrade, Need::kRequired);
  if constexpr (Archive::kReads) {
    if (!by_grade.empty()) waypoint.risks = by_grade[static_cast<std::size_t>(waypoint.grade - 1)];
  }
  a.Field("risks", waypoint.risks, ListOf<Interval<float>>{kRisk, 1, kMaxRings});
}

/// Visits a point with rings as a waypoint, and a point without rings as a time, a position and a
/// wind.
template <typename Archive, typename P>
void VisitForecastPoint(Archive& a, P& point, const WorldFrame* frame, const GradeRisks& by_grade) {
  bool ringed = a.Has("radii", !point.radii.empty());
  for (const char* key : {"quadrants", "radii_km", "quadrants_km"}) {
    ringed = ringed || a.Has(key, false);
  }
  if (ringed) return VisitWaypoint(a, point, frame, by_grade);
  if constexpr (Archive::kReads) point.risks.clear();
  const bool real = a.Has("time", false);
  a.When(!real, "'time' is not set");
  a.Field("step", point.step, kStep, Need::kRequired);
  a.Field("x", point.x, kPlace, Need::kRequired);
  a.Field("y", point.y, kPlace, Need::kRequired);
  if constexpr (Archive::kReads) {
    GeoFix fix;
    a.When(real, "'time' is set");
    a.Field("time", fix.time, UtcTime{}, Need::kRequired);
    VisitGeoPoint(a, fix.point);
    Waypoint there;
    if (real) Resolve(fix, frame, a.path(), there);
    if (real) std::tie(point.step, point.x, point.y) = std::tie(there.step, there.x, there.y);
  }
  a.Always();
  a.Field("wind_mps", point.wind_mps, kWind_mps);
}

template <typename Archive, typename F>
void VisitForecast(Archive& a, F& forecast, const WorldFrame* frame, const DisasterSpec& of) {
  const bool real = a.Has("time", false);
  a.When(!real, "'time' is not set");
  a.Field("step", forecast.step, kStep, Need::kRequired);
  if constexpr (Archive::kReads) {
    std::int64_t time{};
    a.When(real, "'time' is set");
    a.Field("time", time, UtcTime{}, Need::kRequired);
    if (real) forecast.step = ToStep(time, frame, a.path());
  }
  a.Always();
  const GradeRisks by_grade = Archive::kReads ? RisksByGrade(of) : GradeRisks{};
  a.Structs("points", forecast.points, {1, kMaxWaypoints}, [&](auto& b, auto& point) {
    if constexpr (Archive::kReads) point.risks = of.risks;
    VisitForecastPoint(b, point, frame, by_grade);
  });
}

/// Sets the state of a tracked disaster to that of its first waypoint.
inline void SetFirst(DisasterSpec& disaster) {
  const Waypoint& first = disaster.track.front();
  if (!disaster.grade_risks.empty()) disaster.risks = first.risks;
  disaster.grade = first.grade;
  disaster.radii = first.radii;
  disaster.quadrants = first.quadrants;
}

template <typename Archive, typename S>
void VisitStorms(Archive& a, S& storms, std::vector<std::string>& files) {
  constexpr Interval<std::int32_t> kYear{kFirstYear, kLastYear};
  constexpr Interval<double> kHours{0.0, 240.0};
  constexpr Interval<double> kKm{0.0, 2000.0};
  constexpr Interval<double> kFactor{0.0, 1.0};
  a.Field("years", storms.years, kYear, Need::kRequired);
  a.Field("evaluation_years", storms.evaluation_years, kYear, Need::kRequired);
  a.Field("within_km", storms.within_km, kKm);
  a.Field("approach_h", storms.approach_h, kHours);
  a.Struct("perturbation", [&](auto& b) {
    b.Field("along_km", storms.perturbation.along_km, kKm);
    b.Field("across_km", storms.perturbation.across_km, kKm);
    b.Field("start_h", storms.perturbation.start_h, kHours);
    b.Field("intensity", storms.perturbation.intensity, kFactor);
    b.Field("size", storms.perturbation.size, kFactor);
  });
  if constexpr (Archive::kReads) {
    const bool from_files = a.Has("archive", false);
    a.Field("archive", files, ListOf<TextOf>{{1, 1000}, 1, 100});
    a.When(!from_files, "'archive' is not set");
  }
  a.Field("tracks", storms.tracks, LinesOf{{0, kMaxArchiveBytes}}, Need::kRequired);
  a.Always();
}

/// Visits the recorded storms of a disaster. In each episode the disaster follows one of them.
template <typename Archive, typename D>
void VisitDrawnStorms(Archive& a, D& disaster, const WorldFrame* frame) {
  if constexpr (Archive::kReads) {
    if (a.Has("track", false)) {
      throw FieldError(Join(a.path(), "track"), "is used only if 'storms' is not set");
    }
  }
  std::vector<std::string> files;
  a.Optional("storms", disaster.storms,
             [&files](auto& b, auto& storms) { VisitStorms(b, storms, files); });
  if constexpr (Archive::kReads) {
    Resolve(files, frame, Join(a.path(), "storms"), disaster);
    SetFirst(disaster);
  }
}

template <typename Archive, typename D>
void VisitDisaster(Archive& a, D& disaster, const WorldFrame* frame) {
  const bool drawn = a.Has("storms", disaster.storms.has_value());
  const bool tracked = drawn || a.Has("track", !disaster.track.empty());
  const ListOf<Interval<float>> risks{kRisk, 1, kMaxRings};
  const bool graded = a.Has("grade_risks", !disaster.grade_risks.empty());
  const bool by_quadrant = a.Has("quadrants", !disaster.quadrants.empty());
  a.Field("kind", disaster.kind, OneOfNames{}, Need::kRequired);
  a.When(Archive::kReads || !disaster.name.empty(), "");
  a.Field("name", disaster.name, TextOf{0, 100});
  a.When(!graded, "'grade_risks' is not set");
  a.Field("risks", disaster.risks, risks);
  a.When(tracked && graded, "'track' or 'storms' is set");
  a.Field("grade_risks", disaster.grade_risks,
          ListOf<ListOf<Interval<float>>>{risks, graded ? 4U : 0U, 4});
  VisitGradeFactors(a, disaster, !graded && !drawn,
                    graded ? "'grade_risks' is not set" : "'storms' is not set");
  a.When(Archive::kReads || !disaster.ring_winds_kt.empty(), "");
  a.Field("ring_winds_kt", disaster.ring_winds_kt,
          ListOf<Interval<std::int32_t>>{{1, 200}, 0, kMaxRings});
  a.Always();
  a.Field("duration", disaster.duration, Interval<std::int32_t>{1, kMaxSteps});
  const char* unset = drawn ? "'storms' is not set" : "'track' is not set";
  a.When(!tracked, unset);
  a.Field("grade", disaster.grade, kGrade);
  a.When(!tracked && !by_quadrant, tracked ? unset : "'quadrants' is not set");
  a.Field("radii", disaster.radii, ListOf<Interval<float>>{kRadius, 1, kMaxRings});
  a.When(!tracked && by_quadrant, tracked ? unset : "'quadrants' is set");
  a.Field("quadrants", disaster.quadrants, ListOf<Interval<float>>{kRadius, 0, kMaxRings});
  if constexpr (Archive::kReads) {
    if (by_quadrant) disaster.radii = Largest(disaster.quadrants);
  }
  a.When(!tracked, unset);
  a.Field("speed", disaster.speed, Interval<float>{0.0F, 1000.0F});
  a.Field("heading_deg", disaster.heading_deg, Interval<std::int32_t>{0, 359});
  a.Field("turn_probability", disaster.turn_probability, kShare);
  a.Field("radius_growth", disaster.radius_growth, Interval<float>{-100.0F, 100.0F});
  a.Field("border", disaster.border, OneOfNames{});
  a.Field("start", disaster.start, kPlace);
  a.When(Archive::kReads ? tracked && !drawn : !disaster.forecasts.empty(), "'track' is set");
  a.Structs("forecasts", disaster.forecasts, {0, kMaxWaypoints},
            [&](auto& b, auto& forecast) { VisitForecast(b, forecast, frame, disaster); });
  a.Always();
  if (!tracked) return;
  if (drawn) {
    VisitDrawnStorms(a, disaster, frame);
    return;
  }
  const GradeRisks by_grade = Archive::kReads ? RisksByGrade(disaster) : GradeRisks{};
  a.Structs("track", disaster.track, {1, kMaxWaypoints}, [&](auto& b, auto& waypoint) {
    if constexpr (Archive::kReads) waypoint.risks = disaster.risks;
    VisitWaypoint(b, waypoint, frame, by_grade);
  });
  if constexpr (Archive::kReads) {  // a tracked disaster starts in the state of its first waypoint
    SetFirst(disaster);
  }
}

}  // namespace aquafarm::internal
