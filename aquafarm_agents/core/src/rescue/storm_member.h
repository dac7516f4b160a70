// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Draws members of an ensemble: the central forecast with errors.

#include <array>
#include <cstdint>
#include <vector>

#include "aquafarm/agents/rescue/central_forecast.h"
#include "aquafarm/tracks/place_storm.h"

namespace aquafarm::agents {

/// State of a storm at one time.
struct StormState {
  float x{};  ///< centre [cells]
  float y{};
  /// [ring][quadrant: NE SE SW NW] [cells]
  std::array<std::array<float, 4>, kMaxStormRings> radius{};
  std::array<float, kMaxStormRings> risk{};  ///< by ring
};

/// Draws members of a central forecast.
class MemberSampler {
 public:
  /// @param forecast must outlive the sampler
  /// @param options must outlive the sampler
  MemberSampler(const CentralForecast& forecast, const EnsembleOptions& options);

  /// Draws a member.
  /// @param states is set to the state at each point of the forecast
  void Draw(std::int32_t member, std::vector<StormState>& states);
  /// Errors of the last drawn member, by point.
  const std::vector<StormErrors>& errors() const { return errors_; }

 private:
  void DrawErrors(std::int32_t member);

  const CentralForecast& forecast_;
  const EnsembleOptions& options_;
  std::vector<ForecastSpread> spread_;  // by point
  std::vector<double> size_sigma_;      // by point: SizeSigma (tracks/wind_radii.h)
  std::vector<double> size_spread_;     // by point: standard deviation of ln(size) / size_sigma_
  std::vector<StormErrors> errors_;
  std::vector<Waypoint> waypoints_;
  StormPlacer placer_;
};

/// Interpolates between two states. @param part [0, 1]; 0 gives `from`, 1 gives `to`
StormState Between(const StormState& from, const StormState& to, float part, std::size_t rings);

}  // namespace aquafarm::agents
