// SPDX-License-Identifier: BSD-3-Clause
#include "scene/outlook.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "aquafarm/tracks/wind_name.h"
#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/base/palette.h"
#include "aquafarm_viz/base/text.h"
#include "aquafarm_viz/scene/labels.h"
#include "scene/nautical.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DeviceState;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

constexpr std::size_t kMaxOutlookDevices = 1000;  // with more, the outlook is not computed
constexpr int kMaxSteps = 1000;                   // steps ahead
constexpr double kWorse = 0.5;  // a risk must be lower by this much to count as another ring

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

RingRisk RiskAt(const TrackPoint& storm, double x, double y) {
  const double east = x - storm.x;
  const double north = y - storm.y;
  const std::size_t quadrant = north >= 0.0 ? (east >= 0.0 ? 0U : 3U) : (east >= 0.0 ? 1U : 2U);
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

// Returns the name of the wind of a ring; empty if it is not given.
const char* NameOf(std::int32_t wind_kt) { return wind_kt > 0 ? aquafarm::WindName(wind_kt) : ""; }

// Adds to the outlook the rings that cover devices in one step. Step 0 is now.
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
      if (east * east + north * north > reach * reach) continue;  // a fast test, usually true
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

// Returns whether a leg of a course is so far from the farm that no ring can cover a part of the
// farm.
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

const char* WindOverFarm(const FarmSpec& spec, const Course& course, const TrackPoint& at) {
  std::int32_t strongest_kt = 0;
  for (std::size_t i = 0; i < std::min(at.radii.size(), course.ring_winds_kt.size()); ++i) {
    if (!IsOverFarm(spec, at, at.radii[i])) continue;
    strongest_kt = std::max(strongest_kt, course.ring_winds_kt[i]);
  }
  return strongest_kt > 0 ? aquafarm::WindName(strongest_kt) : "";
}

std::string RiskOverFarm(const FarmSpec& spec, const Course& course) {
  const TrackPoint& now = course.ahead.front();
  double worst = 0.0;
  for (std::size_t i = 0; i < std::min(now.radii.size(), now.risks.size()); ++i) {
    if (IsOverFarm(spec, now, now.radii[i])) worst = std::min(worst, now.risks[i]);
  }
  return "risk " + Number(worst, 0);
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
    outlook.names.push_back(NameNow(state.disasters[i], courses[i]));
  }
  outlook.is_known = devices.size() <= kMaxOutlookDevices;
  if (!outlook.is_known) {
    outlook.devices.clear();
    return outlook;
  }
  int last = 0;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    const auto& disaster = state.disasters[i];
    if (!disaster.known || disaster.steps_left <= 0) continue;
    const bool extrapolated = courses[i].kind == Course::Kind::kExtrapolated;
    outlook.is_extrapolated = outlook.is_extrapolated || extrapolated;
    const double end = courses[i].ahead.back().step - double(state.step);
    const double known = courses[i].known_until - double(state.step);
    if (known < disaster.steps_left) outlook.known_until = std::min(outlook.known_until, known);
    last = std::max(last, int(std::min(end, double(kMaxSteps))));
  }
  for (int step = 0; step <= last; ++step) AddStep(state, courses, step, devices, outlook);
  std::stable_sort(outlook.devices.begin(), outlook.devices.end(), IsMoreUrgent);
  return outlook;
}

std::string AheadText(const FarmSpec& spec, double steps) {
  if (!(spec.step_duration_s > 0.0)) {
    return Number(steps, 0) + (steps == 1.0 ? " step" : " steps");
  }
  const double hours = steps * spec.step_duration_s / 3600.0;
  if (hours < 1.0) return Number(60.0 * hours, 0) + " min";
  return Number(hours, hours < 10.0 ? 1 : 0) + " h";
}

