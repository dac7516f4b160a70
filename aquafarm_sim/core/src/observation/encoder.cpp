// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/observation/encoder.h"

#include <algorithm>
#include <cstring>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/forecast.h"
#include "aquafarm/grid/action.h"
#include "observation/risk_raster.h"

namespace aquafarm {
namespace {

// RiskBrush paints the first two planes. Because the other planes follow, a run of cells (kRun)
// that extends past the end of a painted plane stays inside the buffer.
enum Plane : std::size_t { kRisk, kForecast, kObstacle, kPort, kDevice, kSelf, kCargo, kOthers };

// Returns the digit of a device in a status code: deployed (0), aboard this ship (1), or delivered
// or aboard another ship (2).
std::int32_t Standing(DeviceStatus status, bool aboard_self) {
  const std::int32_t is_away = status != DeviceStatus::kDeployed ? 1 : 0;
  return is_away * (aboard_self ? 1 : 2);  // branch-free: a branch would often be mispredicted
}

}  // namespace

Encoder::Encoder(const Scenario& scenario)
    : scenario_(scenario), groups_(FeatureGroups(scenario)), scales_(ScalesOf(scenario)) {
  fetchable_ = scenario.FetchableCount();
  planes_size_ =
      static_cast<std::size_t>(kPlaneCount) * static_cast<std::size_t>(scenario.CellCount());
  for (const FeatureGroup& group : groups_) {
    feature_count_ += static_cast<std::int32_t>(group.names.size());
  }

  if (scenario.seas && !scenario.seas->risk.empty()) {
    for (std::int32_t i = 0; i < scenario.CellCount(); ++i) {
      const Cell cell{i % scenario.width, i / scenario.width};
      sea_plane_.push_back(ToByte(-scenario.SeaRiskAt(cell) * kRiskScale));
    }
  }

  // status_rank_ has 3^D entries for D devices: 19 MB for the maximum.
  constexpr std::int32_t kMaxDevices = 14;
  if (fetchable_ > kMaxDevices) return;
  std::size_t codes = 1;
  for (std::int32_t i = 0; i < fetchable_; ++i) codes *= 3;
  status_rank_.assign(codes, kNone);
  for (std::size_t code = 0; code < codes; ++code) {
    std::int32_t aboard = 0;
    for (std::size_t rest = code; rest > 0; rest /= 3) aboard += rest % 3 == 1 ? 1 : 0;
    if (aboard > scenario.ships.capacity) continue;
    status_rank_[code] = static_cast<std::int32_t>(status_code_.size());
    status_code_.push_back(static_cast<std::int32_t>(code));
  }
  const std::uint64_t states = static_cast<std::uint64_t>(status_code_.size()) *
                               static_cast<std::uint64_t>(scenario.CellCount());
  state_count_ = states <= kMaxStates ? static_cast<std::uint32_t>(states) : 0;
}

std::uint32_t Encoder::Index(const Farm& farm, std::int32_t ship) const {
  AQUAFARM_CHECK_NE(state_count_, 0U);  // else the code of the devices may exceed its type
  std::int32_t code = 0;
  for (const Device& device : farm.devices()) {
    if (!device.self_propelled) code = code * 3 + Standing(device.status, device.carrier == ship);
  }
  return IndexOf(code, farm.ships()[static_cast<std::size_t>(ship)].cell);
}

std::uint32_t Encoder::Index(const View& view) const {
  AQUAFARM_CHECK_NE(state_count_, 0U);
  std::int32_t code = 0;
  for (const KnownDevice& device : view.devices) {
    if (!device.self_propelled) code = code * 3 + Standing(device.status, device.aboard_self);
  }
  return IndexOf(code, view.self);
}

std::uint32_t Encoder::IndexOf(std::int32_t code, Cell cell) const {
  const std::int32_t rank = status_rank_[static_cast<std::size_t>(code)];
  return static_cast<std::uint32_t>(rank * scenario_.CellCount() +
                                    LinearIndex(cell, scenario_.width));
}

Encoder::TabularState Encoder::Decode(std::uint32_t index) const {
  AQUAFARM_CHECK_LT(index, state_count_);
  const auto cells = static_cast<std::uint32_t>(scenario_.CellCount());
  TabularState state;
  const auto cell = static_cast<std::int32_t>(index % cells);
  state.cell = {cell % scenario_.width, cell / scenario_.width};
  state.status.resize(static_cast<std::size_t>(fetchable_));
  std::int32_t code = status_code_[index / cells];
  for (std::size_t device = state.status.size(); device-- > 0; code /= 3) {
    state.status[device] = static_cast<DeviceStatus>(code % 3);
  }
  return state;
}

void Encoder::Features(const View& view, float* out) const {
  for (const FeatureGroup& group : groups_) {
    group.write(scales_, view, out);
    out += group.names.size();
  }
}

void Encoder::Planes(const View& view, std::uint8_t* out) const {
  const Layout& layout = *view.layout;
  const auto cells = static_cast<std::size_t>(scenario_.CellCount());
  const auto plane = [&](Plane which) { return out + which * cells; };
  const auto at = [&](Plane which, Cell cell) -> std::uint8_t& {
    return plane(which)[LinearIndex(cell, scenario_.width)];
  };
  std::memset(out, 0, kObstacle * cells);
  std::memcpy(plane(kObstacle), layout.obstacle.data(), cells);
  std::memset(plane(kPort), 0, (kPlaneCount - kPort) * cells);
  for (const Cell port : layout.ports) at(kPort, port) = 255;
  float cargo = 0.0F;
  for (const KnownDevice& device : view.devices) {
    const float value = device.health * device.value * kValueScale;
    if (device.aboard_self) cargo += value;
    if (device.status == DeviceStatus::kDeployed) at(kDevice, device.cell) = ToByte(value);
  }
  if (view.active) at(kSelf, view.self) = 255;
  if (view.aboard > 0) at(kCargo, view.self) = ToByte(cargo / static_cast<float>(view.capacity));
  for (const KnownShip& other : view.others) {
    if (other.visible) at(kOthers, other.cell) = 255;
  }
  if (!sea_plane_.empty()) {
    std::memcpy(plane(kRisk), sea_plane_.data(), cells);
    std::memcpy(plane(kForecast), sea_plane_.data(), cells);
  }
  for (const KnownDisaster& known : view.disasters) {
    if (!known.known || !known.belief.active()) continue;
    const RiskBrush brush(known.belief, scenario_.width, scenario_.height);
    brush.Paint(0.0F, plane(kRisk));
    brush.Paint(static_cast<float>(known.age + kForecastSteps), plane(kForecast));
  }
}

std::vector<std::string> Encoder::feature_names() const {
  std::vector<std::string> names;
  for (const FeatureGroup& group : groups_) {
    names.insert(names.end(), group.names.begin(), group.names.end());
  }
  return names;
}

std::vector<std::string> Encoder::plane_names() {
  return {"risk", "forecast", "obstacle", "port", "device", "self", "cargo", "others"};
}

}  // namespace aquafarm
