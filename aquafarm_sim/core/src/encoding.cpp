// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/encoding.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "aquafarm/check.h"
#include "aquafarm/forecast.h"

namespace aquafarm {
namespace {

constexpr std::int32_t kSelfFeatures = Encoder::kFirstBlockedFeature;
constexpr std::int32_t kDeviceFeatures = 5;
constexpr std::int32_t kPortFeatures = 2;
constexpr std::int32_t kDisasterFeatures = 7;
constexpr std::int32_t kShipFeatures = 4;
constexpr std::int32_t kWayFeatures = 3;
constexpr std::int32_t kCourseFeatures = 2 * kMoveCount + 1;
constexpr std::int32_t kCourseSteps = 6;  // as far as a course is looked along
// Scales: devices' highest paper value, the worst risk of §2.1.
constexpr float kValueScale = 1.0F / 100.0F;
constexpr float kRiskScale = 1.0F / 20.0F;

// The painted planes come first, so that a run past a plane's end stays inside the buffer.
enum Plane : std::size_t { kRisk, kForecast, kObstacle, kPort, kDevice, kSelf, kCargo, kOthers };

std::uint8_t ToByte(float part) {
  return static_cast<std::uint8_t>(std::min(std::max(part, 0.0F), 1.0F) * 255.0F + 0.5F);
}

// A device's digit in a status code: deployed, aboard the ship, or gone.
std::int32_t Standing(DeviceStatus status, bool aboard_self) {
  if (status == DeviceStatus::kDeployed) return 0;
  return aboard_self ? 1 : 2;
}

// Which of several agents it is, so that one network can play all of them. Alone, none is needed.
std::int32_t IdentityFeatures(const Scenario& scenario) {
  return scenario.AgentCount() > 1 ? scenario.AgentCount() : 0;
}

// The part of an episode's time that is left.
float TimeLeft(const View& view) {
  std::int32_t horizon = 0;
  for (const DisasterSpec& disaster : view.scenario->disasters) {
    horizon = std::max(horizon, disaster.duration);
  }
  horizon = horizon == 0 ? view.scenario->step_limit : std::min(horizon, view.scenario->step_limit);
  return 1.0F - static_cast<float>(view.step) / static_cast<float>(horizon);
}

// The moves' courses and, last, staying.
constexpr std::size_t kCourseCount = kMoveCount + 1;
constexpr std::size_t kCourseCells = kCourseCount * kCourseSteps;
using CourseFloats = std::array<float, kCourseCells>;

/// Where the courses lead, seen from the ship, and when: all courses' first step, then the second.
struct CourseTable {
  CourseFloats x{};
  CourseFloats y{};
  CourseFloats steps{};
};

constexpr CourseTable MakeCourses() {
  CourseTable table;
  for (std::size_t i = 0; i < kCourseCells; ++i) {
    const std::size_t course = i % kCourseCount;
    const Cell move = course < kMoves.size() ? kMoves[course] : Cell{};
    const auto steps = static_cast<std::int32_t>(i / kCourseCount + 1);
    table.x[i] = static_cast<float>(steps * move.x);
    table.y[i] = static_cast<float>(steps * move.y);
    table.steps[i] = static_cast<float>(steps);
  }
  return table;
}

constexpr CourseTable kCourses = MakeCourses();

// Worsens the risk of each cell of the courses to that of a disaster that holds its motion; as
// RiskOf, but a ring for all cells at once, which the compiler makes vectors of.
void WorsenCourses(const KnownDisaster& known, const CourseFloats& x, const CourseFloats& y,
                   CourseFloats& risk) {
  const Disaster& disaster = known.belief;
  const auto age = static_cast<float>(known.age);
  CourseFloats west;
  CourseFloats south;
  CourseFloats distance_squared;
  for (std::size_t i = 0; i < kCourseCells; ++i) {
    const float ahead = age + kCourses.steps[i];
    west[i] = disaster.x - (x[i] - ahead * disaster.dx);
    south[i] = disaster.y - (y[i] - ahead * disaster.dy);
    distance_squared[i] = west[i] * west[i] + south[i] * south[i];
  }
  CourseFloats there{};
  if (disaster.by_quadrant) {
    for (std::size_t i = 0; i < kCourseCells; ++i) {
      there[i] = RiskByQuadrant(disaster, west[i], south[i], distance_squared[i]);
    }
  } else {
    // From the outermost: of the rings that hold a cell the innermost counts.
    for (auto k = static_cast<std::size_t>(disaster.rings); k-- > 0;) {
      for (std::size_t i = 0; i < kCourseCells; ++i) {
        there[i] = distance_squared[i] <= disaster.radius_squared[k] ? disaster.risk[k] : there[i];
      }
    }
  }
  for (std::size_t i = 0; i < kCourseCells; ++i) risk[i] = std::min(risk[i], there[i]);
}

// The cells [x0, x1) × [y0, y1) that a disaster may reach.
struct Box {
  std::int32_t x0, x1, y0, y1;
};

Box ReachedBox(float cx, float cy, float reach, std::int32_t width, std::int32_t height) {
  const auto clamp = [](float value, std::int32_t limit) {
    return static_cast<std::int32_t>(std::min(std::max(value, 0.0F), static_cast<float>(limit)));
  };
  return {clamp(cx - reach, width), clamp(cx + reach + 1.0F, width), clamp(cy - reach, height),
          clamp(cy + reach + 1.0F, height)};
}

// Columns painted at once. A row's last run may pass its end, and so the plane's, by less than
// this; cells there get level 0, which leaves them as they are.
constexpr std::int32_t kRun = 16;

// Runs as vectors of GCC and Clang, which each target below turns into its widest registers.
using FloatRun = float __attribute__((vector_size(kRun * sizeof(float))));
using IntRun = std::int32_t __attribute__((vector_size(kRun * sizeof(std::int32_t))));
using ByteRun = std::uint8_t __attribute__((vector_size(kRun)));

// Paints a disaster's footprint, the worse kept where one lies already: per cell the same float
// comparisons as RiskOf.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
__attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#endif
void PaintRings(float cx, float cy, const float* ring_squared, const std::int32_t* levels, Box box,
                std::int32_t width, std::uint8_t* plane) {
  for (std::int32_t x0 = box.x0; x0 < box.x1; x0 += kRun) {
    FloatRun dx_squared;
    for (std::int32_t i = 0; i < kRun; ++i) {
      const float dx = cx - static_cast<float>(x0 + i);
      dx_squared[i] = x0 + i < width ? dx * dx : std::numeric_limits<float>::infinity();
    }
    for (std::int32_t y = box.y0; y < box.y1; ++y) {
      const float dy = cy - static_cast<float>(y);
      const FloatRun distance_squared = dx_squared + dy * dy;
      IntRun level = {};
      for (std::int32_t k = kMaxRings; k-- > 0;) {
        level = distance_squared <= ring_squared[k] ? IntRun{} + levels[k] : level;
      }
      const ByteRun painted = __builtin_convertvector(level, ByteRun);
      std::uint8_t* const row = plane + static_cast<std::ptrdiff_t>(y) * width + x0;
      ByteRun present;
      std::memcpy(&present, row, sizeof(present));
      present = painted > present ? painted : present;
      std::memcpy(row, &present, sizeof(present));
    }
  }
}

// The same for rings by quadrants, cell by cell.
void PaintQuadrants(const Disaster& disaster, float cx, float cy, Box box, std::int32_t width,
                    std::uint8_t* plane) {
  Disaster there = disaster;
  there.x = cx;
  there.y = cy;
  for (std::int32_t y = box.y0; y < box.y1; ++y) {
    for (std::int32_t x = box.x0; x < box.x1; ++x) {
      std::uint8_t& cell = plane[y * width + x];
      const float risk = RiskOf(there, static_cast<float>(x), static_cast<float>(y));
      cell = std::max(cell, ToByte(-risk * kRiskScale));
    }
  }
}

// Paints a disaster `ahead` steps along its present heading.
void PaintDisaster(const Disaster& disaster, float ahead, std::int32_t width, std::int32_t height,
                   std::uint8_t* plane) {
  if (!disaster.active() || disaster.rings == 0) return;
  const float cx = disaster.x + ahead * disaster.dx;
  const float cy = disaster.y + ahead * disaster.dy;
  const Box box = ReachedBox(cx, cy, disaster.reach(), width, height);
  if (box.x0 >= box.x1 || box.y0 >= box.y1) return;
  if (disaster.by_quadrant) return PaintQuadrants(disaster, cx, cy, box, width, plane);
  std::array<float, kMaxRings> ring_squared;
  std::array<std::int32_t, kMaxRings> levels{};
  ring_squared.fill(-1.0F);
  for (std::size_t k = 0; k < static_cast<std::size_t>(disaster.rings); ++k) {
    ring_squared[k] = disaster.radius_squared[k];
    levels[k] = ToByte(-disaster.risk[k] * kRiskScale);
  }
  PaintRings(cx, cy, ring_squared.data(), levels.data(), box, width, plane);
}

}  // namespace

Encoder::Encoder(const Scenario& scenario) : scenario_(scenario) {
  const std::int32_t devices = scenario.devices.Total();
  fetchable_ = scenario.FetchableCount();
  scale_ = 1.0F / static_cast<float>(std::max(scenario.width, scenario.height));
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

  // Base-3 codes grow as 3^D: beyond this many devices no table would fit anyway.
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
  const auto east = [&](Cell cell) { return static_cast<float>(cell.x - view.self.x) * scale_; };
  const auto north = [&](Cell cell) { return static_cast<float>(cell.y - view.self.y) * scale_; };
  *out++ = 2.0F * static_cast<float>(view.self.x) * scale_ - 1.0F;
  *out++ = 2.0F * static_cast<float>(view.self.y) * scale_ - 1.0F;
  *out++ = TimeLeft(view);
  *out++ = static_cast<float>(view.capacity - view.aboard) / static_cast<float>(view.capacity);
  *out++ = KnownRiskAt(view, view.self) * kRiskScale;
  for (const Cell move : kMoves) {
    const Cell to{view.self.x + move.x, view.self.y + move.y};
    const bool off =
        static_cast<std::uint32_t>(to.x) >= static_cast<std::uint32_t>(scenario_.width) ||
        static_cast<std::uint32_t>(to.y) >= static_cast<std::uint32_t>(scenario_.height);
    *out++ = off || (layout.bits(to) & kBlockedBits) != 0 ? 1.0F : 0.0F;
  }
  for (const KnownDevice& device : view.devices) {
    *out++ = east(device.cell);
    *out++ = north(device.cell);
    *out++ = device.status == DeviceStatus::kDeployed ? 1.0F : 0.0F;
    *out++ = device.aboard_self ? 1.0F : 0.0F;
    *out++ = device.health * device.value * kValueScale;
  }
  for (const Cell port : layout.ports) {
    *out++ = east(port);
    *out++ = north(port);
  }
  for (std::size_t id = 0; id < scenario_.disasters.size(); ++id) {
    const KnownDisaster& known = view.disasters[id];
    if (!known.known || !known.belief.active()) {
      out = std::fill_n(out, kDisasterFeatures, 0.0F);
      continue;
    }
    const Disaster& disaster = known.belief;
    *out++ = 1.0F;
    *out++ = (disaster.x - static_cast<float>(view.self.x)) * scale_;
    *out++ = (disaster.y - static_cast<float>(view.self.y)) * scale_;
    *out++ = disaster.dx;
    *out++ = disaster.dy;
    *out++ = disaster.reach() * scale_;
    *out++ = known.age == 0 ? 0.0F
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

// The risk forecast after one step of each move, and on average over the steps of a course that
// holds on, or of a ship that stays; the map's edge stops a ship.
void Encoder::Courses(const View& view, float* out) const {
  CourseFloats x;
  CourseFloats y;
  const auto east = static_cast<float>(scenario_.width - 1);
  const auto north = static_cast<float>(scenario_.height - 1);
  const auto self_x = static_cast<float>(view.self.x);
  const auto self_y = static_cast<float>(view.self.y);
  for (std::size_t i = 0; i < kCourseCells; ++i) {
    x[i] = std::min(std::max(self_x + kCourses.x[i], 0.0F), east);
    y[i] = std::min(std::max(self_y + kCourses.y[i], 0.0F), north);
  }
  CourseFloats risk{};
  if (scenario_.seas && !scenario_.seas->risk.empty()) {
    for (std::size_t i = 0; i < kCourseCells; ++i) {
      risk[i] =
          scenario_.SeaRiskAt({static_cast<std::int32_t>(x[i]), static_cast<std::int32_t>(y[i])});
    }
  }
  for (const KnownDisaster& known : view.disasters) {
    if (known.known && known.belief.active()) WorsenCourses(known, x, y, risk);
  }
  for (float& one : risk) one *= kRiskScale;
  out = std::copy_n(risk.data(), kMoveCount, out);
  for (std::size_t course = 0; course < kCourseCount; ++course) {
    float sum = 0.0F;
    for (std::size_t i = course; i < kCourseCells; i += kCourseCount) sum += risk[i];
    *out++ = sum / static_cast<float>(kCourseSteps);
  }
}

// The next move and how many are left to every port, and to every device that still waits.
float* Encoder::Ways(const View& view, float* out) const {
  const Layout& layout = *view.layout;
  const auto cell = static_cast<std::size_t>(LinearIndex(view.self, scenario_.width));
  const Way* way = layout.ways.data() + cell * layout.way_count();
  // Stands for a place that no water leads to as well.
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
    if (!known.known) continue;
    PaintDisaster(known.belief, 0.0F, scenario_.width, scenario_.height, plane(kRisk));
    PaintDisaster(known.belief, static_cast<float>(known.age + kForecastSteps), scenario_.width,
                  scenario_.height, plane(kForecast));
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