namespace {

// Returns "risk -10", or the name of the wind, such as "storm", if it is given.
std::string RingText(double risk, std::int32_t wind_kt) {
  return wind_kt > 0 ? aquafarm::WindName(wind_kt) : "risk " + Number(risk, 0);
}

// Returns the labels of the devices for which `applies` is true, by id: "F0", "F0 and F1" or "3
// devices". It must be true for at least one.
std::string Names(const Outlook& outlook,
                  const std::function<bool(const DeviceOutlook& device)>& applies) {
  constexpr std::size_t kMaxNames = 2;
  std::vector<std::int32_t> ids;
  for (const DeviceOutlook& one : outlook.devices) {
    if (applies(one)) ids.push_back(one.id);
  }
  std::sort(ids.begin(), ids.end());
  std::vector<std::string> names;
  names.reserve(ids.size());
  for (const std::int32_t id : ids) names.push_back(DeviceLabel(id));
  return names.size() > kMaxNames    ? std::to_string(names.size()) + " devices"
         : names.size() == kMaxNames ? names[0] + " and " + names[1]
                                     : names[0];
}

// Returns the first arrival at any device in the order `is_before`; null if no ring arrives.
const RingArrival* Extreme(
    const Outlook& outlook,
    const std::function<bool(const RingArrival&, const RingArrival&)>& is_before) {
  const RingArrival* best = nullptr;
  for (const DeviceOutlook& one : outlook.devices) {
    for (const RingArrival& ring : one.arrivals) {
      if (best == nullptr || is_before(ring, *best)) best = &ring;
    }
  }
  return best;
}

// Returns the labels of the devices that the same ring reaches at the same time: "F0 and F1". Times
// are the same if AheadText displays them equally.
std::string WhomText(const FarmSpec& spec, const Outlook& outlook, const RingArrival& ring) {
  return Names(outlook, [&](const DeviceOutlook& one) {
    return std::any_of(one.arrivals.begin(), one.arrivals.end(), [&](const RingArrival& other) {
      return other.disaster == ring.disaster && other.risk == ring.risk &&
             AheadText(spec, other.steps) == AheadText(spec, ring.steps);
    });
  });
}

// Returns "gale in 2 h"; the wind must be given.
std::string NamedArrival(const FarmSpec& spec, const RingArrival& ring) {
  return NameOf(ring.wind_kt) + std::string(" in ") + AheadText(spec, ring.steps);
}

// Returns the local time `steps` steps from now, " (Sun 06:24 UTC+8)" or without its zone; empty if
// that is less than an hour away or if the scenario has no start time.
std::string ClockAhead(const FarmSpec& spec, const FarmState& state, double steps, bool has_zone) {
  if (!spec.has_start_time || steps * spec.step_duration_s < 3600.0) return "";
  const double then_s = double(state.world_time.sec) + steps * spec.step_duration_s;
  const std::string time = LocalTimeText(spec, static_cast<std::time_t>(then_s), "%a %H:%M");
  return " (" + (has_zone ? time : time.substr(0, time.rfind(' '))) + ")";
}

const std::string kInThe = " in the ";  // between a name and its direction, see Headlines

// Shortens "hurricane force in 9 h" to "hurricane in 9 h".
std::string WithoutForce(std::string text) {
  const std::string word = " force";
  const std::size_t at = text.find(word);
  return at == std::string::npos ? text : text.erase(at, word.size());
}

std::string KnownText(const FarmSpec& spec, const Outlook& outlook) {
  if (!std::isfinite(outlook.known_until)) return "";
  return "no known danger to devices until +" + AheadText(spec, outlook.known_until);
}

}  // namespace

bool IsInDanger(const Outlook& outlook) {
  return !outlook.devices.empty() && std::isfinite(FirstStep(outlook.devices.front()));
}

std::size_t CountInDanger(const Outlook& outlook) {
  return static_cast<std::size_t>(
      std::count_if(outlook.devices.begin(), outlook.devices.end(),
                    [](const DeviceOutlook& one) { return std::isfinite(FirstStep(one)); }));
}

