// SPDX-License-Identifier: BSD-3-Clause
#include "scene/outlook.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "aquafarm/tracks/wind_name.h"
#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/base/text.h"
#include "scene/nautical.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DeviceState;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

constexpr std::size_t kMaxOutlookDevices = 1000;  // with more, the outlook is not computed
constexpr int kMaxSteps = 1000;                   // steps ahead
constexpr double kWorse = 0.5;  // a ring counts as worse if its risk is lower by more than this

double LargestRadius(const TrackPoint& storm) {
  double largest = 0.0;
  for (const auto& ring : storm.radii) {
    largest = std::max(largest, *std::max_element(ring.begin(), ring.end()));
  }
  return largest;
}

// The risk at a position and the ring that causes it.
struct RingRisk {
  double risk{};  // 0 outside all rings
  std::size_t ring{};
};

// Returns the quadrant of an offset from the centre: 0: NE, 1: SE, 2: SW, 3: NW. As in the farm
// (see farm/disaster.h), due north is NE, due east SE, due south SW and due west NW.
std::size_t QuadrantOf(double east, double north) {
  if (east >= 0.0 && north > 0.0) return 0;
  if (east > 0.0) return 1;
  if (north < 0.0) return 2;
  return east < 0.0 ? 3 : 0;
}

RingRisk RiskAt(const TrackPoint& storm, double x, double y) {
  const double east = x - storm.x;
  const double north = y - storm.y;
  const std::size_t quadrant = QuadrantOf(east, north);
  RingRisk worst;
  for (std::size_t ring = 0; ring < std::min(storm.radii.size(), storm.risks.size()); ++ring) {
    const double radius = storm.radii[ring][quadrant];
    if (!(radius > 0.0) || std::hypot(east, north) > radius) continue;
    if (storm.risks[ring] < worst.risk) worst = {storm.risks[ring], ring};
  }
  return worst;
}

// Returns the wind of a ring [kn]; 0 if it is not given.
std::int32_t WindOf(const Course& course, std::size_t ring) {
  return ring < course.ring_winds_kt.size() ? course.ring_winds_kt[ring] : 0;
}

// Returns the distance of a point from the part of a ring in one quadrant [cells]; 0 inside.
// @param east, north  the point, seen from the centre of the ring
// @param quadrant     0: NE, 1: SE, 2: SW, 3: NW
double DistanceToQuadrant(double east, double north, std::size_t quadrant, double radius) {
  const double a = quadrant < 2 ? east : -east;
  const double b = quadrant == 0 || quadrant == 3 ? north : -north;
  if (a >= 0.0 && b >= 0.0) return std::max(0.0, std::hypot(a, b) - radius);
  return std::hypot(a - std::clamp(a, 0.0, radius), b - std::clamp(b, 0.0, radius));
}

// Finds the ring of a disaster that is nearest to a device. If it is nearer than `nearest`, it
// replaces `nearest`.
// @param candidate  contains the step, the device and the disaster
void AddMiss(const TrackPoint& storm, const Course& course, const DeviceState& device,
             RingMiss candidate, RingMiss& nearest) {
  for (std::size_t ring = 0; ring < std::min(storm.radii.size(), storm.risks.size()); ++ring) {
    for (std::size_t quadrant = 0; quadrant < 4; ++quadrant) {
      const double radius = storm.radii[ring][quadrant];
      if (!(radius > 0.0) || !(storm.risks[ring] < -kWorse)) continue;
      candidate.cells =
          DistanceToQuadrant(device.x - storm.x, device.y - storm.y, quadrant, radius);
      if (!(candidate.cells < nearest.cells)) continue;
      candidate.risk = storm.risks[ring];
      candidate.wind_kt = WindOf(course, ring);
      nearest = candidate;
    }
  }
}

// Adds one step to the outlook: the rings that cover devices, and the nearest ring to a device.
// Step 0 is now.
void AddStep(const FarmState& state, const std::vector<Course>& courses, int step,
             const std::vector<const DeviceState*>& devices, Outlook& outlook) {
  for (std::size_t i = 0; i < courses.size(); ++i) {
    const auto& disaster = state.disasters[i];
    if (!disaster.known || disaster.steps_left <= step) continue;
    const TrackPoint storm = TrackAt(courses[i].ahead, double(state.step) + step);
    const double reach = LargestRadius(storm);
    for (std::size_t d = 0; d < devices.size(); ++d) {
      const double east = devices[d]->x - storm.x;
      const double north = devices[d]->y - storm.y;
      const double close = reach + outlook.miss.cells;
      if (east * east + north * north > close * close) continue;  // a fast test, usually true
      AddMiss(storm, courses[i], *devices[d], {0.0, double(step), 0.0, devices[d]->id, i, 0},
              outlook.miss);
      DeviceOutlook& device = outlook.devices[d];
      const auto [risk, ring] = RiskAt(storm, devices[d]->x, devices[d]->y);
      if (step == 0) {
        if (risk < device.risk_now) {
          device.risk_now = risk;
          device.disaster_now = i;
          device.wind_now_kt = WindOf(courses[i], ring);
        }
        continue;
      }
      const double worst = device.arrivals.empty() ? device.risk_now : device.arrivals.back().risk;
      if (risk < worst - kWorse) {
        device.arrivals.push_back({double(step), risk, i, WindOf(courses[i], ring)});
      }
    }
  }
}

