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

constexpr std::int32_t kSelfFeatures = kFirstBlockedFeature;
constexpr std::int32_t kDeviceFeatures = 5;
constexpr std::int32_t kPortFeatures = 2;
constexpr std::int32_t kDisasterFeatures = 7;
constexpr std::int32_t kShipFeatures = 4;
constexpr std::int32_t kWayFeatures = 3;
constexpr std::int32_t kCourseFeatures = kMoveCount + kCourseCount;
constexpr float kValueScale = 1.0F / 100.0F;  // 1 / max device value of the paper

// The painted planes come first, so that a run past the end of a plane stays inside the buffer.
enum Plane : std::size_t { kRisk, kForecast, kObstacle, kPort, kDevice, kSelf, kCargo, kOthers };

// Returns the digit of a device in a status code: deployed (0), aboard the ship (1) or gone (2).
std::int32_t Standing(DeviceStatus status, bool aboard_self) {
  if (status == DeviceStatus::kDeployed) return 0;
  return aboard_self ? 1 : 2;
}

// Returns the number of one-hot identity features, with which one network can control all agents. A
// single agent needs none.
std::int32_t IdentityFeatures(const Scenario& scenario) {
  return scenario.AgentCount() > 1 ? scenario.AgentCount() : 0;
}

// Returns the max length of an episode [steps].
float Horizon(const Scenario& scenario) {
  std::int32_t horizon = 0;
  for (const DisasterSpec& disaster : scenario.disasters) {
    horizon = std::max(horizon, disaster.duration);
  }
  if (horizon == 0) return static_cast<float>(scenario.step_limit);
  return static_cast<float>(std::min(horizon, scenario.step_limit));
}

}  // namespace

Encoder::Encoder(const Scenario& scenario) : scenario_(scenario) {
  const std::int32_t devices = scenario.devices.Total();
  fetchable_ = scenario.FetchableCount();
  scale_ = 1.0F / static_cast<float>(std::max(scenario.width, scenario.height));
  horizon_ = Horizon(scenario);
  planes_size_ =
      static_cast<std::size_t>(kPlaneCount) * static_cast<std::size_t>(scenario.CellCount());
  const std::int32_t ports = scenario.PortCount();
  feature_count_ = kSelfFeatures + kMoveCount + devices * kDeviceFeatures + ports * kPortFeatures +
                   static_cast<std::int32_t>(scenario.disasters.size()) * kDisasterFeatures +
                   (scenario.AgentCount() - 1) * kShipFeatures + IdentityFeatures(scenario) +
                   (scenario.view.waterways ? (ports + fetchable_) * kWayFeatures : 0) +
                   (scenario.view.courses ? kCourseFeatures : 0);

  if (scenario.seas && !scenario.seas->risk.empty()) {
    for (std::int32_t i = 0; i < scenario.CellCount(); ++i) {
      const Cell cell{i % scenario.width, i / scenario.width};
      sea_plane_.push_back(ToByte(-scenario.SeaRiskAt(cell) * kRiskScale));
    }
  }

  // Base-3 codes grow as 3^D; with more devices no table would fit in memory.
  constexpr std::int32_t kMostDevices = 14;
  if (fetchable_ > kMostDevices) return;
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
  std::int32_t code = 0;
  for (const Device& device : farm.devices()) {
    if (!device.self_propelled) code = code * 3 + Standing(device.status, device.carrier == ship);
  }
  return IndexOf(code, farm.ships()[static_cast<std::size_t>(ship)].cell);
}

std::uint32_t Encoder::Index(const View& view) const {
  std::int32_t code = 0;
  for (const KnownDevice& device : view.devices) {
    if (!device.self_propelled) code = code * 3 + Standing(device.status, device.aboard_self);
  }
  return IndexOf(code, view.self);
}

