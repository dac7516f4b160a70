// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Tropical cyclones as authorities publish them, whatever the format: one kind of track for best
/// tracks, b-decks, archives and bulletins. hazard_file.h reads them, hazard_disaster.h brings
/// them onto a farm.
///
///          NW | NE        a wind ring: how far from the centre a wind of at least `wind_kt` blows,
///        -----+-----      by quadrant. No ring of a wind in a fix: it was not said. A ring of four
///          SW | SE        zeros: it was said that this wind blows nowhere.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

inline constexpr double kKmPerNauticalMile = 1.852;
inline constexpr double kMpsPerKnot = 0.514444;

/// Grades of tropical cyclones by the greatest mean wind near the centre, GB/T 19201-2006.
enum class StormGrade : std::uint8_t {
  kUnknown,  ///< not said, or weaker than a depression
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

/// The grade of a wind [m/s]: TD from 10.8, TS 17.2, STS 24.5, TY 32.7, STY 41.5, SuperTY 51.0
/// (GB/T 19201-2006). The standard means a 2-minute wind; a wind of other averaging is graded as
/// it stands.
StormGrade GradeOfWind(double wind_mps);

/// The lower limit of a grade [m/s]; 0 for kUnknown.
double LowestWindOf(StormGrade grade);

/// Quadrants of a ring, in this order everywhere.
enum Quadrant : std::uint8_t {
  kNorthEastQuadrant,
  kSouthEastQuadrant,
  kSouthWestQuadrant,
  kNorthWestQuadrant
};
inline constexpr int kQuadrantCount = 4;

/// How far winds of at least `wind_kt` reach.
struct WindRing {
  std::int32_t wind_kt{};  ///< 34, 50, 64, or 30 of the JMA; Beaufort 7, 10, 12 are the first three
  std::array<double, kQuadrantCount> radius_km{};  ///< NE, SE, SW, NW; 0: not in this quadrant
  bool estimated{};                                ///< by EstimateRing, not by the source
};

/// One position of a storm.
struct StormFix {
  std::int64_t time{};  ///< UTC [s since 1970]
  GeoPoint position;    ///< longitude in (-180, 180]
  StormGrade grade{};
  bool extratropical{};                   ///< or becoming so
  std::optional<double> wind_mps;         ///< greatest mean wind near the centre
  std::optional<double> wind_below_mps;   ///< said instead: the wind was below this
  std::optional<double> second_wind_mps;  ///< CMA's OWD: of storms at a coast, the wind there
  std::int32_t averaging_min{};           ///< of the winds [min]; 0: not known
  std::optional<double> pressure_hpa;
  std::vector<WindRing> rings;  ///< by wind, the weakest (widest) first
  std::optional<double> max_wind_radius_km;
  std::optional<double> heading_deg;  ///< compass bearing it moves towards [0, 360)
  std::optional<double> speed_kmh;
  bool motion_computed{};  ///< from the fixes around it, not said by the source
  bool interpolated{};     ///< the source says that it filled in the place
  bool landfall{};         ///< the source marks a landfall or passage at this hour
  bool forecast{};         ///< predicted, not observed
  std::int32_t line{};     ///< of the file; 0 in JSON

  /// The ring of a wind; null: none was said.
  const WindRing* Ring(std::int32_t wind_kt) const;
};

/// A forecast that was issued with a fix.
struct StormForecast {
  std::string agency;           ///< as written, UTF-8
  std::int64_t issued{};        ///< UTC [s since 1970]: the time of the fix it came with
  std::vector<StormFix> fixes;  ///< in order of time
};

struct Landfall {
  std::int64_t time{};
  GeoPoint position;
  std::string place;  ///< as written, UTF-8
};

/// One storm.
struct StormTrack {
  std::string id;    ///< the only one in its file: "2106", "CMA3" (unnumbered), "WP082014", SID
  std::string name;  ///< as written; empty: none was given
  std::string local_name;       ///< in the agency's own writing; empty: none was given
  std::string agency;           ///< whose positions these are
  std::vector<StormFix> fixes;  ///< in order of time, no time twice
  std::vector<StormForecast> forecasts;
  std::vector<Landfall> landfalls;  ///< in order of time
  std::int32_t line{};              ///< of the file, where it starts; 0 in JSON
  std::string shared_id;  ///< in the file, where others have it too; `id` tells them apart
};

/// A grade as the bulletin's colours have it (1 blue … 4 red): TD and TS 1, STS 2, TY 3, STY and
/// SuperTY 4. [decided]
std::int32_t DisasterGrade(StormGrade grade);

/// Fills in motion where the source gives none: bearing and distance (geodesic, WGS 84) to the next
/// fix, at the last fix from the one before. @param fixes in order of time
void ComputeMotion(std::vector<StormFix>& fixes);

/// Adds the ring of a wind to a fix that was said none of it, marked as estimated.
///
/// Its radius follows from Holland's gradient wind (Holland 1980, Mon. Wea. Rev. 108, 1212-1218),
///   V(r) = sqrt(Vc^2 a exp(1 - a) + (f r / 2)^2) - f r / 2,   a = (Rmax / r)^B,
/// with Vc such that V(Rmax) is the fix's wind, taken as it stands. Rmax is the fix's own, else
/// 46.4 exp(-0.0155 Vmax + 0.0169 |latitude|) km, Vmax in m/s (Willoughby, Darling and Rahn 2006,
/// Mon. Wea. Rev. 134, 1102-1120, Eq. 7a). B is e rho Vmax^2 / (1010 hPa - pressure) with
/// rho = 1.15 kg/m3, kept in Holland's range [1, 2.5]; 1.3 without a pressure. Circles: asymmetry
/// is not guessed.
/// @returns whether it added one; without a wind it cannot
bool EstimateRing(StormFix& fix, std::int32_t wind_kt);

/// Puts a ring in order of wind. @returns false when there is one of this wind already
bool AddRing(WindRing ring, std::vector<WindRing>& rings);

}  // namespace aquafarm