// Returns when a ring first covers a device [steps from now]; infinite if none does. FirstRisk
// returns the risk in that ring.
double FirstStep(const DeviceOutlook& device) {
  if (device.risk_now < 0.0) return 0.0;
  return device.arrivals.empty() ? std::numeric_limits<double>::infinity()
                                 : device.arrivals.front().steps;
}

double FirstRisk(const DeviceOutlook& device) {
  if (device.risk_now < 0.0 || device.arrivals.empty()) return device.risk_now;
  return device.arrivals.front().risk;
}

// Returns when the next worse ring arrives [steps from now]; infinite if none does.
double NextStep(const DeviceOutlook& device) {
  return device.arrivals.empty() ? std::numeric_limits<double>::infinity()
                                 : device.arrivals.front().steps;
}

bool IsMoreUrgent(const DeviceOutlook& a, const DeviceOutlook& b) {
  if (FirstStep(a) != FirstStep(b)) return FirstStep(a) < FirstStep(b);
  if (FirstRisk(a) != FirstRisk(b)) return FirstRisk(a) < FirstRisk(b);
  if (NextStep(a) != NextStep(b)) return NextStep(a) < NextStep(b);
  return WorstRisk(a) < WorstRisk(b);
}

// Returns whether a ring covers a part of the farm. Quadrants run NE, SE, SW, NW.
bool IsOverFarm(const FarmSpec& spec, const TrackPoint& storm, const std::array<double, 4>& ring) {
  constexpr double kEdge = 0.5;  // from the centre of a cell to its border [cells]
  const double east = spec.width - kEdge;
  const double north = spec.height - kEdge;
  for (std::size_t quadrant = 0; quadrant < 4; ++quadrant) {
    const bool to_east = quadrant < 2;
    const bool to_north = quadrant == 0 || quadrant == 3;
    if (!(ring[quadrant] > 0.0)) continue;
    if (to_east ? storm.x > east : storm.x < -kEdge) continue;
    if (to_north ? storm.y > north : storm.y < -kEdge) continue;
    const double away = std::hypot(std::clamp(storm.x, -kEdge, east) - storm.x,
                                   std::clamp(storm.y, -kEdge, north) - storm.y);
    if (away <= ring[quadrant]) return true;
  }
  return false;
}

bool IsOverFarm(const FarmSpec& spec, const TrackPoint& storm) {
  return std::any_of(storm.radii.begin(), storm.radii.end(),
                     [&](const auto& ring) { return IsOverFarm(spec, storm, ring); });
}

// Returns whether a ring covers the farm: all cells at its edge, and therefore all other cells.
bool CoversFarm(const FarmSpec& spec, const TrackPoint& storm, const std::array<double, 4>& ring) {
  const auto covers = [&](int x, int y) {
    const double east = x - storm.x;
    const double north = y - storm.y;
    const double radius = ring[QuadrantOf(east, north)];
    return radius > 0.0 && std::hypot(east, north) <= radius;
  };
  for (int x = 0; x < spec.width; ++x) {
    if (!covers(x, 0) || !covers(x, spec.height - 1)) return false;
  }
  for (int y = 0; y < spec.height; ++y) {
    if (!covers(0, y) || !covers(spec.width - 1, y)) return false;
  }
  return true;
}

// Returns the ring with the worst risk of those that cover a part of the farm; nullopt if none
// does.
std::optional<std::size_t> WorstOverFarm(const FarmSpec& spec, const TrackPoint& storm) {
  std::optional<std::size_t> worst;
  for (std::size_t i = 0; i < std::min(storm.radii.size(), storm.risks.size()); ++i) {
    if (!IsOverFarm(spec, storm, storm.radii[i])) continue;
    if (!worst || storm.risks[i] < storm.risks[*worst]) worst = i;
  }
  return worst;
}

// Returns whether a leg of a course is so far from the farm that no ring can reach the farm.
bool IsFar(const FarmSpec& spec, const TrackPoint& from, const TrackPoint& to) {
  const TrackPoint nearest = ClosestApproach(spec, {from, to}, from.step);
  const double away =
      std::hypot(nearest.x - (spec.width - 1) / 2.0, nearest.y - (spec.height - 1) / 2.0);
  return away > std::max(LargestRadius(from), LargestRadius(to)) +
                    std::hypot(spec.width, spec.height) / 2.0;
}

}  // namespace

double WorstRisk(const DeviceOutlook& device) {
  return device.arrivals.empty() ? device.risk_now : device.arrivals.back().risk;
}

