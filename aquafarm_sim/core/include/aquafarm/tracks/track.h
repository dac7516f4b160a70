// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Tropical cyclones as published by authorities, in one track type for all formats: best tracks,
/// b-decks, archives and bulletins. reader.h reads them, storms/to_disaster.h converts them to
/// disasters.
///
///      NW | NE        A wind ring contains, for each quadrant, the distance from the centre to
///    -----+-----      which winds of at least `wind_kt` blow. If the source does not give a ring
///      SW | SE        of a wind, the fix does not have it. If it states that this
///                     wind does not blow, the ring has four zeros.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/grid/geo_frame.h"

namespace aquafarm {

inline constexpr double kKmPerNauticalMile = 1.852;
inline constexpr double kMpsPerKnot = 0.514444;

/// Grades of tropical cyclones by the greatest mean wind near the centre, GB/T 19201-2006.
enum class StormGrade : std::uint8_t {
  kUnknown,  ///< not given, or weaker than a depression
  kTropicalDepression,
  kTropicalStorm,
  kSevereTropicalStorm,
  kTyphoon,
  kSevereTyphoon,
  kSuperTyphoon,
};
inline constexpr int kStormGradeCount = 7;
/// "unknown", "TD", "TS", "STS", "TY", "STY", "SuperTY".
std::string_view ToString(StormGrade value);

/// Returns the grade of a wind [m/s]: TD from 10.8, TS 17.2, STS 24.5, TY 32.7, STY 41.5, SuperTY
/// 51.0 (GB/T 19201-2006). The standard defines them for a 2-minute mean; a wind with another
/// averaging period is not converted.
StormGrade GradeOfWind(double wind_mps);

/// Returns the lower limit of a grade [m/s]; 0 for kUnknown.
double LowestWindOf(StormGrade grade);

/// Quadrants of a ring, always in this order.
enum Quadrant : std::uint8_t {
  kNorthEastQuadrant,
  kSouthEastQuadrant,
  kSouthWestQuadrant,
  kNorthWestQuadrant
};
inline constexpr int kQuadrantCount = 4;

/// Extent of winds of at least `wind_kt`.
struct WindRing {
  std::int32_t wind_kt{};  ///< 34, 50, 64, or 30 of the JMA; Beaufort 7, 10, 12 are the first three
  std::array<double, kQuadrantCount>
      radius_km{};   ///< NE, SE, SW, NW; 0 if the wind does not blow in the quadrant
  bool estimated{};  ///< computed by EstimateRing (wind_radii.h), not given by the source
};

/// One position of a storm.
struct StormFix {
  std::int64_t time{};  ///< UTC [s since 1970]
  GeoPoint position;    ///< longitude in (-180, 180]
  StormGrade grade{};
  bool extratropical{};                   ///< extratropical, or in transition
  std::optional<double> wind_mps;         ///< greatest mean wind near the centre
  std::optional<double> wind_below_mps;   ///< given instead of wind_mps: upper limit of the wind
  std::optional<double> second_wind_mps;  ///< OWD of the CMA: the wind at the coast
  std::int32_t averaging_min{};           ///< averaging period of the winds [min]; 0 if unknown
  std::optional<double> pressure_hpa;
  std::vector<WindRing> rings;  ///< sorted by wind, the weakest (widest) first
  std::optional<double> max_wind_radius_km;
  std::optional<double> heading_deg;  ///< compass bearing of the motion [0, 360)
  std::optional<double> speed_kmh;
  bool motion_computed{};  ///< computed from the neighbouring fixes, not given by the source
  bool interpolated{};     ///< the source marks the position as interpolated
  bool landfall{};         ///< the source marks a landfall or passage at this hour
  bool forecast{};         ///< predicted, not observed
  std::int32_t line{};     ///< line of the file; 0 in JSON

  /// Returns the ring of a wind; nullptr if the source gives none.
  const WindRing* Ring(std::int32_t wind_kt) const;
};

/// A forecast that was issued with a fix.
struct StormForecast {
  std::string agency;           ///< as written, UTF-8
  std::int64_t issued{};        ///< UTC [s since 1970]: the time of the fix it came with
  std::vector<StormFix> fixes;  ///< sorted by time
};

struct Landfall {
  std::int64_t time{};
  GeoPoint position;
  std::string place;  ///< as written, UTF-8
};

/// One storm.
struct StormTrack {
  std::string id;          ///< unique in its file: "2106", "CMA3" (unnumbered), "WP082014", SID
  std::string name;        ///< as written; empty if not given
  std::string local_name;  ///< in the agency's language; empty if not given
  std::string agency;      ///< agency whose positions these are
  std::vector<StormFix> fixes;  ///< sorted by time, each time once
  std::vector<StormForecast> forecasts;
  std::vector<Landfall> landfalls;  ///< sorted by time
  std::int32_t line{};              ///< first line in the file; 0 in JSON
  std::string shared_id;  ///< id in the file if several storms share it; `id` is then made unique
};

/// Returns the grade as a warning colour (1 blue … 4 red): TD and TS 1, STS 2, TY 3, STY and
/// SuperTY 4. [decided]
std::int32_t DisasterGrade(StormGrade grade);

/// Computes the motion where the source gives none: bearing and distance (geodesic, WGS 84) to the
/// next fix, and at the last fix from the previous one.
/// @param fixes sorted by time
void ComputeMotion(std::vector<StormFix>& fixes);

/// Inserts a ring, sorted by wind. @returns false if there is already one of this wind
bool AddRing(WindRing ring, std::vector<WindRing>& rings);

}  // namespace aquafarm
