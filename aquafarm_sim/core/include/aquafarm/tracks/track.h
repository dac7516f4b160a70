// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Tropical cyclones as published by authorities. StormTrack represents all formats, such as best
/// tracks, b-decks, archives and bulletins. reader.h reads tracks, and storms/to_disaster.h
/// converts them to disasters.
///
///      NW | NE        A wind ring has a radius for each quadrant: winds of at least `wind_kt` blow
///    -----+-----      up to this distance from the centre. If the source does not give the radii
///      SW | SE        of a wind, the fix has no ring of this wind. If the source states that this
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

/// Grades of tropical cyclones by the max mean wind near the centre, GB/T 19201-2006.
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
/// Returns "unknown", "TD", "TS", "STS", "TY", "STY" or "SuperTY".
std::string_view ToString(StormGrade value);

/// Returns the grade of a wind [m/s]: TD from 10.8, TS from 17.2, STS from 24.5, TY from 32.7, STY
/// from 41.5, SuperTY from 51.0 (GB/T 19201-2006); kUnknown below. The standard defines the grades
/// for a 2-minute mean; a wind with another averaging period is not converted.
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
  std::int32_t wind_kt{};  ///< usually 34, 50 and 64; for the JMA 30 and 50
  std::array<double, kQuadrantCount>
      radius_km{};   ///< NE, SE, SW, NW; 0 if the wind does not blow in the quadrant
  bool estimated{};  ///< estimated (EstimateRing in wind_radii.h) or derived from another ring
};

/// One position of a storm.
struct StormFix {
  std::int64_t time{};  ///< UTC [s since 1970]
  GeoPoint position;    ///< longitude in (-180, 180]
  StormGrade grade{};
  bool extratropical{};                   ///< extratropical, or in transition
  std::optional<double> wind_mps;         ///< max mean wind near the centre
  std::optional<double> wind_below_mps;   ///< upper limit, if the source does not give the wind
  std::optional<double> second_wind_mps;  ///< second wind (OWD) of the CMA's best tracks
  std::int32_t averaging_min{};           ///< averaging period of the winds [min]; 0 if unknown
  std::optional<double> pressure_hpa;
  std::vector<WindRing> rings;  ///< sorted by wind, the weakest (widest) first
  std::optional<double> max_wind_radius_km;
  std::optional<double> heading_deg;  ///< compass bearing of the motion [0, 360)
  std::optional<double> speed_kmh;
  bool motion_computed{};  ///< heading or speed is computed (ComputeMotion)
  bool interpolated{};     ///< the position is interpolated, by the source or by FineTrack
  bool landfall{};         ///< the source marks a landfall or passage at this hour
  bool forecast{};         ///< predicted, not observed
  std::int32_t line{};     ///< line of the file; 0 in JSON

  /// Returns the ring of a wind; nullptr if the fix has none.
  const WindRing* Ring(std::int32_t wind_kt) const;
};

/// A forecast that was issued with one fix of a storm.
struct StormForecast {
  std::string agency;           ///< as written, UTF-8
  std::int64_t issued{};        ///< UTC [s since 1970]; the time of the fix
  std::vector<StormFix> fixes;  ///< sorted by time
};

struct Landfall {
  std::int64_t time{};
  GeoPoint position;
  std::string place;  ///< as written, UTF-8
};

/// Id of a track whose source gives no id.
inline constexpr const char* kUnknownStormId = "storm";

/// One storm.
struct StormTrack {
  std::string id;          ///< unique in its file, such as "2106"; kUnknownStormId if not given
  std::string name;        ///< as written; empty if not given
  std::string local_name;  ///< in the agency's language; empty if not given
  std::string agency;      ///< source of the positions, such as "CMA", "ATCF" or "bulletin"
  std::vector<StormFix> fixes;  ///< sorted by time, each time once
  std::vector<StormForecast> forecasts;
  std::vector<Landfall> landfalls;  ///< sorted by time
  std::int32_t line{};              ///< first line in the file; 0 in JSON
  std::string shared_id;  ///< id in the file, if several storms share it; `id` then has a suffix
};

/// Returns the grade of a disaster (1 blue … 4 red) for the grade of a storm: 1 for unknown, TD and
/// TS, 2 for STS, 3 for TY, 4 for STY and SuperTY. This table is our choice.
std::int32_t DisasterGrade(StormGrade grade);

/// Computes headings and speeds where the source does not give them. Uses the geodesic (WGS 84) to
/// the next fix. For the last fix, uses the geodesic between the last two fixes. A single fix gets
/// neither heading nor speed. A storm that does not move gets no heading.
/// @param fixes sorted by time
void ComputeMotion(std::vector<StormFix>& fixes);

/// Inserts a ring in the order of winds. Returns false without a change if `rings` already has a
/// ring of this wind.
bool AddRing(WindRing ring, std::vector<WindRing>& rings);

}  // namespace aquafarm
