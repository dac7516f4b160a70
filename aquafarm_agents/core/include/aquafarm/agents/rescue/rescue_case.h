// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Makes the inputs of a rescue plan from a ranch, a bulletin and lists of devices and ships.
/// Works without ROS; reads no clock.

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

/// Inputs of the operator. Unset fields get defaults, which the assumptions of the case list.
struct RescueRequest {
  std::string bulletin;  ///< file of bulletins with forecasts
  std::string storm;     ///< file of a recorded track: the forecast is its later part (a hindcast)
  std::string storm_name;             ///< in that file; empty if it has one storm
  std::optional<std::int64_t> at;     ///< start of the plan, UTC [s]; nothing later is known
  std::optional<std::int64_t> now;    ///< present time, if the plan is made for now
  std::string devices;                ///< CSV file
  std::string ships_file;             ///< CSV file
  std::optional<std::int32_t> ships;  ///< number, instead of the scenario's
  std::optional<double> speed_kn;     ///< of ships without their own
  std::optional<std::int32_t> capacity;
  double depart_s{};           ///< earliest departure after the start
  double abort_wind_kt{34.0};  ///< winds that stop a ship; see rescue_problem.h
  double risk_averse{};
  std::string currency;
  std::optional<double> utc_offset_h;
  std::int32_t members{1000};
  std::uint64_t seed{1};
  ForecastErrors errors;
};

/// A sentence for the operator.
struct RescueWarning {
  std::string code;      ///< for programs: a-z and _
  std::string severity;  ///< stop, warning or note
  std::string text;
  std::string advice;
  std::int32_t ship{kNone};  ///< index in RescueProblem::ships; kNone: all ships
};

/// Basis of a number of the plan.
struct RescueAssumption {
  std::string what;
  std::string value;
  std::string basis;  ///< recorded, forecast, published, estimated, assumed or given
  std::string source;
};

/// The storm of a case, for display.
struct StormRecord {
  std::string name;
  std::string agency;
  std::string file;
  StormRings rings;     ///< at the points of the track
  std::int32_t held{};  ///< see FineRings
  std::int64_t recorded_until{};
  std::optional<std::int64_t> issued;       ///< of the forecast
  std::optional<std::int64_t> known_until;  ///< end of the forecast
  bool is_hindcast{};
  bool is_persistence{};  ///< without a forecast: the storm is assumed to keep its motion for 24 h
  double age_h{};         ///< of the last report when the plan begins
  Passage passage;        ///< of the central forecast over the ranch, after the start of the plan
};

/// A complete case.
struct RescueCase {
  std::shared_ptr<const Scenario> scenario;
  Layout layout;
  GeoFrame frame{{}, 1.0};
  std::int64_t start{};  ///< UTC of step 0 [s since 1970]
  std::int32_t utc_offset_min{};
  RescueProblem problem;
  CentralForecast forecast;
  EnsembleOptions ensemble;
  StormRecord storm;
  std::string currency;
  std::vector<RescueWarning> warnings;
  std::vector<RescueAssumption> assumptions;

  std::vector<Cell> Sites() const;
};

/// Makes a case. @param scenario of the ranch, with grid.origin
/// @throws InputError "devices.csv:3: F3: got …" for a bad file, a place on land, off the chart or
///   out of reach, or a storm that is not known at the start of the plan
RescueCase MakeRescueCase(std::shared_ptr<const Scenario> scenario, const RescueRequest& request);

/// Formats a time as YYYY-MM-DDTHH:MM:SSZ.
std::string FormatUtc(std::int64_t time);

}  // namespace aquafarm::agents