double WorstRisk(const Outlook& outlook) {
  double worst = 0.0;
  for (const DeviceOutlook& one : outlook.devices) worst = std::min(worst, WorstRisk(one));
  return worst;
}

const char* WindOverFarm(const FarmSpec& spec, const Course& course, const TrackPoint& at) {
  const std::optional<std::size_t> ring = WorstOverFarm(spec, at);
  const std::int32_t wind_kt = ring ? WindOf(course, *ring) : 0;
  return wind_kt > 0 ? aquafarm::WindName(wind_kt) : "";
}

std::string OverFarmText(const FarmSpec& spec, const Course& course) {
  const TrackPoint& now = course.ahead.front();
  const std::optional<std::size_t> ring = WorstOverFarm(spec, now);
  if (!ring) return "";
  const std::string wind = WindOverFarm(spec, course, now);
  return (wind.empty() ? "risk " + Number(now.risks[*ring], 0) : wind) +
         (CoversFarm(spec, now, now.radii[*ring]) ? " over the ranch" : " over part of the ranch");
}

double StepsToFarm(const FarmSpec& spec, const aquafarm_msgs::DisasterState& disaster,
                   const Course& course) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (!disaster.known || disaster.steps_left <= 0) return kNever;
  const Track& ahead = course.ahead;
  const double now = ahead.front().step;
  if (IsOverFarm(spec, ahead.front())) return 0.0;
  for (std::size_t i = 1; i < ahead.size(); ++i) {
    if (IsFar(spec, ahead[i - 1], ahead[i])) continue;
    const Track leg{ahead[i - 1], ahead[i]};
    const auto last = static_cast<std::int64_t>(std::floor(ahead[i].step));
    for (auto step = static_cast<std::int64_t>(std::ceil(ahead[i - 1].step)); step <= last;
         ++step) {
      const auto at = static_cast<double>(step);
      if (at - now >= disaster.steps_left) return kNever;
      if (IsOverFarm(spec, TrackAt(leg, at))) return at - now;
    }
  }
  return kNever;
}

Outlook ComputeOutlook(const FarmSpec& spec, const FarmState& state,
                       const std::vector<Course>& courses) {
  Outlook outlook;
  std::vector<const DeviceState*> devices;
  for (const DeviceState& device : state.devices) {
    if (device.status == DeviceState::DEPLOYED && InGrid(spec, device.x, device.y)) {
      devices.push_back(&device);
      outlook.devices.push_back({device.id, 0.0, 0U, 0, {}});
    }
  }
  for (std::size_t i = 0; i < courses.size(); ++i) {
    const auto& disaster = state.disasters[i];
    outlook.names.push_back(NameNow(disaster, courses[i]));
    outlook.directions.push_back(
        IsCentreInFarm(spec, disaster) ? "" : PointFromFarm(spec, disaster.x, disaster.y));
  }
  outlook.is_known = devices.size() <= kMaxOutlookDevices;
  if (!outlook.is_known) {
    outlook.devices.clear();
    return outlook;
  }
  outlook.miss.cells = std::hypot(spec.width, spec.height);
  int last = 0;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    const auto& disaster = state.disasters[i];
    if (!disaster.known || disaster.steps_left <= 0) continue;
    const bool extrapolated = courses[i].kind == Course::Kind::kExtrapolated;
    outlook.is_extrapolated = outlook.is_extrapolated || extrapolated;
    const double end = courses[i].ahead.back().step - double(state.step);
    const double known = courses[i].known_until - double(state.step);
    if (known < disaster.steps_left) outlook.known_until = std::min(outlook.known_until, known);
    const double wanted = std::min(end, double(disaster.steps_left));
    if (wanted > kMaxSteps) outlook.known_until = std::min(outlook.known_until, double(kMaxSteps));
    last = std::max(last, int(std::min(end, double(kMaxSteps))));
  }
  for (int step = 0; step <= last; ++step) AddStep(state, courses, step, devices, outlook);
  RingMiss& miss = outlook.miss;
  if (!(miss.risk < 0.0)) miss = {};
  if (miss.risk < 0.0 && miss.steps > 0.0) {
    const Course& course = courses[miss.disaster];
    const int computed = int(std::min(course.ahead.back().step - double(state.step), double(last)));
    miss.comes_nearer =
        miss.steps >= computed && state.disasters[miss.disaster].steps_left > computed + 1;
  }
  std::stable_sort(outlook.devices.begin(), outlook.devices.end(), IsMoreUrgent);
  return outlook;
}

bool IsInDanger(const Outlook& outlook) {
  return !outlook.devices.empty() && std::isfinite(FirstStep(outlook.devices.front()));
}

std::size_t CountInDanger(const Outlook& outlook) {
  return static_cast<std::size_t>(
      std::count_if(outlook.devices.begin(), outlook.devices.end(),
                    [](const DeviceOutlook& one) { return std::isfinite(FirstStep(one)); }));
}

}  // namespace aquafarm_viz
