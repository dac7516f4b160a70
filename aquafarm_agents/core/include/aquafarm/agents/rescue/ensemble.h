// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Many possible futures (members) of one storm, and the effects of each on a ranch.
///
///   central forecast ──> + errors that grow with lead time (forecast_errors.h) ──> members
///   member ──> rings of wind over the cells in each step ──> arrival of each ring at each cell,
///              probability of each ring by step and cell, exposure of the devices
///
/// For a given forecast and seed, member i does not depend on the number of members.

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "aquafarm/agents/planning/risk_source.h"
#include "aquafarm/agents/rescue/central_forecast.h"
#include "aquafarm/grid/cell.h"

namespace aquafarm::agents {

/// Spread of the members about one point of the central forecast.
struct EnsembleSpread {
  double time_s{};                 ///< time of the point [s after the start of the plan]
  double lead_h{};                 ///< lead time of the point [h]
  std::array<double, 2> center{};  ///< centre of the storm in the central forecast [cells]
  double along_km{};               ///< standard deviation of the position along the track
  double across_km{};              ///< standard deviation of the position across the track
  double radius70_km{};  ///< 70 % of the members are at most this far from the central forecast
  double wind_mps{};     ///< standard deviation of the wind
  double size_log{};     ///< standard deviation of the logarithm of the factor of all radii
};

/// The members. The constructor computes all arrays.
class Ensemble {
 public:
  /// Value of Arrival for a ring that does not reach the cell in the steps of the ensemble.
  static constexpr std::int16_t kNoArrival = std::numeric_limits<std::int16_t>::max();

  /// @param sites cells of the map for which Exposure is computed
  /// @throws InputError if the number of members, steps or rings is out of range, or if an array
  ///   is too large: members × cells × rings, members × steps × sites, or rings × steps × cells
  Ensemble(const CentralForecast& forecast, const EnsembleOptions& options,
           const std::vector<Cell>& sites);

  const EnsembleOptions& options() const { return options_; }
  std::int32_t members() const { return options_.members; }
  std::int32_t steps() const { return options_.steps; }
  std::int32_t rings() const { return rings_; }

  /// First step at which a ring covers a cell, [members]; kNoArrival if it never covers the cell.
  const std::int16_t* Arrival(std::int32_t ring, Cell cell) const {
    const auto cells = static_cast<std::size_t>(options_.width * options_.height);
    const auto index = static_cast<std::size_t>(cell.y * options_.width + cell.x);
    return arrival_.data() +
           (static_cast<std::size_t>(ring) * cells + index) * static_cast<std::size_t>(members());
  }
  /// Sum of |risk| at a site over the steps 0 … `step`, [members].
  const float* Exposure(std::size_t site, std::int32_t step) const {
    const auto count = static_cast<std::size_t>(members());
    const auto at = static_cast<std::size_t>(step);
    return exposure_.data() + (site * static_cast<std::size_t>(steps()) + at) * count;
  }
  /// Number of members in which a ring covers each cell at a step, [H, W].
  const std::uint16_t* Covered(std::int32_t ring, std::int32_t step) const {
    const auto cells = static_cast<std::size_t>(options_.width * options_.height);
    return covered_.data() + static_cast<std::size_t>(ring * steps() + step) * cells;
  }
  /// Number of members in which a ring covers at least one cell at a step.
  std::int32_t Touching(std::int32_t ring, std::int32_t step) const {
    return touching_[static_cast<std::size_t>(ring * steps() + step)];
  }
  /// Spread at the points of the central forecast.
  const std::vector<EnsembleSpread>& spread() const { return spread_; }

  /// Returns the mean of the members' risk layers for the planner (risk_source.h), for the steps
  /// from first_step on. The result has no layers by kind of device.
  /// @param first_step [0, steps())
  /// @param step_reward reward of a step without risk
  RiskField MeanRisk(std::int32_t first_step, float step_reward) const;

 private:
  EnsembleOptions options_;
  std::int32_t rings_{};
  std::vector<std::int16_t> arrival_;   // [rings, cells, members]
  std::vector<float> exposure_;         // [sites, steps, members]
  std::vector<std::uint16_t> covered_;  // [rings, steps, cells]
  std::vector<std::int32_t> touching_;  // [rings, steps]
  std::vector<float> risk_sum_;         // [steps, cells] sum of the risks of all members
  std::vector<EnsembleSpread> spread_;

  friend class EnsembleBuilder;
};

}  // namespace aquafarm::agents