std::uint32_t Encoder::IndexOf(std::int32_t code, Cell cell) const {
  AQUAFARM_CHECK_NE(state_count_, 0U);
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
  const Layout& layout = *view.layout;
  const float scale = scale_;  // a copy, because `out` might alias the member
  const Cell self = view.self;
  const auto east = [=](Cell cell) { return static_cast<float>(cell.x - self.x) * scale; };
  const auto north = [=](Cell cell) { return static_cast<float>(cell.y - self.y) * scale; };
  out[0] = 2.0F * static_cast<float>(self.x) * scale - 1.0F;
  out[1] = 2.0F * static_cast<float>(self.y) * scale - 1.0F;
  // A disaster that is set in play may last longer than the scenario's own.
  out[2] = std::max(0.0F, 1.0F - static_cast<float>(view.step) / horizon_);
  out[3] = static_cast<float>(view.capacity - view.aboard) / static_cast<float>(view.capacity);
  out[4] = KnownRiskAt(view, self) * kRiskScale;
  out = Blocked(layout, self, out + kFirstBlockedFeature);
  for (const KnownDevice& device : view.devices) {
    out[0] = east(device.cell);
    out[1] = north(device.cell);
    out[2] = device.status == DeviceStatus::kDeployed ? 1.0F : 0.0F;
    out[3] = device.aboard_self ? 1.0F : 0.0F;
    out[4] = device.health * device.value * kValueScale;
    out += kDeviceFeatures;
  }
  for (const Cell port : layout.ports) {
    *out++ = east(port);
    *out++ = north(port);
  }
  for (std::size_t id = 0; id < scenario_.disasters.size(); ++id, out += kDisasterFeatures) {
    const KnownDisaster& known = view.disasters[id];
    if (!known.known || !known.belief.active()) {
      std::fill_n(out, kDisasterFeatures, 0.0F);
      continue;
    }
    const ObservableDisaster& disaster = known.belief;
    out[0] = 1.0F;
    out[1] = (disaster.x - static_cast<float>(self.x)) * scale;
    out[2] = (disaster.y - static_cast<float>(self.y)) * scale;
    out[3] = disaster.dx;
    out[4] = disaster.dy;
    out[5] = disaster.reach() * scale;
    out[6] = known.age == 0 ? 0.0F
                            : static_cast<float>(known.age) /
                                  static_cast<float>(view.scenario->view.bulletin_period);
  }
  for (const KnownShip& other : view.others) {
    *out++ = other.visible ? 1.0F : 0.0F;
    *out++ = other.visible ? east(other.cell) : 0.0F;
    *out++ = other.visible ? north(other.cell) : 0.0F;
    *out++ =
        other.visible ? static_cast<float>(other.aboard) / static_cast<float>(view.capacity) : 0.0F;
  }
  const std::int32_t identities = IdentityFeatures(scenario_);
  std::fill_n(out, identities, 0.0F);
  if (identities > 0) out[view.ship] = 1.0F;
  out += identities;
  if (scenario_.view.waterways) out = Ways(view, out);
  if (scenario_.view.courses) Courses(view, out);
}

// Writes whether each move leads off the map or into a rock or island. @returns the end of the
// written range
float* Encoder::Blocked(const Layout& layout, Cell self, float* out) const {
  const std::int32_t width = scenario_.width;
  const std::int32_t height = scenario_.height;
  const std::uint8_t* const here = layout.cells.data() + LinearIndex(self, width);
  const auto is_blocked = [=](Cell move) {
    return (here[LinearIndex(move, width)] & kBlockedBits) != 0;
  };
  const bool inside = self.x > 0 && self.x < width - 1 && self.y > 0 && self.y < height - 1;
  if (inside) {  // the common case, without a branch per move
    for (const Cell move : kMoves) *out++ = static_cast<float>(is_blocked(move));
    return out;
  }
  for (const Cell move : kMoves) {
    const Cell to{self.x + move.x, self.y + move.y};
    const bool off = to.x < 0 || to.x >= width || to.y < 0 || to.y >= height;
    *out++ = static_cast<float>(off || is_blocked(move));
  }
  return out;
}

// Writes the forecast risk after one step of each move, and the mean forecast risk over the steps
// of each straight course and of staying. A ship stops at the edge of the map.
void Encoder::Courses(const View& view, float* out) const {
  CourseRisks risks(scenario_, view.self);
  for (const KnownDisaster& known : view.disasters) {
    if (known.known && known.belief.active()) {
      risks.MaxWith(known.belief, static_cast<float>(known.age));
    }
  }
  risks.Write(out, out + kMoveCount);
}

