// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/observation/features.h"

#include <algorithm>
#include <array>
#include <initializer_list>

#include "aquafarm/farm/energy.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/observation/disaster_slots.h"
#include "aquafarm/observation/tokens.h"
#include "observation/risk_raster.h"

namespace aquafarm {
namespace {

constexpr std::int32_t kWayFeatures = 3;
constexpr float kGradeScale = 1.0F / 4.0F;  // 1 / worst grade

// Returns THING0.PART, THING0.OTHER, THING1.PART, … for `count` things.
std::vector<std::string> Numbered(const std::string& thing, std::int32_t count,
                                  std::initializer_list<const char*> parts) {
  std::vector<std::string> names;
  for (std::int32_t id = 0; id < count; ++id) {
    for (const char* part : parts) names.push_back(thing + std::to_string(id) + '.' + part);
  }
  return names;
}

std::vector<std::string> ForEachMove(const std::string& what) {
  std::vector<std::string> names;
  names.reserve(kMoveCount);
  for (int move = 0; move < kMoveCount; ++move) {
    names.push_back(what + std::string(ToString(static_cast<Action>(move))));
  }
  return names;
}

// The writers copy a scale to a local variable before a loop, because `out` might alias the scales.

float* WriteSelf(const FeatureScales& scales, const View& view, float* out) {
  const float scale = scales.length;
  const float horizon = scales.time;
  out[0] = 2.0F * static_cast<float>(view.self.x) * scale - 1.0F;
  out[1] = 2.0F * static_cast<float>(view.self.y) * scale - 1.0F;
  // A disaster that SetDisaster adds may last longer than the horizon.
  out[2] = std::max(0.0F, 1.0F - static_cast<float>(view.step) / horizon);
  out[3] = static_cast<float>(view.capacity - view.aboard) / static_cast<float>(view.capacity);
  out[4] = KnownRiskAt(view, view.self) * kRiskScale;
  return out + 5;
}

// Writes whether each move leads off the map or into a rock or island.
float* WriteBlocked(const View& view, float* out) {
  const std::int32_t width = view.scenario->width;
  const std::int32_t height = view.scenario->height;
  const Cell self = view.self;
  const std::uint8_t* const here = view.layout->cells.data() + LinearIndex(self, width);
  // Branch-free: ships are often at the edge of the map, for example in a port, and a branch would
  // often be mispredicted. A move off the map reads the bits of the ship's own cell.
  const std::array<bool, 3> off_x{self.x == 0, false, self.x == width - 1};
  const std::array<bool, 3> off_y{self.y == 0, false, self.y == height - 1};
  for (const Cell move : kMoves) {
    const bool is_off_x = off_x[static_cast<std::size_t>(move.x + 1)];
    const bool is_off_y = off_y[static_cast<std::size_t>(move.y + 1)];
    const bool off = is_off_x | is_off_y;
    const std::uint8_t bits = here[off ? 0 : LinearIndex(move, width)];
    const bool is_blocked = (bits & kBlockedBits) != 0;
    *out++ = static_cast<float>(off | is_blocked);
  }
  return out;
}

float* WriteDevices(const FeatureScales& scales, const View& view, float* out) {
  const float scale = scales.length;
  for (const KnownDevice& device : view.devices) {
    *out++ = static_cast<float>(device.cell.x - view.self.x) * scale;
    *out++ = static_cast<float>(device.cell.y - view.self.y) * scale;
    *out++ = device.status == DeviceStatus::kDeployed ? 1.0F : 0.0F;
    *out++ = device.aboard_self ? 1.0F : 0.0F;
    *out++ = device.health * device.value * kValueScale;
  }
  return out;
}

void WritePorts(const FeatureScales& scales, const View& view, float* out) {
  const float scale = scales.length;
  for (const Cell port : view.layout->ports) {
    *out++ = static_cast<float>(port.x - view.self.x) * scale;
    *out++ = static_cast<float>(port.y - view.self.y) * scale;
  }
}

// Writes the features that every scenario without entity tokens has. They form one group, because
// each group costs a call through a function pointer.
void WriteBase(const FeatureScales& scales, const View& view, float* out) {
  out = WriteSelf(scales, view, out);
  out = WriteBlocked(view, out);
  WritePorts(scales, view, WriteDevices(scales, view, out));
}

std::vector<std::string> BaseNames(const Scenario& scenario) {
  std::vector<std::string> names{"self.x", "self.y", "time_left", "free_capacity", "risk_here"};
  for (const std::vector<std::string>& more :
       {ForEachMove("blocked."),
        Numbered("device", scenario.devices.Total(),
                 {"east", "north", "deployed", "aboard", "worth"}),
        Numbered("port", scenario.PortCount(), {"east", "north"})}) {
    names.insert(names.end(), more.begin(), more.end());
  }
  return names;
}

// Writes the features of the scenario's disasters, in id order.
void WriteDisasters(const FeatureScales& scales, const View& view, float* out) {
  constexpr std::size_t kCount = 7;
  const float scale = scales.length;
  for (std::size_t id = 0; id < view.scenario->disasters.size(); ++id, out += kCount) {
    const KnownDisaster& known = view.disasters[id];
    if (!known.known || !known.belief.active()) {
      std::fill_n(out, kCount, 0.0F);
      continue;
    }
    const ObservableDisaster& disaster = known.belief;
    out[0] = 1.0F;
    out[1] = (disaster.x - static_cast<float>(view.self.x)) * scale;
    out[2] = (disaster.y - static_cast<float>(view.self.y)) * scale;
    out[3] = disaster.dx;
    out[4] = disaster.dy;
    out[5] = disaster.reach() * scale;
    out[6] = known.age == 0
                 ? 0.0F
                 : static_cast<float>(known.age) /
                       static_cast<float>(std::max(1, view.scenario->view.bulletin_period));
  }
}

// Returns the group of the disaster features: by id, or by slot if the scenario has slots.
FeatureGroup DisasterGroup(const Scenario& scenario) {
  if (SlotCount(scenario) > 0) {
    return {"disasters", SlotNames(scenario),
            [](const FeatureScales& scales, const View& view, float* out) {
              WriteSlots(scales.length, view, out);
            }};
  }
  return {"disasters",
          Numbered("disaster", static_cast<std::int32_t>(scenario.disasters.size()),
                   {"known", "east", "north", "motion_east", "motion_north", "reach", "age"}),
          WriteDisasters};
}

void WriteOthers(const FeatureScales& scales, const View& view, float* out) {
  const float scale = scales.length;
  for (const KnownShip& other : view.others) {
    const bool seen = other.visible;
    *out++ = seen ? 1.0F : 0.0F;
    *out++ = seen ? static_cast<float>(other.cell.x - view.self.x) * scale : 0.0F;
    *out++ = seen ? static_cast<float>(other.cell.y - view.self.y) * scale : 0.0F;
    *out++ = seen ? static_cast<float>(other.aboard) / static_cast<float>(view.capacity) : 0.0F;
  }
}

void WriteIdentity(const FeatureScales&, const View& view, float* out) {
  std::fill_n(out, view.scenario->AgentCount(), 0.0F);
  out[view.ship] = 1.0F;
}

void WriteEnergy(const FeatureScales& scales, const View& view, float* out) {
  out[0] = static_cast<float>(view.energy) * scales.energy;
}

// Writes the next move and the number of remaining moves to each port and each fetchable device.
// For a fetchable device that is not deployed, writes zeros.
void WriteRoutes(const FeatureScales& scales, const View& view, float* out) {
  const float scale = scales.length;
  const Layout& layout = *view.layout;
  const auto cell = static_cast<std::size_t>(LinearIndex(view.self, view.scenario->width));
  const RouteEntry* route = layout.routes.data() + cell * layout.route_count();
  // Larger numbers of moves, and those of unreachable targets, are written as this number.
  const std::int32_t farthest = 2 * (view.scenario->width + view.scenario->height);
  const auto write = [&] {
    *out++ = static_cast<float>(route->east);
    *out++ = static_cast<float>(route->north);
    *out++ = static_cast<float>(std::min(route->steps, farthest)) * scale;
    ++route;
  };
  for (std::size_t port = 0; port < layout.ports.size(); ++port) write();
  for (const KnownDevice& device : view.devices) {
    if (device.self_propelled) continue;
    if (device.status == DeviceStatus::kDeployed) {
      write();
    } else {
      out = std::fill_n(out, kWayFeatures, 0.0F);
      ++route;
    }
  }
}

std::vector<std::string> RouteNames(const Scenario& scenario) {
  std::vector<std::string> names;
  const auto add = [&names](const char* thing, std::int32_t id) {
    for (const char* part : {".way_east", ".way_north", ".way_steps"}) {
      names.push_back(thing + std::to_string(id) + part);
    }
  };
  for (std::int32_t i = 0; i < scenario.PortCount(); ++i) add("port", i);
  for (std::int32_t i = 0; i < scenario.devices.Total(); ++i) {
    const bool fetched = scenario.devices.placement == DevicePlacement::kExplicit
                             ? !scenario.devices.sites[static_cast<std::size_t>(i)].self_propelled
                             : i < scenario.FetchableCount();
    if (fetched) add("device", i);
  }
  return names;
}

// Writes the forecast risk after one step of each move, and the mean forecast risk over the steps
// of each straight course and of staying. A ship stops at the edge of the map.
void WriteLookaheadRisks(const FeatureScales&, const View& view, float* out) {
  LookaheadRisks risks(*view.scenario, view.self);
  for (const KnownDisaster& known : view.disasters) {
    if (known.known && known.belief.active()) {
      risks.MaxWith(known.belief, static_cast<float>(known.age));
    }
  }
  risks.Write(out, out + kMoveCount);
}

std::vector<std::string> LookaheadRiskNames() {
  std::vector<std::string> names = ForEachMove("risk.");
  const std::vector<std::string> courses = ForEachMove("course.");
  names.insert(names.end(), courses.begin(), courses.end());
  names.emplace_back("course.stay");
  return names;
}

// Writes the kinds of the devices and of the known disasters, one-hot, and the disasters' grades.
void WriteKinds(const FeatureScales&, const View& view, float* out) {
  for (const KnownDevice& device : view.devices) {
    std::fill_n(out, kDeviceKindCount, 0.0F);
    out[static_cast<std::size_t>(device.kind)] = 1.0F;
    out += kDeviceKindCount;
  }
  if (SlotCount(*view.scenario) > 0) return;  // the slots contain kinds and grades
  for (std::size_t id = 0; id < view.scenario->disasters.size(); ++id) {
    const KnownDisaster& known = view.disasters[id];
    std::fill_n(out, kDisasterKindCount + 1, 0.0F);
    if (known.known && known.belief.active()) {
      out[static_cast<std::size_t>(known.belief.kind)] = 1.0F;
      out[kDisasterKindCount] = static_cast<float>(known.belief.grade) * kGradeScale;
    }
    out += kDisasterKindCount + 1;
  }
}

std::vector<std::string> KindNames(const Scenario& scenario) {
  std::vector<std::string> names;
  for (std::int32_t id = 0; id < scenario.devices.Total(); ++id) {
    for (int kind = 0; kind < kDeviceKindCount; ++kind) {
      names.push_back("device" + std::to_string(id) + '.' +
                      std::string(ToString(static_cast<DeviceKind>(kind))));
    }
  }
  if (SlotCount(scenario) > 0) return names;
  for (std::size_t id = 0; id < scenario.disasters.size(); ++id) {
    const std::string disaster = "disaster" + std::to_string(id) + '.';
    for (int kind = 0; kind < kDisasterKindCount; ++kind) {
      names.push_back(disaster + std::string(ToString(static_cast<DisasterKind>(kind))));
    }
    names.push_back(disaster + "grade");
  }
  return names;
}

}  // namespace

FeatureScales ScalesOf(const Scenario& scenario) {
  FeatureScales scales{1.0F / static_cast<float>(std::max(scenario.width, scenario.height)),
                       HorizonOf(scenario)};
  if (scenario.energy) {
    const EnergyFigures& figures =
        scenario.ships.count > 0 ? scenario.energy->ships : scenario.energy->self_propelled;
    const double per_step = EnergyOf(figures, scenario.cell_size_m / 1000.0, 0, 0.0F);
    if (per_step > 0.0) scales.energy = 1.0F / (static_cast<float>(per_step) * scales.time);
  }
  return scales;
}

std::vector<FeatureGroup> FeatureGroups(const Scenario& scenario) {
  if (scenario.view.tokens) return TokenFeatureGroups();
  const std::int32_t agents = scenario.AgentCount();
  std::vector<FeatureGroup> groups{
      {"base", BaseNames(scenario), WriteBase},
      DisasterGroup(scenario),
      {"others", Numbered("other", agents - 1, {"visible", "east", "north", "aboard"}),
       WriteOthers},
      // The id lets one network control all agents. A single agent needs no id.
      {"identity", Numbered("agent", agents > 1 ? agents : 0, {"self"}), WriteIdentity}};
  // The energy is a feature only if the reward depends on it.
  const bool costs_energy = scenario.energy && scenario.energy->weight > 0.0;
  if (costs_energy) groups.push_back({"energy", {"energy_used"}, WriteEnergy});
  if (scenario.view.routes) groups.push_back({"routes", RouteNames(scenario), WriteRoutes});
  if (scenario.view.lookahead_risk)
    groups.push_back({"lookahead_risk", LookaheadRiskNames(), WriteLookaheadRisks});
  if (scenario.view.kinds) groups.push_back({"kinds", KindNames(scenario), WriteKinds});
  const auto is_empty = [](const FeatureGroup& group) { return group.names.empty(); };
  groups.erase(std::remove_if(groups.begin(), groups.end(), is_empty), groups.end());
  return groups;
}

}  // namespace aquafarm
