// SPDX-License-Identifier: BSD-3-Clause
#include "scene/outlook_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <ctime>

#include "aquafarm/tracks/wind_name.h"
#include "aquafarm_viz/base/text.h"
#include "aquafarm_viz/scene/labels.h"
#include "scene/nautical.h"

namespace aquafarm_viz {

using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

std::string AheadText(const FarmSpec& spec, double steps) {
  if (!(spec.step_duration_s > 0.0)) {
    return Number(steps, 0) + (steps == 1.0 ? " step" : " steps");
  }
  const double hours = steps * spec.step_duration_s / 3600.0;
  if (hours < 1.0) return Number(60.0 * hours, 0) + " min";
  return Number(hours, hours < 10.0 ? 1 : 0) + " h";
}

namespace {

// Returns the name of the wind of a ring; empty if it is not given.
const char* NameOf(std::int32_t wind_kt) { return wind_kt > 0 ? aquafarm::WindName(wind_kt) : ""; }

// Returns "risk -10", or the name of the wind, such as "storm", if it is given.
std::string RingText(double risk, std::int32_t wind_kt) {
  return wind_kt > 0 ? aquafarm::WindName(wind_kt) : "risk " + Number(risk, 0);
}

// Returns the labels of the devices for which `applies` is true, in order of id: "F0", "F0 and F1"
// or "F0, F1 and F2". For more devices, returns their number: "4 devices". `applies` must be true
// for at least one device.
std::string Names(const Outlook& outlook,
                  const std::function<bool(const DeviceOutlook& device)>& applies) {
  constexpr std::size_t kMaxNames = 3;
  std::vector<std::int32_t> ids;
  for (const DeviceOutlook& one : outlook.devices) {
    if (applies(one)) ids.push_back(one.id);
  }
  std::sort(ids.begin(), ids.end());
  if (ids.size() > kMaxNames) return std::to_string(ids.size()) + " devices";
  std::string names;
  for (const std::int32_t id : ids) {
    names += (id == ids.front() ? "" : id == ids.back() ? " and " : ", ") + DeviceLabel(id);
  }
  return names;
}

// Returns the arrival that comes first in the order `is_before`, of the arrivals at all devices;
// null if no ring arrives.
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

// Returns whether two arrivals have the same disaster and risk, and times with the same AheadText.
bool IsSameArrival(const FarmSpec& spec, const RingArrival& a, const RingArrival& b) {
  return a.disaster == b.disaster && a.risk == b.risk &&
         AheadText(spec, a.steps) == AheadText(spec, b.steps);
}

// Returns the labels of the devices that have the same arrival as `ring`: "F0 and F1".
std::string WhomText(const FarmSpec& spec, const Outlook& outlook, const RingArrival& ring) {
  return Names(outlook, [&](const DeviceOutlook& one) {
    return std::any_of(one.arrivals.begin(), one.arrivals.end(),
                       [&](const RingArrival& other) { return IsSameArrival(spec, other, ring); });
  });
}

// Returns the local time `steps` steps from now, such as "Sun 06:24".
std::string DayAndClock(const FarmSpec& spec, const FarmState& state, double steps) {
  const double then_s = double(state.world_time.sec) + steps * spec.step_duration_s;
  return LocalTimeText(spec, static_cast<std::time_t>(then_s), "%a %H:%M");
}

// Returns the local time of an arrival: " (Sun 06:24 UTC+8)", or " (Sun 06:24)" if `has_zone` is
// false. If WhomText contains devices that the ring reaches later, the text is " (from Sun 06:24)".
// Empty if the time is less than an hour away, or if the scenario has no start time.
std::string ClockAhead(const FarmSpec& spec, const FarmState& state, const Outlook& outlook,
                       const RingArrival& ring, bool has_zone) {
  if (!spec.has_start_time || ring.steps * spec.step_duration_s < 3600.0) return "";
  const std::string clock = DayAndClock(spec, state, ring.steps);
  const bool are_others_later =
      std::any_of(outlook.devices.begin(), outlook.devices.end(), [&](const DeviceOutlook& one) {
        return std::any_of(one.arrivals.begin(), one.arrivals.end(), [&](const auto& other) {
          return IsSameArrival(spec, other, ring) && DayAndClock(spec, state, other.steps) != clock;
        });
      });
  return (are_others_later ? " (from " : " (") + clock + (has_zone ? " " + ZoneText(spec) : "") +
         ")";
}

// Returns "no known danger to devices for the next 12 h"; empty if all courses are known to their
// ends.
std::string KnownText(const FarmSpec& spec, const Outlook& outlook) {
  if (!std::isfinite(outlook.known_until)) return "";
  return "no known danger to devices for the next " + AheadText(spec, outlook.known_until);
}

// Returns a distance rounded down, so that no danger seems farther away than it is: "12 km", "2.9
// km", "900 m" or "less than 100 m".
std::string RoundedDown(double metres) {
  const double unit = metres >= 10000.0 ? 1000.0 : 100.0;
  if (metres < unit) return "less than 100 m";
  return DistanceText(unit * std::floor(metres / unit + 1e-6));
}

// Returns a text about the ring that comes nearest to a device: "risk -5 is 900 m from F2 now" or
// "gale passes 12 km from F2 in 9.0 h".
std::string MissText(const FarmSpec& spec, const Outlook& outlook) {
  const RingMiss& miss = outlook.miss;
  const std::string ring = RingText(miss.risk, miss.wind_kt);
  const std::string where =
      RoundedDown(miss.cells * double(spec.cell_size_m)) + " from " + DeviceLabel(miss.device);
  if (!(miss.steps > 0.0)) return ring + " is " + where + " now";
  const std::string about = outlook.is_extrapolated ? "about " : "";
  const std::string when = " in " + about + AheadText(spec, miss.steps);
  return miss.comes_nearer ? ring + " is " + about + where + when + " and comes nearer"
                           : ring + " passes " + about + where + when;
}

// Returns MissText and KnownText: "risk -5 is 900 m from F2 now; no known danger to devices for the
// next 3.0 h", or "...; no danger known for 3.0 h" if `is_brief` is true. A part that does not
// apply is left out.
std::string SafeText(const FarmSpec& spec, const Outlook& outlook, bool is_brief) {
  std::string known = KnownText(spec, outlook);
  if (is_brief && !known.empty()) {
    known = "no danger known for " + AheadText(spec, outlook.known_until);
  }
  if (!std::isfinite(outlook.miss.cells)) return known;
  return MissText(spec, outlook) + (known.empty() ? "" : "; " + known);
}

// Writes an outlook as one sentence, see OutlookText.
class Sentence {
 public:
  /// @param has_directions  true: the direction follows the name of a disaster outside the farm
  /// @param is_brief  true: without times of day, and with the brief SafeText
  Sentence(const FarmSpec& spec, const FarmState& state, const Outlook& outlook,
           bool has_directions, bool is_brief)
      : spec_(spec),
        state_(state),
        outlook_(outlook),
        has_directions_(has_directions),
        is_brief_(is_brief) {}

