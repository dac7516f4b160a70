// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/planning/risk_source.h"

#include <algorithm>
#include <utility>

#include "aquafarm/base/check.h"
#include "planning/water_distance.h"

namespace aquafarm::agents {
namespace {

constexpr std::size_t kKeptBytes = std::size_t{64} << 20U;

std::int32_t LastStep(const Farm& farm) {
  std::int32_t longest = 0;
  for (const Disaster& disaster : farm.disasters()) {
    longest = std::max(longest, disaster.steps_left);
  }
  const std::int32_t limit = farm.scenario().step_limit;
  return farm.disasters().empty() ? limit : std::min(limit, farm.step() + longest);
}

}  // namespace

std::vector<DeviceKind> KindsThatMatter(const Farm& farm) {
  const DamageSpec& damage = farm.scenario().damage;
  std::vector<DeviceKind> kinds;
  if (damage.exposure_damage == 0.0F) return kinds;
  for (int code = 0; code < kDeviceKindCount; ++code) {
    const auto kind = static_cast<DeviceKind>(code);
    const auto is_equal = [](float factor) { return factor == 1.0F; };
    const auto& factors = damage.FactorsOf(kind);
    if (std::all_of(factors.begin(), factors.end(), is_equal)) continue;
    const auto is_of_kind = [kind](const Device& device) {
      return device.kind == kind && device.status != DeviceStatus::kDelivered;
    };
    const std::vector<Device>& devices = farm.devices();
    if (std::any_of(devices.begin(), devices.end(), is_of_kind)) kinds.push_back(kind);
  }
  return kinds;
}

DisasterRisk::DisasterRisk(const Farm& farm, Foresight foresight)
    : farm_(farm),
      disasters_(farm.disasters()),
      tracks_(Foresee(farm, foresight, disasters_)),
      moved_to_(farm.step()),
      last_step_(LastStep(farm)),
      after_kept_(disasters_) {
  const Scenario& scenario = farm.scenario();
  const std::vector<DeviceKind> kinds = KindsThatMatter(farm);
  const std::size_t bytes =
      static_cast<std::size_t>(scenario.CellCount()) * (2 + kinds.size()) * sizeof(float);
  max_kept_ = std::max(std::size_t{1}, kKeptBytes / bytes);
  layers_.risk.resize(scenario.height, scenario.width);
  for (const DeviceKind kind : kinds) {
    layers_.by_kind[static_cast<std::size_t>(kind)].resize(scenario.height, scenario.width);
  }
}

const RiskLayers& DisasterRisk::At(std::int32_t step) {
  AQUAFARM_CHECK_LT(farm_.step(), step);
  const auto index = static_cast<std::size_t>(step - farm_.step() - 1);
  if (index < kept_.size()) return kept_[index];
  if (step < moved_to_) {
    disasters_ = after_kept_;
    moved_to_ = farm_.step() + static_cast<std::int32_t>(kept_.size());
  }
  while (moved_to_ < step) Advance();
  return index < kept_.size() ? kept_[index] : layers_;
}

void DisasterRisk::Advance() {
  const Scenario& scenario = farm_.scenario();
  ++moved_to_;
  for (std::size_t id = 0; id < disasters_.size(); ++id) {
    const StreamKey key{farm_.seed(), farm_.episode(), RngStream::kDisasterTurn,
                        static_cast<std::uint32_t>(id)};
    MoveDisaster(disasters_[id], tracks_[id], key, moved_to_, scenario.width, scenario.height);
  }
  FillRisks(scenario, disasters_, layers_.risk, layers_.by_kind);
  layers_.quiet = (layers_.risk < 0.0F).select(layers_.risk, scenario.rewards.step);
  if (kept_.size() == max_kept_) return;
  kept_.push_back(layers_);
  after_kept_ = disasters_;
}

float DisasterRisk::best_quiet() const {
  return std::max(farm_.scenario().rewards.step, static_cast<float>(kMildestRisk));
}

RiskField::RiskField(std::int32_t first_step, std::vector<RiskLayers> layers)
    : first_step_(first_step), layers_(std::move(layers)) {
  AQUAFARM_CHECK_LT(std::size_t{0}, layers_.size());
  best_quiet_ = layers_[0].quiet.maxCoeff();
  for (const RiskLayers& one : layers_) best_quiet_ = std::max(best_quiet_, one.quiet.maxCoeff());
}

const RiskLayers& RiskField::At(std::int32_t step) {
  AQUAFARM_CHECK_LE(first_step_, step);
  AQUAFARM_CHECK_LE(step, last_step());
  return layers_[static_cast<std::size_t>(step - first_step_)];
}

std::int32_t RiskField::last_step() const {
  return first_step_ + static_cast<std::int32_t>(layers_.size()) - 1;
}

}  // namespace aquafarm::agents
