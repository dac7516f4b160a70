// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// One member of an ensemble: the central forecast with errors.

#include <array>
#include <cstdint>
#include <vector>

#include "aquafarm/agents/rescue/central_forecast.h"
#include "aquafarm/tracks/place_storm.h"

namespace aquafarm::agents {

/// A storm at one time.
struct StormState {
  float x{};  ///< [cells]
  float y{};
  std::array<std::array<float, 4>, kMaxStormRings> radius{};  ///< [ring][quadrant: NE SE SW NW]
  std::array<float, kMaxStormRings> risk{};
};

/// Draws members of a central forecast.
class MemberSampler {
 public:
  /// @param forecast must outlive the sampler, as must the options
  MemberSampler(const CentralForecast& forecast, const EnsembleOptions& options);

  /// Draws a member: its state at each point of the forecast.
  void Draw(std::int32_t member, std::vector<StormState>& states);
  /// Errors of the member that was drawn last, by point.
  const std::vector<StormErrors>& errors() const { return errors_; }

 private:
  void DrawErrors(std::int32_t member);

  const CentralForecast& forecast_;
  const EnsembleOptions& options_;
  std::vector<ForecastSpread> spread_;  // by point
  std::vector<double> size_sigma_;      // by point: SizeSigma
  std::vector<double> size_spread_;     // by point: of the logarithm, in units of size_sigma_
  std::vector<StormErrors> errors_;
  std::vector<Waypoint> waypoints_;
  StormPlacer placer_;
};

/// Interpolates between two states. @param part in [0, 1]
StormState Between(const StormState& from, const StormState& to, float part, std::size_t rings);

}  // namespace aquafarm::agents