  std::string Write() {
    if (outlook_.devices.empty()) {
      return outlook_.is_known && !state_.devices.empty() ? "no device is deployed" : "";
    }
    if (!IsInDanger(outlook_)) return WriteSafe();
    AddNow();
    const RingArrival* next =
        Extreme(outlook_, [](const auto& a, const auto& b) { return a.steps < b.steps; });
    if (next == nullptr) return text_;
    const RingArrival* worst = Extreme(outlook_, [](const auto& a, const auto& b) {
      return a.risk < b.risk || (a.risk == b.risk && a.steps < b.steps);
    });
    const std::string clock = Clock(*next, /*has_zone=*/true);
    Add(*next, clock);
    if (worst->risk < next->risk) {
      Add(*worst, Clock(*worst, /*has_zone=*/clock.empty()));
    } else {
      AddOthers(*next);
    }
    return text_;
  }

 private:
  bool HasDirection(std::size_t disaster) const {
    return has_directions_ && !outlook_.directions.at(disaster).empty();
  }

  // Returns the name of a disaster, "typhoon" or "typhoon in the SSE".
  std::string Name(std::size_t disaster) const {
    const std::string& name = outlook_.names[disaster];
    return HasDirection(disaster) ? name + " in the " + outlook_.directions[disaster] : name;
  }

