// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// All keys of a scenario and their domains, declared once. An archive visits them:
///
///   YamlReader    fills the structs from a file and rejects unknown keys
///   YamlWriter    writes the structs and omits unused keys
///   FieldChecker  checks structs created in code or received in messages
///
/// Archives provide Field, Struct, Optional, Structs, Has (key is given), When and Always (in use).

#include <algorithm>
#include <tuple>

#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/scenario/limits.h"
#include "scenario/domains.h"
#include "scenario/schema_family.h"
#include "scenario/schema_kinds.h"

namespace aquafarm::internal {

enum class Need : std::uint8_t { kOptional, kRequired };

inline constexpr std::size_t kMaxListed = 100000;     ///< islands or rocks; no real farm has more
inline constexpr std::size_t kMaxSeaValues = 200000;  ///< limits a file to a few MB
inline constexpr std::size_t kMaxLayers = 16;
inline constexpr std::size_t kMaxWaypoints = 10000;
inline constexpr std::size_t kMaxLeads = 8;
inline constexpr std::size_t kMaxArchiveBytes = 2U << 20U;
inline constexpr std::int32_t kMaxDevices = 1000;
inline constexpr std::int32_t kMaxPorts = 256;
inline constexpr std::int32_t kMaxSteps = 10000000;  // below 2^24, so exact as a float
inline constexpr float kFar = 1.0e6F;                // [cells]

inline constexpr Interval<float> kShare{0.0F, 1.0F};
inline constexpr Interval<float> kRadius{0.0F, kFar};
inline constexpr Interval<float> kPlace{-kFar, kFar};
inline constexpr Interval<float> kStep{-static_cast<float>(kMaxSteps), kMaxSteps};
inline constexpr Interval<float> kRisk{kWorstRisk, kMildestRisk};
inline constexpr Interval<float> kPenalty{-1000.0F, 0.0F};
inline constexpr Interval<float> kReward{-10000.0F, 10000.0F};
inline constexpr Interval<float> kDeviceValue{0.0F, 10000.0F};
inline constexpr Interval<double> kAmount{0.0, 1.0e9};  // so that sums of cents are exact
inline constexpr Interval<std::int32_t> kGrade{1, 4};
inline constexpr Interval<std::int32_t> kAlong{0, kMaxSide - 1};
inline constexpr Interval<std::int32_t> kSide{1, kMaxSide};

/// A waypoint as published by an authority; converted to a Waypoint in grid units.
struct GeoFix {
  std::int64_t time{};  ///< UTC [s since 1970]
  GeoPoint point;
  std::vector<float> radii_km;
  std::vector<QuadrantRadii> quadrants_km;  ///< instead of radii_km
  std::optional<float> pressure_hpa;        ///< informative only; has no effect
  std::optional<float> wind_mps;            ///< informative only; has no effect
};

/// Parameters that convert a GeoFix to a Waypoint. Pointers to it are null if no file is read,
/// because there is then no GeoFix.
struct WorldFrame {
  std::optional<GeoFrame> grid;
  std::optional<std::int64_t> start_time;
  double step_duration_s{};
  double cell_size_m{};
  std::string folder;  ///< folder of the scenario file; other file names are relative to it
  double x{};          ///< middle of the farm [cells]
  double y{};
};

/// Converts a UTC time to steps. @throws FieldError when the scenario has no start
float ToStep(std::int64_t time, const WorldFrame* frame, const std::string& path);
/// Converts a GeoFix to a Waypoint. @throws FieldError when the scenario has no origin or start
void Resolve(const GeoFix& fix, const WorldFrame* frame, const std::string& path,
             Waypoint& waypoint);

template <typename Archive, typename Point>
void VisitGeoPoint(Archive& a, Point& point) {
  a.Field("latitude", point.latitude, Interval<double>{-90.0, 90.0}, Need::kRequired);
  a.Field("longitude", point.longitude, Interval<double>{-180.0, 180.0}, Need::kRequired);
}

/// Reference to a field of a netCDF file; converted to the values of a SeaLayer.
struct SeaSource {
  std::string file;
  std::string variable;
  double depth_m{};
  std::optional<std::int64_t> time;  ///< UTC; if unset, the start of the episode or else the first
                                     ///< time of the file
};

/// Reads a field and interpolates it at the cells of a farm.
/// @throws FieldError when the scenario has no origin, or the file has no such field there
void Resolve(const SeaSource& source, const WorldFrame& frame, const std::string& path,
             std::int32_t width, std::int32_t height, SeaLayer& layer);
/// Evaluates an expression of the sea's layers at every cell.
/// @throws FieldError if `rule` is not a valid expression
std::vector<float> ByRule(const std::string& rule, const std::vector<SeaLayer>& layers,
                          const std::string& path);
/// Checks one value per cell. @throws FieldError for a value that is not 0, NaN or in `range`
void CheckPerCell(const std::string& path, const std::vector<float>& values, std::int32_t width,
                  Interval<float> range);

/// Reads archives of storms and keeps those in reach of the farm.
/// @param files empty if storms.tracks holds the text of an archive
/// @throws FieldError for an unreadable file, or if no storm of the years comes in reach
void Resolve(const std::vector<std::string>& files, const WorldFrame* frame,
             const std::string& path, DisasterSpec& disaster);

/// Returns the largest radius of each ring.
inline std::vector<float> Largest(const std::vector<QuadrantRadii>& quadrants) {
  std::vector<float> radii;
  for (const QuadrantRadii& ring : quadrants) {
    radii.push_back(*std::max_element(ring.begin(), ring.end()));
  }
  return radii;
}

template <typename Archive, typename W>
void VisitWaypoint(Archive& a, W& waypoint, const WorldFrame* frame, const GradeRisks& by_grade) {
  const ListOf<Interval<float>> radii{kRadius, 1, kMaxRings};
  const bool real = a.Has("time", false);
  const ListOf<Interval<float>> quadrants{kRadius, 0, kMaxRings};
  const bool by_quadrant = a.Has("quadrants", !waypoint.quadrants.empty());
  a.When(!real, "there is no time");
  a.Field("step", waypoint.step, kStep, Need::kRequired);
  a.Field("x", waypoint.x, kPlace, Need::kRequired);
  a.Field("y", waypoint.y, kPlace, Need::kRequired);
  a.When(!real && !by_quadrant, real ? "there is no time" : "there are no quadrants");
  a.Field("radii", waypoint.radii, radii, Need::kRequired);
  a.When(!real && by_quadrant, real ? "there is no time" : "there are quadrants");
  a.Field("quadrants", waypoint.quadrants, quadrants);
  if constexpr (Archive::kReads) {
    if (by_quadrant) waypoint.radii = Largest(waypoint.quadrants);
    GeoFix fix;
    const bool by_quadrant_km = a.Has("quadrants_km", false);
    a.When(real, "there is a time");
    a.Field("time", fix.time, UtcTime{}, Need::kRequired);
    VisitGeoPoint(a, fix.point);
    a.When(real && !by_quadrant_km, real ? "there are no quadrants_km" : "there is a time");
    a.Field("radii_km", fix.radii_km, radii, Need::kRequired);
    a.When(real, "there is a time");
    a.Field("quadrants_km", fix.quadrants_km, quadrants);
    a.Field("pressure_hpa", fix.pressure_hpa, Interval<float>{800.0F, 1100.0F});
    a.Field("wind_mps", fix.wind_mps, Interval<float>{0.0F, 150.0F});
    if (real) Resolve(fix, frame, a.path(), waypoint);
  }
  a.Always();
  a.Field("grade", waypoint.grade, kGrade, Need::kRequired);
  if constexpr (Archive::kReads) {
    if (!by_grade.empty()) waypoint.risks = by_grade[static_cast<std::size_t>(waypoint.grade - 1)];
  }
  a.Field("risks", waypoint.risks, ListOf<Interval<float>>{kRisk, 1, kMaxRings});
}

/// Visits a point with rings as a waypoint, and a point without rings as a place and a time.
template <typename Archive, typename P>
void VisitForecastPoint(Archive& a, P& point, const WorldFrame* frame, const GradeRisks& by_grade) {
  bool ringed = a.Has("radii", !point.radii.empty());
  for (const char* key : {"quadrants", "radii_km", "quadrants_km"}) {
    ringed = ringed || a.Has(key, false);
  }
  if (ringed) return VisitWaypoint(a, point, frame, by_grade);
  if constexpr (Archive::kReads) point.risks.clear();
  const bool real = a.Has("time", false);
  a.When(!real, "there is no time");
  a.Field("step", point.step, kStep, Need::kRequired);
  a.Field("x", point.x, kPlace, Need::kRequired);
  a.Field("y", point.y, kPlace, Need::kRequired);
  if constexpr (Archive::kReads) {
    GeoFix fix;
    a.When(real, "there is a time");
    a.Field("time", fix.time, UtcTime{}, Need::kRequired);
    VisitGeoPoint(a, fix.point);
    Waypoint there;
    if (real) Resolve(fix, frame, a.path(), there);
    if (real) std::tie(point.step, point.x, point.y) = std::tie(there.step, there.x, there.y);
  }
  a.Always();
}

template <typename Archive, typename F>
void VisitForecast(Archive& a, F& forecast, const WorldFrame* frame, const DisasterSpec& of) {
  const bool real = a.Has("time", false);
  a.When(!real, "there is no time");
  a.Field("step", forecast.step, kStep, Need::kRequired);
  if constexpr (Archive::kReads) {
    std::int64_t time{};
    a.When(real, "there is a time");
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
    a.When(!from_files, "there is no archive");
  }
  a.Field("tracks", storms.tracks, LinesOf{{0, kMaxArchiveBytes}}, Need::kRequired);
  a.Always();
}

template <typename Archive, typename D>
void VisitDisaster(Archive& a, D& disaster, const WorldFrame* frame) {
  const bool drawn = a.Has("storms", disaster.storms.has_value());
  const bool tracked = drawn || a.Has("track", !disaster.track.empty());
  const ListOf<Interval<float>> risks{kRisk, 1, kMaxRings};
  const bool graded = a.Has("grade_risks", !disaster.grade_risks.empty());
  const bool by_quadrant = a.Has("quadrants", !disaster.quadrants.empty());
  a.Field("kind", disaster.kind, OneOfNames{}, Need::kRequired);
  a.When(!graded, "there are no grade_risks");
  a.Field("risks", disaster.risks, risks);
  a.When(tracked && graded, "there is a track or storms");
  a.Field("grade_risks", disaster.grade_risks,
          ListOf<ListOf<Interval<float>>>{risks, graded ? 4U : 0U, 4});
  VisitGradeFactors(a, disaster, !graded && !drawn,
                    graded ? "there are no grade_risks" : "there are no storms");
  a.Field("duration", disaster.duration, Interval<std::int32_t>{1, kMaxSteps});
  a.When(!tracked, "there is no track");
  a.Field("grade", disaster.grade, kGrade);
  a.When(!tracked && !by_quadrant, tracked ? "there is no track" : "there are no quadrants");
  a.Field("radii", disaster.radii, ListOf<Interval<float>>{kRadius, 1, kMaxRings});
  a.When(!tracked && by_quadrant, tracked ? "there is no track" : "there are quadrants");
  a.Field("quadrants", disaster.quadrants, ListOf<Interval<float>>{kRadius, 0, kMaxRings});
  if constexpr (Archive::kReads) {
    if (by_quadrant) disaster.radii = Largest(disaster.quadrants);
  }
  a.When(!tracked, "there is no track");
  a.Field("speed", disaster.speed, Interval<float>{0.0F, 1000.0F});
  a.Field("heading_deg", disaster.heading_deg, Interval<std::int32_t>{0, 359});
  a.Field("turn_probability", disaster.turn_probability, kShare);
  a.Field("radius_growth", disaster.radius_growth, Interval<float>{-100.0F, 100.0F});
  a.Field("border", disaster.border, OneOfNames{});
  a.Field("start", disaster.start, kPlace);
  a.When(Archive::kReads ? tracked && !drawn : !disaster.forecasts.empty(), "there is a track");
  a.Structs("forecasts", disaster.forecasts, {0, kMaxWaypoints},
            [&](auto& b, auto& forecast) { VisitForecast(b, forecast, frame, disaster); });
  a.Always();
  if (!tracked) return;
  if (drawn) {
    if constexpr (Archive::kReads) {
      if (a.Has("track", false)) {
        throw FieldError(Join(a.path(), "track"), "is used only where there are no storms");
      }
    }
    std::vector<std::string> files;
    a.Optional("storms", disaster.storms,
               [&files](auto& b, auto& storms) { VisitStorms(b, storms, files); });
    if constexpr (Archive::kReads) {
      Resolve(files, frame, Join(a.path(), "storms"), disaster);
      SetFirst(disaster);
    }
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

template <typename Archive, typename S>
void VisitIslands(Archive& a, S& s) {
  a.Structs("islands", s.islands, {0, kMaxListed}, [](auto& b, auto& island) {
    b.Field("x", island.south_west.x, kAlong, Need::kRequired);
    b.Field("y", island.south_west.y, kAlong, Need::kRequired);
    b.Field("width", island.width, kSide);
    b.Field("height", island.height, kSide);
  });
}

template <typename Archive, typename S>
void VisitRocksAndPorts(Archive& a, S& s) {
  a.Struct("rocks", [&](auto& b) {
    const bool chosen = b.Has("cells", !s.rocks.cells.empty());
    b.When(!chosen, "there are no cells");
    b.Field("count", s.rocks.count, Interval<std::int32_t>{0, kMaxSide * kMaxSide});
    b.When(chosen, "there are cells");
    b.Field("cells", s.rocks.cells, ListOf<AnyCell>{{}, chosen ? 1U : 0U, kMaxListed});
    b.Always();
    b.Field("reward", s.rocks.reward, kPenalty);
  });
  a.Struct("ports", [&](auto& b) {
    const bool chosen = b.Has("cells", !s.ports.cells.empty());
    b.When(!chosen, "there are no cells");
    b.Field("count", s.ports.count, Interval<std::int32_t>{1, kMaxPorts});
    b.When(chosen, "there are cells");
    b.Field("cells", s.ports.cells, ListOf<AnyCell>{{}, chosen ? 1U : 0U, kMaxPorts});
    b.Always();
  });
}

template <typename Archive, typename S>
void VisitDevices(Archive& a, S& s) {
  a.Struct("devices", [&](auto& b) {
    auto& devices = s.devices;
    b.Field("placement", devices.placement, OneOfNames{});
    const bool chosen = devices.placement == DevicePlacement::kExplicit;
    b.When(!chosen, "placement is not explicit");
    b.Field("count", devices.count, Interval<std::int32_t>{1, kMaxDevices});
    b.Field("kinds", devices.kinds, ListOf<OneOfNames>{{}, 1, kMaxDevices});
    b.Field("self_propelled", devices.self_propelled, Interval<std::int32_t>{0, kMaxDevices});
    b.Always();
    b.Field("value", devices.value, kDeviceValue);
    b.Field("health", devices.health, Interval<float>{0.0F, 1.0F, true});
    b.When(chosen, "placement is explicit");
    b.Structs("sites", devices.sites, {0, kMaxDevices}, [](auto& c, auto& site) {
      c.Field("cell", site.cell, AnyCell{}, Need::kRequired);
      c.Field("kind", site.kind, OneOfNames{}, Need::kRequired);
      c.Field("value", site.value, kDeviceValue);
      c.Field("self_propelled", site.self_propelled, AnyFlag{});
      c.Field("insured_value", site.insured_value, kAmount);
    });
    b.Always();
  });
}

template <typename Archive, typename S>
void VisitRewardsAndDamage(Archive& a, S& s) {
  a.Struct("rewards", [&](auto& b) {
    b.Field("island_crash", s.rewards.island_crash, kPenalty);
    b.Field("pickup", s.rewards.pickup, kReward);
    b.Field("drop_off", s.rewards.drop_off, kReward);
    b.Field("illegal", s.rewards.illegal, kReward);
    b.Field("collision", s.rewards.collision, kReward);
    b.Field("step", s.rewards.step, kReward);
    b.Field("sharing", s.rewards.sharing, OneOfNames{});
  });
  a.Struct("damage", [&](auto& b) {
    b.Field("crash_probability", s.damage.crash_probability, kShare);
    b.Field("island_damage", s.damage.island_damage, kShare);
    b.Field("exposure_damage", s.damage.exposure_damage, kShare);
    VisitDamageKinds(b, s.damage);
  });
}

template <typename Archive, typename F>
void VisitEnergyFigures(Archive& a, F& figures, bool carries) {
  constexpr Interval<double> kEnergy{0.0, 1.0e6};
  constexpr Interval<double> kFactor{0.0, 1000.0};
  a.Field("per_km", figures.per_km, kEnergy);
  if (carries) a.Field("per_device", figures.per_device, kFactor);
  a.Field("rough_sea", figures.rough_sea, kFactor);
  a.Field("idle_per_step", figures.idle_per_step, kEnergy);
}

template <typename Archive, typename S>
void VisitEnergy(Archive& a, S& s) {
  a.Optional("energy", s.energy, [](auto& b, auto& energy) {
    b.Field("weight", energy.weight, Interval<double>{0.0, 1000.0});
    VisitEnergyFigures(b, energy.ships, true);
    b.Struct("self_propelled",
             [&](auto& c) { VisitEnergyFigures(c, energy.self_propelled, false); });
  });
}

template <typename Archive, typename S>
void VisitView(Archive& a, S& s) {
  a.Struct("view", [&](auto& b) {
    b.Field("mode", s.view.mode, OneOfNames{});
    b.When(s.view.mode == ViewMode::kPartial, "mode is partial");
    b.Field("sensor_radius", s.view.sensor_radius, kRadius);
    b.Field("bulletin_period", s.view.bulletin_period, Interval<std::int32_t>{0, kMaxSteps});
    b.Field("bulletin_noise", s.view.bulletin_noise, Interval<float>{0.0F, 1000.0F});
    b.Field("shared_sight", s.view.shared_sight, AnyFlag{});
    b.When(Archive::kReads || !s.view.forecast_error_km.empty(), "");
    b.Field("forecast_error_km", s.view.forecast_error_km,
            ListOf<Interval<float>>{{0.0F, 10000.0F}, Archive::kReads ? 3U : 0U, 3});
    b.Always();
    b.Field("waterways", s.view.waterways, AnyFlag{});
    b.Field("courses", s.view.courses, AnyFlag{});
    VisitViewKinds(b, s.view);
    b.When(Archive::kReads || s.view.disaster_slots > 0, "");
    b.Field("disaster_slots", s.view.disaster_slots, Interval<std::int32_t>{0, kMaxDisasters});
    b.When(s.view.disaster_slots > 0, "disaster_slots is above 0");
    b.Field("forecast_leads_h", s.view.forecast_leads_h,
            ListOf<Interval<float>>{{0.0F, 240.0F, true}, 0, kMaxLeads});
    b.Always();
  });
}

/// Visits one number per cell. Numbers are written as values and read as values or as an expression
/// of the layers.
template <typename Archive, typename Values>
void VisitPerCell(Archive& a, const char* rule_key, const char* key, const char* condition,
                  const Scenario& scenario, Interval<float> range, Values& values) {
  bool ruled = false;
  if constexpr (Archive::kReads) {
    std::string rule;
    ruled = a.Has(rule_key, false);
    a.Field(rule_key, rule, TextOf{1, 1000});
    const std::string path = Join(a.path(), rule_key);
    if (ruled) values = ByRule(rule, scenario.seas->layers, path);
    const bool one_a_cell = values.size() == static_cast<std::size_t>(scenario.CellCount());
    if (ruled && one_a_cell) CheckPerCell(path, values, scenario.width, range);
  }
  a.When(Archive::kReads ? !ruled : !values.empty(), condition);
  a.Field(key, values, ListOf<NumberOrNone>{{}, 0, kMaxSeaValues});
  a.Always();
}

template <typename Archive, typename S>
void VisitSeas(Archive& a, S& s, const WorldFrame& frame) {
  a.Optional("seas", s.seas, [&](auto& b, auto& sea) {
    b.Structs("layers", sea.layers, {0, kMaxLayers}, [&](auto& c, auto& layer) {
      c.Field("name", layer.name, TextOf{1, 60}, Need::kRequired);
      const bool from_file = c.Has("file", false);
      c.When(!from_file, "there is no file");
      c.Field("units", layer.units, TextOf{0, 60});
      c.Field("values", layer.values, ListOf<NumberOrNone>{{}, 1, kMaxSeaValues}, Need::kRequired);
      if constexpr (Archive::kReads) {
        SeaSource source;
        c.When(from_file, "there is a file");
        c.Field("file", source.file, TextOf{1, 1000}, Need::kRequired);
        c.Field("variable", source.variable, TextOf{1, 200}, Need::kRequired);
        c.Field("depth_m", source.depth_m, Interval<double>{0.0, 12000.0});
        c.Field("time", source.time, UtcTime{});
        if (from_file) Resolve(source, frame, c.path(), s.width, s.height, layer);
      }
      c.Always();
    });
    VisitPerCell(b, "risk", "risk_values", "there is no risk", s, kRisk, sea.risk);
    VisitPerCell(b, "device_value", "device_values", "there is no device_value", s, kDeviceValue,
                 sea.device_value);
  });
}

template <typename Archive, typename S>
void VisitMoney(Archive& a, S& s) {
  a.Optional("money", s.money, [](auto& b, auto& money) {
    b.Field("currency", money.currency, TextOf{1, 10});
    b.Struct("device_values", [&](auto& c) {
      for (std::size_t kind = 0; kind < money.device_values.size(); ++kind) {
        const std::string key(ToString(static_cast<DeviceKind>(kind)));
        c.Field(key.c_str(), money.device_values[kind], kAmount);
      }
    });
    b.Field("ship_hour", money.ship_hour, kAmount);
    b.Field("kwh", money.kwh, Interval<double>{0.0, 1.0e6});
    b.Field("at_sea_loss", money.at_sea_loss, Interval<double>{0.0, 1.0});
  });
}

/// @param frame filled as soon as grid and time are known; required by the disasters' tracks
template <typename Archive, typename S>
void VisitScenario(Archive& a, S& s, WorldFrame& frame) {
  a.Field("name", s.name, TextOf{1, 100}, Need::kRequired);
  a.Field("description", s.description, TextOf{0, 4000});
  a.Struct("grid", [&](auto& b) {
    b.Field("width", s.width, kSide);
    b.Field("height", s.height, kSide);
    b.Field("cell_size_m", s.cell_size_m, Interval<double>{0.01, 1.0e6});
    b.Optional("origin", s.origin, [](auto& c, auto& point) { VisitGeoPoint(c, point); });
  });
  a.Struct("time", [&](auto& b) {
    b.Field("step_duration_s", s.step_duration_s, Interval<double>{0.001, 1.0e6});
    b.Field("start", s.start_time, UtcTime{});
    b.Field("step_limit", s.step_limit, Interval<std::int32_t>{1, kMaxSteps});
  });
  frame = {s.origin ? std::optional<GeoFrame>(GeoFrame(*s.origin, s.cell_size_m)) : std::nullopt,
           s.start_time,
           s.step_duration_s,
           s.cell_size_m,
           frame.folder,
           (s.width - 1) / 2.0,
           (s.height - 1) / 2.0};
  a.Struct("layout", [&](auto& b) {
    b.Field("mode", s.layout, OneOfNames{});
    b.When(s.layout == LayoutMode::kFixed, "mode is fixed");
    b.Field("seed", s.layout_seed, Interval<std::uint64_t>{0, UINT64_MAX});
    b.Always();
    VisitIslands(b, s);
    VisitRocksAndPorts(b, s);
    VisitDevices(b, s);
  });
  a.Struct("ships", [&](auto& b) {
    b.Field("count", s.ships.count, Interval<std::int32_t>{0, kMaxShips});
    b.Field("capacity", s.ships.capacity, Interval<std::int32_t>{1, kMaxDevices});
  });
  a.Structs("disasters", s.disasters, {0, kMaxDisasters},
            [&](auto& b, auto& disaster) { VisitDisaster(b, disaster, &frame); });
  VisitRewardsAndDamage(a, s);
  VisitEnergy(a, s);
  VisitView(a, s);
  VisitSeas(a, s, frame);
  VisitMoney(a, s);
  VisitFamily(a, s);
}

/// Archive that checks values in memory, including unused ones.
class FieldChecker {
 public:
  static constexpr bool kReads = false;
  explicit FieldChecker(std::string path = "") : path_(std::move(path)) {}
  static bool Has(const char*, bool otherwise) { return otherwise; }
  static void When(bool, const char*) {}
  static void Always() {}
  const std::string& path() const { return path_; }

  template <typename T, typename Domain>
  void Field(const char* key, const T& value, const Domain& domain, Need = Need::kOptional) const {
    Check(Join(path_, key), value, domain);
  }
  template <typename Visit>
  void Struct(const char* key, const Visit& visit) const {
    FieldChecker child(Join(path_, key));
    visit(child);
  }
  template <typename T, typename Visit>
  void Optional(const char* key, const std::optional<T>& value, const Visit& visit) const {
    FieldChecker child(Join(path_, key));
    if (value) visit(child, *value);
  }
  template <typename T, typename Visit>
  void Structs(const char* key, const std::vector<T>& values, std::array<std::size_t, 2> sizes,
               const Visit& visit) const {
    const std::string path = Join(path_, key);
    CheckSize(path, values.size(), sizes);
    for (std::size_t i = 0; i < values.size(); ++i) {
      FieldChecker child(At(path, i));
      visit(child, values[i]);
    }
  }

 private:
  std::string path_;
};

}  // namespace aquafarm::internal