std::string OutlookText(const FarmSpec& spec, const FarmState& state, const Outlook& outlook) {
  if (outlook.devices.empty()) {
    return outlook.is_known && !state.devices.empty() ? "no device is deployed" : "";
  }
  const DeviceOutlook& first = outlook.devices.front();
  const bool is_now = first.risk_now < 0.0;
  std::string text;
  std::string whom;  // devices of the previous part
  std::size_t disaster = first.disaster_now;
  if (is_now) {
    whom = Names(outlook, [&first](const DeviceOutlook& one) {
      return one.disaster_now == first.disaster_now && one.risk_now == first.risk_now;
    });
    text = outlook.names[disaster] + ": " + RingText(first.risk_now, first.wind_now_kt) + " over " +
           whom + " now";
  }
  const RingArrival* next =
      Extreme(outlook, [](const auto& a, const auto& b) { return a.steps < b.steps; });
  if (next == nullptr) return is_now ? text : KnownText(spec, outlook);
  const RingArrival* worst = Extreme(outlook, [](const auto& a, const auto& b) {
    return a.risk < b.risk || (a.risk == b.risk && a.steps < b.steps);
  });
  // A part names the disaster and the devices only if they differ from those of the previous part.
  const auto add = [&](const RingArrival& ring, const std::string& when) {
    const std::string these = WhomText(spec, outlook, ring);
    if (text.empty()) {
      text = outlook.names[ring.disaster] + ", " + RingText(ring.risk, ring.wind_kt) +
             ", reaches " + these;
    } else {
      const std::string& name = outlook.names[ring.disaster];
      const bool has_direction = name.find(kInThe) != std::string::npos;
      text += ", " + (ring.disaster == disaster ? "" : name + (has_direction ? ", " : " ")) +
              RingText(ring.risk, ring.wind_kt) + (these == whom ? "" : " reaches " + these);
    }
    text += " in " + when;
    whom = these;
    disaster = ring.disaster;
  };
  const std::string about = outlook.is_extrapolated ? "about " : "";
  const std::string clock = ClockAhead(spec, state, next->steps, /*has_zone=*/true);
  add(*next, about + AheadText(spec, next->steps) + clock);
  if (worst->risk < next->risk) {
    add(*worst, about + AheadText(spec, worst->steps) +
                    ClockAhead(spec, state, worst->steps, /*has_zone=*/clock.empty()));
  }
  return text;
}

std::vector<std::string> Headlines(const FarmSpec& spec, const FarmState& state,
                                   const Outlook& outlook) {
  const std::string brief = ShortOutlookText(spec, outlook);
  if (brief.empty()) return {};
  Outlook directed = outlook;
  for (std::size_t i = 0; i < directed.names.size(); ++i) {
    const auto& disaster = state.disasters[i];
    if (IsCentreInFarm(spec, disaster)) continue;
    directed.names[i] += kInThe + PointFromFarm(spec, disaster.x, disaster.y);
  }
  std::vector<std::string> lines{OutlookText(spec, state, directed),
                                 OutlookText(spec, state, outlook), brief};
  for (std::string& line : lines) {
    line[0] = char(std::toupper(static_cast<unsigned char>(line[0])));
  }
  return lines;
}

std::string ShortOutlookText(const FarmSpec& spec, const Outlook& outlook) {
  if (outlook.devices.empty()) return "";
  if (!IsInDanger(outlook)) return KnownText(spec, outlook);
  const DeviceOutlook& first = outlook.devices.front();
  return DeviceLabel(first.id) + ": " + DangerText(spec, first);
}

std::string DangerText(const FarmSpec& spec, const DeviceOutlook& device) {
  const std::string before = device.risk_now < 0.0 ? NameOf(device.wind_now_kt) : "";
  const std::string after = device.arrivals.empty() ? "" : NameOf(device.arrivals.front().wind_kt);
  // If both rings have the same name, only their risks distinguish them.
  const bool has_names = (device.risk_now == 0.0 || !before.empty()) &&
                         (device.arrivals.empty() || !after.empty()) && before != after;
  if (!has_names) {
    const std::string risk = RiskText(spec, device);
    return risk.empty() ? "" : "risk " + risk;
  }
  const std::string now = before.empty() ? "" : before + " now";
  if (after.empty()) return now;
  const std::string next =
      now + (now.empty() ? "" : ", ") + NamedArrival(spec, device.arrivals.front());
  const RingArrival& worst = device.arrivals.back();
  const std::string last = NameOf(worst.wind_kt);
  return last.empty() || last == after ? next : next + ", " + NamedArrival(spec, worst);
}