  // Returns ClockAhead; empty in a brief sentence.
  std::string Clock(const RingArrival& ring, bool has_zone) const {
    return is_brief_ ? "" : ClockAhead(spec_, state_, outlook_, ring, has_zone);
  }

  // Returns a time ahead, with "about" if a course is extrapolated.
  std::string When(double steps) const {
    return (outlook_.is_extrapolated ? "about " : "") + AheadText(spec_, steps);
  }

  // Returns the sentence for the case that no device is in danger.
  std::string WriteSafe() const {
    const bool is_near = std::isfinite(outlook_.miss.cells);
    return (is_near ? Name(outlook_.miss.disaster) + ": " : "") +
           SafeText(spec_, outlook_, is_brief_);
  }

  // Adds the ring that covers the most urgent device now, if there is one.
  void AddNow() {
    const DeviceOutlook& first = outlook_.devices.front();
    if (!(first.risk_now < 0.0)) return;
    disaster_ = first.disaster_now;
    whom_ = Names(outlook_, [&first](const DeviceOutlook& one) {
      return one.disaster_now == first.disaster_now && one.risk_now == first.risk_now;
    });
    ring_ = RingText(first.risk_now, first.wind_now_kt);
    text_ = Name(disaster_) + ": " + ring_ + " over " + whom_ + " now";
  }

  // Adds the arrival of a ring. Names the disaster, the ring and the devices only if they differ
  // from those of the previous part.
  void Add(const RingArrival& ring, const std::string& clock) {
    const std::string these = WhomText(spec_, outlook_, ring);
    const std::string what = RingText(ring.risk, ring.wind_kt);
    if (text_.empty()) {
      text_ = Name(ring.disaster) + ": " + what + " reaches " + these;
    } else if (ring.disaster == disaster_ && what == ring_ && these != whom_) {
      text_ += ", " + these;
    } else {
      const char* between = HasDirection(ring.disaster) ? ", " : " ";
      text_ += ", " + (ring.disaster == disaster_ ? "" : Name(ring.disaster) + between) + what +
               (these == whom_ ? "" : " reaches " + these);
    }
    text_ += " in " + When(ring.steps) + clock;
    whom_ = these;
    ring_ = what;
    disaster_ = ring.disaster;
  }

  // Adds the devices that the same ring reaches later: "F2 in 2.2 h", "F2 and F3 within 3.0 h" or
  // "4 more within 3.0 h".
  void AddOthers(const RingArrival& ring) {
    const auto is_same_ring = [&](const RingArrival& other) {
      return other.disaster == ring.disaster && other.risk == ring.risk &&
             AheadText(spec_, other.steps) != AheadText(spec_, ring.steps);
    };
    const auto is_later = [&](const DeviceOutlook& one) {
      return std::any_of(one.arrivals.begin(), one.arrivals.end(), is_same_ring);
    };
    double last = ring.steps;
    for (const DeviceOutlook& one : outlook_.devices) {
      for (const RingArrival& other : one.arrivals) {
        if (is_same_ring(other)) last = std::max(last, other.steps);
      }
    }
    const auto count = std::count_if(outlook_.devices.begin(), outlook_.devices.end(), is_later);
    if (count == 0) return;
    const std::string whom =
        count > 2 ? std::to_string(count) + " more" : Names(outlook_, is_later);
    text_ += ", " + whom + (count > 1 ? " within " : " in ") + When(last);
  }

