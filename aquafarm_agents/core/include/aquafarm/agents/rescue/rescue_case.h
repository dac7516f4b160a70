// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Makes the inputs of a rescue plan from a scenario and a RescueRequest, which names a storm file
/// and lists of devices and ships. The result does not depend on the computer's clock.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/agents/rescue/rescue_plan.h"
#include "aquafarm/farm/layout.h"
#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/tracks/storm_rings.h"

namespace aquafarm::agents {

/// Inputs of the operator. RescueCase::assumptions lists the values that the plan assumes, for
/// example the speed of the ships if `speed_kn` is unset.
struct RescueRequest {
  std::string bulletin;    ///< file of bulletins; exactly one of `bulletin` and `storm` must be set
  std::string storm;       ///< file of a recorded track. Its part after `at` serves as the forecast
  std::string storm_name;  ///< id or name of the storm; may be empty if the file has one storm
  /// Start of the plan, UTC [s since 1970]; required for `storm`. Default: `now` if it is less than
  /// 12 h after the last report of the bulletin and not before it, else the time of this report.
  std::optional<std::int64_t> at;
  std::optional<std::int64_t> now;    ///< present time, UTC [s since 1970]; unset for a past storm
  std::string devices;                ///< CSV file; empty: the devices of the scenario
  std::string ships_file;             ///< CSV file; empty: ships in the ports of the scenario
  std::optional<std::int32_t> ships;  ///< number of ships; unset: as in ships_file or scenario
  std::optional<double> speed_kn;     ///< speed of ships for which ships_file has no speed
  std::optional<std::int32_t> capacity;  ///< of ships for which ships_file has no capacity
  double depart_s{};                     ///< earliest departure [s after the start of the plan]
  /// Wind that stops a ship. The strongest ring of at most this wind is used. If there is no such
  /// ring, the weakest ring is used.
  double abort_wind_kt{34.0};
  double risk_averse{};                ///< see RescueProblem::risk_averse
  std::string currency;                ///< currency of the devices' values; may be empty
  std::optional<double> utc_offset_h;  ///< local time minus UTC; unset: from the longitude
  std::int32_t members{1000};          ///< members of the ensemble
  std::uint64_t seed{1};               ///< seed of the ensemble
  ForecastErrors errors;
};

/// A warning or note for the operator.
struct RescueWarning {
  std::string code;          ///< identifier for programs, of a-z and _
  std::string severity;      ///< stop, warning or note
  std::string text;          ///< one or more sentences
  std::string advice;        ///< what the operator should do; may be empty
  std::int32_t ship{kNone};  ///< index in RescueProblem::ships; kNone: not about a single ship
};

/// An assumption of the plan, with its basis.
struct RescueAssumption {
  std::string what;    ///< what is assumed
  std::string value;   ///< its value, with the unit
  std::string basis;   ///< recorded, forecast, published, estimated, assumed or given
  std::string source;  ///< publication, file, option or explanation
};

/// The storm of a case, for display.
struct StormRecord {
  std::string name;
  std::string agency;
  std::string file;
  StormRings rings;                         ///< rings at the points of the track
  std::int32_t held{};                      ///< see FineRings
  std::int64_t recorded_until{};            ///< time of the last report, UTC [s since 1970]
  std::optional<std::int64_t> issued;       ///< issue of the forecast, UTC [s since 1970]; without
                                            ///< a forecast, the last report; in a hindcast, the
                                            ///< start of the plan
  std::optional<std::int64_t> known_until;  ///< end of the forecast, UTC [s since 1970]
  bool is_hindcast{};                       ///< true: the forecast is the storm as recorded later
  bool is_persistence{};  ///< true: no forecast; the storm is assumed to keep its motion for 24 h
  /// Age of the last report [h]: at RescueRequest::now, or at the start of the plan if `now` is
  /// unset or `at` is set. 0 in a hindcast.
  double age_h{};
  Passage passage;  ///< of the central forecast near the ranch, after the start of the plan
};

/// A complete case: all inputs of a plan, and the data for its report.
struct RescueCase {
  std::shared_ptr<const Scenario> scenario;
  Layout layout;
  GeoFrame frame{{}, 1.0};
  std::int64_t start{};           ///< start of the plan (step 0), UTC [s since 1970]
  std::int32_t utc_offset_min{};  ///< local time minus UTC [min]
  RescueProblem problem;
  CentralForecast forecast;
  EnsembleOptions ensemble;
  StormRecord storm;
  std::string currency;
  std::vector<RescueWarning> warnings;
  std::vector<RescueAssumption> assumptions;

  /// Returns the cells of the devices, in the order of RescueProblem::devices.
  std::vector<Cell> Sites() const;
};

/// Makes a case.
/// @param scenario scenario of the ranch, with grid.origin
/// @throws InputError "devices.csv:3: F3: got …" if a file is wrong, if a device or ship is on land
///   or off the chart, if no route by water leads from a device of the CSV file to the first port,
///   if the storm is not known at and after the start of the plan, or if fields of the request are
///   missing or contradict each other
RescueCase MakeRescueCase(std::shared_ptr<const Scenario> scenario, const RescueRequest& request);

/// Formats a time as YYYY-MM-DDTHH:MM:SSZ. @param time UTC [s since 1970]
std::string FormatUtc(std::int64_t time);

}  // namespace aquafarm::agents
