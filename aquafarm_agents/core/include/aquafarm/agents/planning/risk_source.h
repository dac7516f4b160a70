// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The future risks that a plan assumes. Planner reads them from a RiskSource and does not move
/// disasters itself. The same exact search therefore runs on the true future, on a forecast, and on
/// the mean of an ensemble of futures.
///
/// A plan may use the mean layers of an ensemble. Disasters do not react to ships, so the expected
/// reward of a fixed plan is its reward under these layers. The same is true of damage as long as
/// no health reaches 0, because the loss of health is linear in the risk.

#include <cstdint>
#include <vector>

#include "aquafarm/agents/planning/plan.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/grid/grid.h"

namespace aquafarm::agents {

/// Risks of one step. All layers are [H, W].
struct RiskLayers {
  Grid<float> risk;  ///< risk at each cell; 0 or negative
  /// Reward of a step that ends in the cell and has no pickup, drop-off, crash or illegal action:
  /// the risk if it is negative, else the step reward. For an ensemble, the mean of these rewards.
  Grid<float> quiet;
  /// By kind of device: the risk that damages it (Farm::DamagingRiskAt). If a layer is empty,
  /// `risk` applies.
  DamagingRisks by_kind;

  /// Returns the risk that damages a kind of device.
  const Grid<float>& Damaging(DeviceKind kind) const {
    const Grid<float>& layer = by_kind[static_cast<std::size_t>(kind)];
    return layer.size() == 0 ? risk : layer;
  }
};

/// Returns the kinds of the farm's undelivered devices for which some damage factor is not 1; empty
/// if exposure causes no damage.
std::vector<DeviceKind> KindsThatMatter(const Farm& farm);

/// Provides the risks of each step.
class RiskSource {
 public:
  RiskSource() = default;
  RiskSource(const RiskSource&) = delete;
  RiskSource& operator=(const RiskSource&) = delete;
  virtual ~RiskSource() = default;

  /// Returns the risks of a step, after the disasters have moved. The reference is valid until the
  /// next call.
  /// @param step later than the farm's present step, at most last_step()
  virtual const RiskLayers& At(std::int32_t step) = 0;
  /// Returns the latest step at which the episode can end. No plan extends beyond this step.
  virtual std::int32_t last_step() const = 0;
  /// Returns an upper bound of RiskLayers::quiet over all cells and steps.
  virtual float best_quiet() const = 0;
};

/// The risks of a farm's disasters and sea in the steps after the farm's present step. Stores the
/// layers of the first of these steps (up to 64 MiB), so that later searches do not compute them
/// again.
class DisasterRisk final : public RiskSource {
 public:
  /// @param farm must outlive the object and must not step while the object is in use
  DisasterRisk(const Farm& farm, Foresight foresight);
  const RiskLayers& At(std::int32_t step) override;
  std::int32_t last_step() const override { return last_step_; }
  float best_quiet() const override;

 private:
  void Advance();

  const Farm& farm_;
  std::vector<Disaster> disasters_;  // state at step moved_to_
  std::vector<Track> tracks_;
  std::int32_t moved_to_{};
  std::int32_t last_step_{};
  std::vector<RiskLayers> kept_;  // layers of the first steps after the farm's present one
  std::size_t max_kept_{};
  std::vector<Disaster> after_kept_;  // state after the last step in kept_
  RiskLayers layers_;                 // layers of step moved_to_
};

/// Risk layers that the caller provides, for example the mean of an ensemble.
class RiskField final : public RiskSource {
 public:
  /// @param first_step step of layers[0]
  /// @param layers by step; at least one, all of the same shape
  RiskField(std::int32_t first_step, std::vector<RiskLayers> layers);
  const RiskLayers& At(std::int32_t step) override;
  std::int32_t last_step() const override;
  float best_quiet() const override { return best_quiet_; }

 private:
  std::int32_t first_step_;
  std::vector<RiskLayers> layers_;
  float best_quiet_{};
};

}  // namespace aquafarm::agents