  const FarmSpec& spec_;
  const FarmState& state_;
  const Outlook& outlook_;
  bool has_directions_;
  bool is_brief_;
  std::string text_;
  std::string whom_;          // devices of the previous part
  std::string ring_;          // RingText of the previous part
  std::size_t disaster_ = 0;  // disaster of the previous part
};

}  // namespace

std::string OutlookText(const FarmSpec& spec, const FarmState& state, const Outlook& outlook) {
  return Sentence(spec, state, outlook, /*has_directions=*/false, /*is_brief=*/false).Write();
}

std::string Capitalized(std::string text) {
  if (!text.empty()) text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::vector<std::string> Headlines(const FarmSpec& spec, const FarmState& state,
                                   const Outlook& outlook) {
  const std::string brief = ShortOutlookText(spec, outlook);
  if (brief.empty()) return {};
  std::vector<std::string> lines;
  for (const bool is_brief : {false, true}) {
    for (const bool has_directions : {true, false}) {
      lines.push_back(Sentence(spec, state, outlook, has_directions, is_brief).Write());
    }
  }
  lines.push_back(brief);
  if (!IsInDanger(outlook)) lines.push_back(SafeText(spec, outlook, /*is_brief=*/true));
  for (std::string& line : lines) line = Capitalized(line);
  return lines;
}

std::string ShortOutlookText(const FarmSpec& spec, const Outlook& outlook) {
  if (outlook.devices.empty()) return "";
  if (!IsInDanger(outlook)) return SafeText(spec, outlook, /*is_brief=*/false);
  const DeviceOutlook& first = outlook.devices.front();
  return DeviceLabel(first.id) + ": " + DangerText(spec, first);
}

bool IsHitFirst(const FarmSpec& spec, const Outlook& outlook, const DeviceOutlook& device) {
  const auto first_ring = [&spec](const DeviceOutlook& one) {
    if (one.risk_now < 0.0) return std::pair(std::string("now"), one.risk_now);
    if (one.arrivals.empty()) return std::pair(std::string(), 0.0);
    return std::pair(AheadText(spec, one.arrivals.front().steps), one.arrivals.front().risk);
  };
  const auto first = first_ring(outlook.devices.front());
  const bool are_all =
      std::all_of(outlook.devices.begin(), outlook.devices.end(), [&](const DeviceOutlook& other) {
        return !(WorstRisk(other) < 0.0) || first_ring(other) == first;
      });
  return !are_all && WorstRisk(device) < 0.0 && first_ring(device) == first;
}

bool HasHitFirst(const FarmSpec& spec, const Outlook& outlook) {
  return std::any_of(outlook.devices.begin(), outlook.devices.end(),
                     [&](const DeviceOutlook& one) { return IsHitFirst(spec, outlook, one); });
}

namespace {

// Returns the name of a wind; in a brief text, "64 kt" instead of "hurricane force".
std::string WindIn(std::int32_t wind_kt, bool is_brief) {
  return is_brief && wind_kt >= aquafarm::kHurricaneForce_kt ? std::to_string(wind_kt) + " kt"
                                                             : NameOf(wind_kt);
}

DangerPart NamedPart(const FarmSpec& spec, const RingArrival& ring, bool is_brief) {
  return {WindIn(ring.wind_kt, is_brief) + " in " + AheadText(spec, ring.steps), ring.risk};
}

// Returns the parts with risks instead of names of winds: "-5 now", "-20 in 6.5 h".
// @param between  text between risk and time
DangerParts RiskParts(const FarmSpec& spec, const DeviceOutlook& device, const char* between) {
  DangerParts parts;
  if (device.risk_now < 0.0)
    parts.push_back({Number(device.risk_now, 0) + " now", device.risk_now});
  const auto add = [&](const RingArrival& ring) {
    parts.push_back({Number(ring.risk, 0) + between + AheadText(spec, ring.steps), ring.risk});
  };
  if (!device.arrivals.empty()) add(device.arrivals.front());
  if (device.arrivals.size() > 1) add(device.arrivals.back());
  return parts;
}

// Returns the worst ring to come, or all parts if its wind is not given.
DangerParts WorstPart(const FarmSpec& spec, const DeviceOutlook& device, bool is_brief) {
  const bool is_named = !device.arrivals.empty() && device.arrivals.back().wind_kt > 0;
  return is_named ? DangerParts{NamedPart(spec, device.arrivals.back(), is_brief)}
                  : PartsOf(spec, device, is_brief);
}

// Returns the first and the last of PartsOf.
DangerParts FirstAndWorst(const FarmSpec& spec, const DeviceOutlook& device, bool is_brief) {
  const DangerParts parts = PartsOf(spec, device, is_brief);
  return parts.size() > 2 ? DangerParts{parts.front(), parts.back()} : parts;
}

}  // namespace

std::string Joined(const DangerParts& parts) {
  std::string text;
  for (const DangerPart& part : parts) text += (text.empty() ? "" : ", ") + part.text;
  return text;
}

DangerParts PartsOf(const FarmSpec& spec, const DeviceOutlook& device, bool is_brief) {
  const std::string before = device.risk_now < 0.0 ? NameOf(device.wind_now_kt) : "";
  const std::string after = device.arrivals.empty() ? "" : NameOf(device.arrivals.front().wind_kt);
  // If both rings have the same name, only their risks distinguish them.
  const bool has_names = (device.risk_now == 0.0 || !before.empty()) &&
                         (device.arrivals.empty() || !after.empty()) && before != after;
  if (!has_names) {
    DangerParts parts = RiskParts(spec, device, " in ");
    if (!parts.empty()) parts.front().text = "risk " + parts.front().text;
    return parts;
  }
  DangerParts parts;
  if (!before.empty()) {
    parts.push_back({WindIn(device.wind_now_kt, is_brief) + " now", device.risk_now});
  }
  if (after.empty()) return parts;
  parts.push_back(NamedPart(spec, device.arrivals.front(), is_brief));
  const RingArrival& worst = device.arrivals.back();
  const std::string last = NameOf(worst.wind_kt);
  if (!last.empty() && last != after) {
    parts.push_back(NamedPart(spec, worst, is_brief));
  } else if (!last.empty() && worst.risk < device.arrivals.front().risk) {
    parts.push_back({std::to_string(worst.wind_kt) + " kt in " + AheadText(spec, worst.steps),
                     worst.risk});  // the name of its wind does not distinguish it
  }
  return parts;
}

std::string DangerText(const FarmSpec& spec, const DeviceOutlook& device) {
  return Joined(PartsOf(spec, device, /*is_brief=*/false));
}

std::string FirstAndWorstText(const FarmSpec& spec, const DeviceOutlook& device) {
  const DangerParts parts = FirstAndWorst(spec, device, /*is_brief=*/false);
  return Joined(parts.size() > 1 ? FirstAndWorst(spec, device, /*is_brief=*/true) : parts);
}

std::pair<std::string, DangerParts> NameAndDanger(
    const FarmSpec& spec, const std::string& kind, const DeviceOutlook& device,
    const std::function<bool(const std::string& name, const std::string& danger)>& fits) {
  const std::string label = DeviceLabel(device.id);
  for (const auto& form : {PartsOf, FirstAndWorst, WorstPart}) {
    // The kind can be left out, because the symbol next to the name shows it.
    for (const std::string& name : {label + " " + kind, label}) {
      for (const bool is_brief : {false, true}) {
        const DangerParts danger = form(spec, device, is_brief);
        if (fits(name, Joined(danger))) return {name, danger};
      }
    }
  }
  for (const char* between : {" in ", ", "}) {
    const DangerParts risks = RiskParts(spec, device, between);
    if (fits(label, Joined(risks))) return {label, risks};
  }
  return {label, {RiskParts(spec, device, " in ").back()}};
}

std::string CentreText(const FarmSpec& spec, const aquafarm_msgs::DisasterState& disaster,
                       const Course& course) {
  return NameNow(disaster, course) + StrengthText(course.ahead.front()) + ", centre " +
         WhereText(spec, disaster.x, disaster.y);
}

std::string MotionNow(const FarmSpec& spec, const aquafarm_msgs::DisasterState& disaster) {
  const std::string motion = MotionText(spec, disaster.heading_deg, double(disaster.speed));
  const bool is_present = disaster.visible && disaster.steps_left > 0;
  return disaster.speed > 0.0F && is_present ? motion + " now" : motion;
}

std::string ClosestText(const FarmSpec& spec, const Course& course) {
  if (course.kind == Course::Kind::kExtrapolated) return "";
  const double now = course.ahead.front().step;
  const TrackPoint nearest = ClosestApproach(spec, course.ahead, now);
  if (!(nearest.step > now)) return "";
  return WhereText(spec, nearest.x, nearest.y) +
         (nearest.step > course.known_until ? " in about " : " in ") +
         AheadText(spec, nearest.step - now);
}

std::string ApproachText(const FarmSpec& spec, const aquafarm_msgs::DisasterState& disaster,
                         const Course& course) {
  const std::string motion = MotionNow(spec, disaster);
  const std::string closest = ClosestText(spec, course);
  return closest.empty() ? motion : motion + ", closest " + closest;
}

}  // namespace aquafarm_viz
