// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/observation/tokens.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "aquafarm/farm/energy.h"
#include "aquafarm/grid/action.h"
#include "observation/token_risk.h"
#include "observation/token_targets.h"

namespace aquafarm {
namespace {

constexpr float kFarthest = 4.0F;           // limit of lengths and other clamped features
constexpr float kCloseSteps = 4.0F;         // moves at which the feature `close` is 1/2
constexpr float kRingSteps = 8.0F;          // steps at which `rings_in` and `rings_out` are 1/2
constexpr float kCountScale = 1.0F / 4.0F;  // factor of devices aboard and of the capacity
constexpr float kLong = 1.0F / 1000.0F;     // factor of long times [1/steps]
constexpr float kShort = 1.0F / 100.0F;     // factor of short times [1/steps]
constexpr std::int32_t kNear = 8;           // steps summed in `route_risk_near`
constexpr float kTwoRoutes = 0.5F;          // factor of the length of two successive routes
constexpr float kEnergyMoves = 100.0F;      // straight moves after which `energy_used` is 1
constexpr std::int32_t kSide = 2 * kTokenWindow + 1;

using TokenTargets =
    TargetsOf<static_cast<std::size_t>(kTokenDevices), static_cast<std::size_t>(kTokenPorts)>;

float Length(float cells) {
  return std::min(kFarthest, std::max(-kFarthest, cells / kTokenLength));
}

float Unit(float value) { return std::min(1.0F, std::max(-1.0F, value)); }

float* WritePlace(Cell from, Cell to, float* out) {
  *out++ = Length(static_cast<float>(to.x - from.x));
  *out++ = Length(static_cast<float>(to.y - from.y));
  return out;
}

// Uses the view's scenario instead of FeatureScales::time: one encoder serves all ranches of a
// family, and their episodes differ in length.
float StepsLeft(const View& view) {
  return std::max(0.0F, HorizonOf(*view.scenario) - static_cast<float>(view.step));
}

// --- ship ----------------------------------------------------------------------------------------

std::vector<std::string> ShipNames() {
  std::vector<std::string> names{"time_left", "time_left_short", "free_capacity", "aboard",
                                 "risk_here"};
  const auto moves = [&names](const std::string& what) {
    for (int move = 0; move < kMoveCount; ++move) {
      names.push_back(what + std::string(ToString(static_cast<Action>(move))));
    }
  };
  moves("blocked.");
  names.insert(names.end(), {"capacity", "move_cost", "energy_used", "exposure"});
  moves("risk.");
  moves("course.");
  names.emplace_back("course.stay");
  for (const char* what : {"near_blocked", "near_risk"}) {
    for (std::int32_t y = -kTokenWindow; y <= kTokenWindow; ++y) {
      for (std::int32_t x = -kTokenWindow; x <= kTokenWindow; ++x) {
        names.push_back(std::string(what) + '.' + std::to_string(x) + '.' + std::to_string(y));
      }
    }
  }
  return names;
}

// Writes the reward that a straight move costs and the energy consumed in the episode. Both are 0
// unless energy is part of the reward.
float* WriteMoveEnergy(const View& view, float* out) {
  std::fill_n(out, 2, 0.0F);
  const Scenario& scenario = *view.scenario;
  if (!scenario.energy || scenario.energy->weight <= 0.0) return out + 2;
  const EnergyFigures& figures = scenario.energy->ships;
  const double km = scenario.cell_size_m / 1000.0;
  out[0] =
      Unit(static_cast<float>(scenario.energy->weight * EnergyOf(figures, km, view.aboard, 0.0F)));
  const double each = EnergyOf(figures, km, 0, 0.0F);
  if (each > 0.0) {
    out[1] = std::min(kFarthest, static_cast<float>(view.energy / each) / kEnergyMoves);
  }
  return out + 2;
}

bool IsBlocked(const View& view, Cell cell) {
  const Scenario& scenario = *view.scenario;
  const bool on_map =
      cell.x >= 0 && cell.y >= 0 && cell.x < scenario.width && cell.y < scenario.height;
  return !on_map || (view.layout->bits(cell) & kBlockedBits) != 0;
}

// Writes which cells of the window around the ship are blocked, and the risk in each open cell at
// the earliest step at which the ship could be there.
float* WriteWindow(const View& view, const TokenRisk& risk, float* out) {
  constexpr std::int32_t kCells = kSide * kSide;
  std::fill_n(out + kCells, kCells, 0.0F);
  for (std::int32_t y = -kTokenWindow; y <= kTokenWindow; ++y) {
    for (std::int32_t x = -kTokenWindow; x <= kTokenWindow; ++x, ++out) {
      const Cell cell{view.self.x + x, view.self.y + y};
      const bool is_blocked = IsBlocked(view, cell);
      *out = is_blocked ? 1.0F : 0.0F;
      if (is_blocked || risk.is_calm()) continue;
      out[kCells] = risk.At(cell, static_cast<float>(std::max(std::abs(x), std::abs(y))));
    }
  }
  return out + kCells;
}

void WriteShip(const FeatureScales&, const View& view, float* out) {
  const TokenRisk risk(view);
  const float left = StepsLeft(view);
  *out++ = std::min(1.0F, left * kLong);
  *out++ = std::min(1.0F, left * kShort);
  *out++ = static_cast<float>(view.capacity - view.aboard) / static_cast<float>(view.capacity);
  *out++ = static_cast<float>(view.aboard) * kCountScale;
  *out++ = risk.At(view.self, 0.0F);
  for (const Cell move : kMoves) {
    *out++ = IsBlocked(view, {view.self.x + move.x, view.self.y + move.y}) ? 1.0F : 0.0F;
  }
  *out++ = static_cast<float>(view.capacity) * kCountScale;
  out = WriteMoveEnergy(view, out);
  *out++ = Unit(view.scenario->damage.exposure_damage * -kWorstRisk);
  LookaheadRisks courses(*view.scenario, view.self);
  for (std::size_t i = 0; i < risk.count(); ++i) {
    courses.MaxWith(risk.disaster(i).belief, static_cast<float>(risk.disaster(i).age));
  }
  courses.Write(out, out + kMoveCount);  // 0 or negative
  std::transform(out, out + kMoveCount + kCourseCount, out,
                 [](float value) { return 0.0F - value; });
  WriteWindow(view, risk, out + kMoveCount + kCourseCount);
}

// --- devices and ports ---------------------------------------------------------------------------

std::vector<std::string> TargetNames() {
  std::vector<std::string> names{"valid", "east", "north", "here"};
  for (int move = 0; move < kMoveCount; ++move) {
    names.push_back("next." + std::string(ToString(static_cast<Action>(move))));
  }
  names.insert(names.end(), {"distance", "close", "route_risk_near", "route_risk", "arrival_risk",
                             "risk_now", "rings_in", "rings_out", "has_space", "has_cargo"});
  return names;
}

// Writes the risk summed over the first kNear steps of a route, and over its first kTokenRoute
// steps. Both sums are divided by kNear. Then writes the risk at the end of the route on arrival.
float* WriteRouteRisk(const View& view, const TokenRisk& risk, std::size_t route, Cell target,
                      std::int32_t steps, float* out) {
  float near = 0.0F;
  float sum = 0.0F;
  Cell cell = view.self;
  const std::int32_t walked = steps < kUnreachable ? std::min(steps, kTokenRoute) : 0;
  if (!risk.IsCalmWithin(cell, walked)) {
    for (std::int32_t step = 1; step <= walked; ++step) {
      const RouteEntry& entry = RoutesFrom(view, cell)[route];
      cell = {cell.x + entry.east, cell.y + entry.north};
      sum += risk.At(cell, static_cast<float>(step));
      if (step <= kNear) near = sum;
    }
  }
  *out++ = near / static_cast<float>(kNear);
  *out++ = std::min(kFarthest, sum / static_cast<float>(kNear));
  *out++ = steps < kUnreachable ? risk.At(target, static_cast<float>(steps)) : 0.0F;
  return out;
}

// Writes the features that devices and ports have in common.
// @param route index of the target in RoutesFrom
// @param steps length of the route from the ship
float* WriteTarget(const View& view, const TokenRisk& risk, std::size_t route, Cell target,
                   std::int32_t steps, bool is_aboard, float* out) {
  *out++ = 1.0F;
  out = WritePlace(view.self, target, out);
  *out++ = steps == 0 && !is_aboard ? 1.0F : 0.0F;
  std::fill_n(out, kMoveCount, 0.0F);
  if (steps > 0 && steps < kUnreachable) {
    const RouteEntry& entry = RoutesFrom(view, view.self)[route];
    for (std::size_t move = 0; move < kMoves.size(); ++move) {
      if (kMoves[move].x == entry.east && kMoves[move].y == entry.north) out[move] = 1.0F;
    }
  }
  out += kMoveCount;
  const auto distance = static_cast<float>(steps);
  *out++ = Length(distance);
  *out++ = steps < kUnreachable ? kCloseSteps / (kCloseSteps + distance) : 0.0F;
  out = WriteRouteRisk(view, risk, route, target, steps, out);
  *out++ = risk.At(target, 0.0F);
  const RingTimes rings = risk.RingsAt(target);
  *out++ = rings.in < 0.0F ? 0.0F : kRingSteps / (kRingSteps + rings.in);
  *out++ = rings.out < 0.0F ? 0.0F : kRingSteps / (kRingSteps + rings.out);
  *out++ = view.aboard < view.capacity ? 1.0F : 0.0F;
  *out++ = view.aboard > 0 ? 1.0F : 0.0F;
  return out;
}

std::vector<std::string> PortNames() {
  std::vector<std::string> names = TargetNames();
  names.emplace_back("onward");
  return names;
}

std::vector<std::string> DeviceNames() {
  std::vector<std::string> names = TargetNames();
  names.insert(names.end(), {"deployed", "aboard", "value", "health", "worth", "loss",
                             "port_distance", "slack", "onward_device", "onward_port"});
  for (int kind = 0; kind < kDeviceKindCount; ++kind) {
    names.emplace_back(ToString(static_cast<DeviceKind>(kind)));
  }
  return names;
}

// Returns the decrease of a device's health times value in the present step [reward].
float LossOf(const View& view, const TokenRisk& risk, const KnownDevice& device) {
  const DamageSpec& damage = view.scenario->damage;
  if (damage.exposure_damage == 0.0F) return 0.0F;
  const auto& factors = damage.FactorsOf(device.kind);
  float worst = view.scenario->SeaRiskAt(device.cell);
  for (std::size_t i = 0; i < risk.count(); ++i) {
    const ObservableDisaster& belief = risk.disaster(i).belief;
    worst = std::min(worst, RiskOf(belief, static_cast<float>(device.cell.x),
                                   static_cast<float>(device.cell.y)) *
                                factors[static_cast<std::size_t>(belief.kind)]);
  }
  return -worst * damage.exposure_damage * device.value;
}

float* WriteDevice(const View& view, const TokenRisk& risk, const TokenTargets& targets,
                   std::size_t slot, float* out) {
  const KnownDevice& device = view.devices[targets.device(slot)];
  const std::size_t route = targets.route(slot);
  const bool is_deployed = device.status == DeviceStatus::kDeployed;
  const std::int32_t steps = is_deployed ? RoutesFrom(view, view.self)[route].steps : 0;
  out = WriteTarget(view, risk, route, device.cell, steps, !is_deployed, out);
  *out++ = is_deployed ? 1.0F : 0.0F;
  *out++ = device.aboard_self ? 1.0F : 0.0F;
  *out++ = device.value * kValueScale;
  *out++ = device.health;
  *out++ = device.health * device.value * kValueScale;
  *out++ = std::min(kFarthest, LossOf(view, risk, device));
  std::int32_t home = kUnreachable;
  const RouteEntry* const routes = RoutesFrom(view, device.cell);
  for (std::size_t port = 0; port < view.layout->ports.size(); ++port) {
    home = std::min(home, routes[port].steps);
  }
  *out++ = Length(static_cast<float>(home));
  constexpr float kActions = 2.0F;  // pickup and drop-off
  *out++ = Unit(
      (StepsLeft(view) - static_cast<float>(steps) - static_cast<float>(home) - kActions) * kShort);
  *out++ = Length(static_cast<float>(targets.ToNextDevice(slot)));
  *out++ = Length(kTwoRoutes * static_cast<float>(targets.ToNextDeviceByPort(slot)));
  std::fill_n(out, kDeviceKindCount, 0.0F);
  out[static_cast<std::size_t>(device.kind)] = 1.0F;
  return out + kDeviceKindCount;
}

void WriteDeviceTokens(const FeatureScales&, const View& view, float* out) {
  const TokenRisk risk(view);
  const TokenTargets targets(view);
  float* const end = out + kTokenDevices * TokenGroups()[1].size;
  for (std::size_t slot = 0; slot < targets.devices(); ++slot) {
    out = WriteDevice(view, risk, targets, slot, out);
  }
  std::fill(out, end, 0.0F);
}

void WritePortTokens(const FeatureScales&, const View& view, float* out) {
  const TokenRisk risk(view);
  const TokenTargets targets(view);
  const RouteEntry* const routes = RoutesFrom(view, view.self);
  float* const end = out + kTokenPorts * TokenGroups()[2].size;
  for (std::size_t slot = 0; slot < targets.ports(); ++slot) {
    const std::size_t id = targets.port(slot);
    out = WriteTarget(view, risk, id, view.layout->ports[id], routes[id].steps, false, out);
    *out++ = Length(static_cast<float>(targets.FromPort(slot)));
  }
  std::fill(out, end, 0.0F);
}

// --- disasters and other ships -------------------------------------------------------------------

std::vector<std::string> DisasterNames() {
  std::vector<std::string> names{"valid",        "east",  "north",    "motion_east",
                                 "motion_north", "gap",   "rings_in", "rings_out",
                                 "age",          "grade", "growth",   "time_left"};
  for (int ring = 0; ring < kMaxRings; ++ring) {
    names.push_back("radius" + std::to_string(ring));
    names.push_back("risk" + std::to_string(ring));
  }
  for (int kind = 0; kind < kDisasterKindCount; ++kind) {
    names.emplace_back(ToString(static_cast<DisasterKind>(kind)));
  }
  return names;
}

// Returns the distance from the ship to the edge of a disaster [cells]; negative inside.
float GapTo(const View& view, const ObservableDisaster& belief) {
  const float east = belief.x - static_cast<float>(view.self.x);
  const float north = belief.y - static_cast<float>(view.self.y);
  return std::sqrt(east * east + north * north) - belief.reach();
}

float* WriteDisaster(const View& view, const KnownDisaster& known, float* out) {
  const ObservableDisaster& belief = known.belief;
  const auto period = static_cast<float>(std::max(1, view.scenario->view.bulletin_period));
  const RingTimes rings = TokenRisk::TimesOf(known, view.self);
  *out++ = 1.0F;
  *out++ = Length(belief.x - static_cast<float>(view.self.x));
  *out++ = Length(belief.y - static_cast<float>(view.self.y));
  *out++ = std::max(-kFarthest, std::min(kFarthest, belief.dx));
  *out++ = std::max(-kFarthest, std::min(kFarthest, belief.dy));
  *out++ = Length(GapTo(view, belief));
  *out++ = rings.in < 0.0F ? 0.0F : kRingSteps / (kRingSteps + rings.in);
  *out++ = rings.out < 0.0F ? 0.0F : kRingSteps / (kRingSteps + rings.out);
  *out++ = std::min(kFarthest, static_cast<float>(known.age) / period);
  *out++ = static_cast<float>(belief.grade) / 4.0F;
  *out++ = Unit(belief.radius_growth);
  *out++ = std::min(1.0F, static_cast<float>(belief.steps_left) * kLong);
  for (std::int32_t ring = 0; ring < kMaxRings; ++ring) {
    const auto k = static_cast<std::size_t>(ring);
    const bool has_ring = ring < belief.rings && belief.radius[k] > 0.0F;
    *out++ = has_ring ? Length(belief.radius[k]) : 0.0F;
    *out++ = has_ring ? -belief.risk[k] * kRiskScale : 0.0F;
  }
  std::fill_n(out, kDisasterKindCount, 0.0F);
  out[static_cast<std::size_t>(belief.kind)] = 1.0F;
  return out + kDisasterKindCount;
}

void WriteDisasterTokens(const FeatureScales&, const View& view, float* out) {
  Kept<kTokenDisasters> kept;
  for (std::size_t id = 0; id < view.disasters.size(); ++id) {
    const KnownDisaster& known = view.disasters[id];
    if (!known.known || !known.belief.active()) continue;
    kept.Add(static_cast<std::int32_t>(id), GapTo(view, known.belief));
  }
  float* const end = out + kTokenDisasters * TokenGroups()[3].size;
  for (std::size_t slot = 0; slot < kept.size(); ++slot) {
    out = WriteDisaster(view, view.disasters[kept[slot]], out);
  }
  std::fill(out, end, 0.0F);
}

void WriteOtherTokens(const FeatureScales&, const View& view, float* out) {
  Kept<kTokenOthers> kept;
  for (std::size_t i = 0; i < view.others.size(); ++i) {
    const Cell cell = view.others[i].cell;
    if (!view.others[i].visible) continue;
    const std::int32_t away =
        std::max(std::abs(cell.x - view.self.x), std::abs(cell.y - view.self.y));
    kept.Add(static_cast<std::int32_t>(i), static_cast<float>(away));
  }
  float* const end = out + kTokenOthers * TokenGroups()[4].size;
  for (std::size_t slot = 0; slot < kept.size(); ++slot) {
    const KnownShip& other = view.others[kept[slot]];
    *out++ = 1.0F;
    out = WritePlace(view.self, other.cell, out);
    *out++ = static_cast<float>(other.aboard) * kCountScale;
  }
  std::fill(out, end, 0.0F);
}

std::vector<std::string> InSlots(const std::string& what, std::int32_t slots,
                                 const std::vector<std::string>& parts) {
  std::vector<std::string> names;
  for (std::int32_t slot = 0; slot < slots; ++slot) {
    const std::string here = what + (slots == 1 ? "" : std::to_string(slot)) + '.';
    for (const std::string& part : parts) names.push_back(here + part);
  }
  return names;
}

}  // namespace

std::vector<FeatureGroup> TokenFeatureGroups() {
  return {{"ship", InSlots("ship", 1, ShipNames()), WriteShip},
          {"devices", InSlots("device", kTokenDevices, DeviceNames()), WriteDeviceTokens},
          {"ports", InSlots("port", kTokenPorts, PortNames()), WritePortTokens},
          {"disasters", InSlots("disaster", kTokenDisasters, DisasterNames()), WriteDisasterTokens},
          {"others", InSlots("other", kTokenOthers, {"valid", "east", "north", "aboard"}),
           WriteOtherTokens}};
}

const std::array<TokenGroup, kTokenGroupCount>& TokenGroups() {
  static const std::array<TokenGroup, kTokenGroupCount> groups = [] {
    constexpr std::array<std::int32_t, kTokenGroupCount> kSlots{1, kTokenDevices, kTokenPorts,
                                                                kTokenDisasters, kTokenOthers};
    std::array<TokenGroup, kTokenGroupCount> made{};
    std::int32_t begin = 0;
    const std::vector<FeatureGroup> features = TokenFeatureGroups();
    for (std::size_t i = 0; i < kTokenGroupCount; ++i) {
      const auto count = static_cast<std::int32_t>(features[i].names.size());
      made[i] = {begin, kSlots[i], count / kSlots[i]};
      begin += count;
    }
    return made;
  }();
  return groups;
}

const std::vector<std::string>& TokenNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const FeatureGroup& group : TokenFeatureGroups()) {
      all.insert(all.end(), group.names.begin(), group.names.end());
    }
    return all;
  }();
  return names;
}

}  // namespace aquafarm