// Writes the next move and the number of moves left to every port and every deployed device.
float* Encoder::Ways(const View& view, float* out) const {
  const Layout& layout = *view.layout;
  const auto cell = static_cast<std::size_t>(LinearIndex(view.self, scenario_.width));
  const RouteEntry* way = layout.ways.data() + cell * layout.way_count();
  // Also encodes unreachable targets.
  const std::int32_t farthest = 2 * (scenario_.width + scenario_.height);
  const auto write = [&] {
    *out++ = static_cast<float>(way->east);
    *out++ = static_cast<float>(way->north);
    *out++ = static_cast<float>(std::min(way->steps, farthest)) * scale_;
    ++way;
  };
  for (std::size_t port = 0; port < layout.ports.size(); ++port) write();
  for (const KnownDevice& device : view.devices) {
    if (device.self_propelled) continue;
    if (device.status == DeviceStatus::kDeployed) {
      write();
    } else {
      out = std::fill_n(out, kWayFeatures, 0.0F);
      ++way;
    }
  }
  return out;
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
    const float worth = device.health * device.value * kValueScale;
    if (device.aboard_self) cargo += worth;
    if (device.status == DeviceStatus::kDeployed) at(kDevice, device.cell) = ToByte(worth);
  }
  if (view.in_play) at(kSelf, view.self) = 255;
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
  std::vector<std::string> names{"self.x", "self.y", "time_left", "free_capacity", "risk_here"};
  for (int move = 0; move < kMoveCount; ++move) {
    names.push_back("blocked." + std::string(ToString(static_cast<Action>(move))));
  }
  const auto add = [&names](const std::string& thing, std::int32_t id,
                            std::initializer_list<const char*> parts) {
    for (const char* part : parts) names.push_back(thing + std::to_string(id) + '.' + part);
  };
  for (std::int32_t i = 0; i < scenario_.devices.Total(); ++i) {
    add("device", i, {"east", "north", "deployed", "aboard", "worth"});
  }
  const std::int32_t ports = scenario_.PortCount();
  for (std::int32_t i = 0; i < ports; ++i) add("port", i, {"east", "north"});
  for (std::size_t i = 0; i < scenario_.disasters.size(); ++i) {
    add("disaster", static_cast<std::int32_t>(i),
        {"known", "east", "north", "motion_east", "motion_north", "reach", "age"});
  }
  for (std::int32_t i = 0; i + 1 < scenario_.AgentCount(); ++i) {
    add("other", i, {"visible", "east", "north", "aboard"});
  }
  for (std::int32_t i = 0; i < IdentityFeatures(scenario_); ++i) add("agent", i, {"self"});
  if (scenario_.view.waterways) AddWayNames(names);
  if (!scenario_.view.courses) return names;
  for (const char* part : {"risk.", "course."}) {
    for (int move = 0; move < kMoveCount; ++move) {
      names.push_back(part + std::string(ToString(static_cast<Action>(move))));
    }
  }
  names.emplace_back("course.stay");
  return names;
}

void Encoder::AddWayNames(std::vector<std::string>& names) const {
  const auto add = [&names](const char* thing, std::int32_t id) {
    for (const char* part : {".way_east", ".way_north", ".way_steps"}) {
      names.push_back(thing + std::to_string(id) + part);
    }
  };
  for (std::int32_t i = 0; i < scenario_.PortCount(); ++i) add("port", i);
  for (std::int32_t i = 0; i < scenario_.devices.Total(); ++i) {
    const bool fetched = scenario_.devices.placement == DevicePlacement::kExplicit
                             ? !scenario_.devices.sites[static_cast<std::size_t>(i)].self_propelled
                             : i < fetchable_;
    if (fetched) add("device", i);
  }
}

std::vector<std::string> Encoder::plane_names() {
  return {"risk", "forecast", "obstacle", "port", "device", "self", "cargo", "others"};
}

}  // namespace aquafarm