std::string WorstText(const FarmSpec& spec, const DeviceOutlook& device) {
  const bool is_named = !device.arrivals.empty() && device.arrivals.back().wind_kt > 0;
  return is_named ? NamedArrival(spec, device.arrivals.back()) : DangerText(spec, device);
}

std::string NowAndWorstText(const FarmSpec& spec, const DeviceOutlook& device) {
  const std::string worst = WorstText(spec, device);
  const bool is_named = device.risk_now < 0.0 && device.wind_now_kt > 0 &&
                        !device.arrivals.empty() && device.arrivals.back().wind_kt > 0;
  return is_named ? NameOf(device.wind_now_kt) + (" now, " + WithoutForce(worst)) : worst;
}

std::string RiskText(const FarmSpec& spec, const DeviceOutlook& device, const char* between) {
  const std::string now = device.risk_now < 0.0 ? Number(device.risk_now, 0) + " now" : "";
  if (device.arrivals.empty()) return now;
  const RingArrival& next = device.arrivals.front();
  const RingArrival& worst = device.arrivals.back();
  const std::string then = device.arrivals.size() < 2 ? ""
                                                      : ", " + Number(worst.risk, 0) + between +
                                                            AheadText(spec, worst.steps);
  return now + (now.empty() ? "" : ", ") + Number(next.risk, 0) + between +
         AheadText(spec, next.steps) + then;
}

std::pair<std::string, std::string> NameAndDanger(
    const FarmSpec& spec, const std::string& kind, const DeviceOutlook& device,
    const std::function<bool(const std::string& name, const std::string& danger)>& fits) {
  const std::string label = DeviceLabel(device.id);
  const std::string full = label + " " + kind;
  std::string danger = DangerText(spec, device);
  if (fits(full, danger)) return {full, danger};
  // The kind can be left out, because the symbol next to the name shows it.
  for (const std::string& shorter :
       {WorstText(spec, device), RiskText(spec, device), RiskText(spec, device, ", ")}) {
    if (fits(label, danger)) break;
    danger = shorter;
  }
  const std::string brief = WithoutForce(danger);
  return fits(full, brief) ? std::pair(full, brief) : std::pair(label, danger);
}

std::string CentreText(const FarmSpec& spec, const aquafarm_msgs::DisasterState& disaster,
                       const Course& course) {
  return NameNow(disaster, course) + StrengthText(course.ahead.front()) + ", centre " +
         WhereText(spec, disaster.x, disaster.y);
}

std::string MotionNow(const FarmSpec& spec, const aquafarm_msgs::DisasterState& disaster) {
  const std::string motion = MotionText(spec, disaster.heading_deg, double(disaster.speed));
  return disaster.speed > 0.0F ? "now moving " + motion : motion;
}

std::string ClosestText(const FarmSpec& spec, const Course& course) {
  if (course.kind == Course::Kind::kExtrapolated) return "";
  const double now = course.ahead.front().step;
  const TrackPoint nearest = ClosestApproach(spec, course.ahead, now);
  if (!(nearest.step > now)) return "";
  return WhereText(spec, nearest.x, nearest.y) + " in " + AheadText(spec, nearest.step - now);
}

std::string ApproachText(const FarmSpec& spec, const aquafarm_msgs::DisasterState& disaster,
                         const Course& course) {
  const std::string motion = MotionText(spec, disaster.heading_deg, double(disaster.speed));
  const std::string closest = ClosestText(spec, course);
  return closest.empty() ? motion : motion + ", closest " + closest;
}

}  // namespace aquafarm_viz
