// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/markers/danger.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/base/disaster_kinds.h"
#include "aquafarm_viz/scene/labels.h"
#include "markers/legend.h"
#include "markers/maker.h"
#include "scene/nautical.h"
#include "scene/outlook_text.h"
#include "scene/ship_place.h"
#include "scene/storm_track.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DeviceState;
using aquafarm_msgs::DisasterState;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr std::size_t kMaxLabels = 40;  // more labels would be hard to read and slow
constexpr double kRim = 0.2;            // min distance of a label from the edge of the farm [cells]
constexpr double kMaxLine = 0.98;       // max width of a line of text [longer sides of the farm]

// A rectangle that a label covers [cells].
struct Plate {
  double x{};
  double y{};
  double half_width{};
  double half_height{};

  bool Covers(const Plate& other) const {
    return std::abs(x - other.x) < half_width + other.half_width &&
           std::abs(y - other.y) < half_height + other.half_height;
  }
};

// Finds places for labels on the farm. A label covers no device, ship, port or other label, unless
// it must be shown and no place is free. It covers land only if no place on water near its point is
// free.
class Labels {
 public:
  Labels(const Maker& maker, const FarmSpec& spec, const FarmState& state)
      : spec_(spec), word_(maker.word_m() / maker.cell_m()) {
    const double half = 0.75 * maker.thing_m() / maker.cell_m();  // with the health bar
    for (const auto& device : state.devices) {
      const bool has_circle = device.status == DeviceState::DEPLOYED;  // if in danger (AddCircle)
      Block(device.x, device.y, has_circle ? 1.2 * half : half);
    }
    for (const auto& ship : state.ships) {
      const cv::Point2d at =
          ShipPlace(spec, state, ship.x, ship.y, kShipAside * maker.thing_m() / maker.cell_m());
      Block(at.x, at.y, half);
    }
    for (const auto& port : spec.ports) Block(port.cell.x, port.cell.y, half);
    for (const auto& rock : spec.rocks) BlockLand(rock.cell, 0.42);
    for (const auto& cell : spec.islands) BlockLand(cell, 0.5);
  }

  void Block(double x, double y, double half) { used_.push_back({x, y, half, half}); }

  // Returns the first place that is free and inside the farm; if there is none, the first place.
  // @param half  half the side of the symbol [cells]
  cv::Point2d FirstFree(const std::vector<cv::Point2d>& places, double half) const {
    const auto found = std::find_if(places.begin(), places.end(), [&](const cv::Point2d& place) {
      const bool is_inside = place.x - half >= -0.8 && place.x + half <= spec_.width - 0.2 &&
                             place.y - half >= -0.8 && place.y + half <= spec_.height - 0.2;
      return is_inside && !Covers({place.x, place.y, half, half}, used_);
    });
    return found == places.end() ? places.front() : *found;
  }

  // Returns the ends of the line from a symbol to its label [cells]. Returns no points if the label
  // is next to the symbol or if the line would cross another label. Later labels avoid the line.
  std::vector<cv::Point2d> Leader(cv::Point2d symbol, double radius, const Plate& label) {
    constexpr double kSample = 0.2;  // [cells]
    const cv::Point2d to(
        std::clamp(symbol.x, label.x - label.half_width, label.x + label.half_width),
        std::clamp(symbol.y, label.y - label.half_height, label.y + label.half_height));
    const double length = cv::norm(to - symbol);
    if (length < 2.5 * radius) return {};
    const cv::Point2d from = symbol + (to - symbol) * (radius / length);
    const int samples = std::max(1, int(cv::norm(to - from) / kSample));
    std::vector<Plate> line;
    for (int i = 0; i <= samples; ++i) {
      const cv::Point2d at = from + (to - from) * (double(i) / samples);
      line.push_back({at.x, at.y, 0.05, 0.05});
      const bool crosses = std::any_of(labels_.begin(), labels_.end(), [&](const Plate& other) {
        const bool is_own = other.x == label.x && other.y == label.y;
        return !is_own && other.Covers(line.back());
      });
      if (crosses) return {};
    }
    used_.insert(used_.end(), line.begin(), line.end());
    return {from, to};
  }

  // Returns the place of a label: below, above or next to a point, or as near to it as possible. If
  // no place is free, returns the last place that was tried if `must_show` is true, else nullopt.
  std::optional<Plate> Place(const std::string& text, double x, double y, bool must_show) {
    const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
    const double half_width = std::min(0.5 * (TextWidth(text) + 0.8) * word_,
                                       std::max(0.1, 0.5 * spec_.width - 0.5 - kRim));
    const double half_height = (0.1 + 0.5 * double(lines)) * word_;
    const double row = std::max(1.5, 1.5 * word_) + half_height - 0.6 * word_;
    Plate plate{x, y, half_width, half_height};
    // A near place on land is better than a distant one on water.
    const double near = half_width + 4.0 * row;
    constexpr std::array<std::pair<bool, bool>, 4> kTries{
        {{true, true}, {true, false}, {false, true}, {false, false}}};
    for (const auto& [is_near, avoids_land] : kTries) {
      for (const cv::Point2d& offset : OffsetsOf(half_width, row, must_show)) {
        if ((cv::norm(offset) <= near) != is_near) continue;
        plate.x = std::max(half_width - 0.5 + kRim,
                           std::min(spec_.width - 0.5 - kRim - half_width, x + offset.x));
        plate.y = std::max(half_height - 0.5 + kRim,
                           std::min(spec_.height - 0.5 - kRim - half_height, y + offset.y));
        if (Covers(plate, used_) || (avoids_land && Covers(plate, land_))) continue;
        used_.push_back(plate);
        labels_.push_back(plate);
        return plate;
      }
    }
    if (!must_show) return std::nullopt;
    used_.push_back(plate);
    labels_.push_back(plate);
    return plate;
  }

 private:
  void BlockLand(const aquafarm_msgs::Cell& cell, double half) {
    land_.push_back({double(cell.x), double(cell.y), half, half});
  }

  // Returns the offsets of a label from its point that are tried: first below, above, right and
  // left, then others, the nearest first. `is_anywhere` adds distant offsets.
  std::vector<cv::Point2d> OffsetsOf(double half_width, double row, bool is_anywhere) const {
    const double aside = half_width + std::max(1.5, 1.5 * word_);
    std::vector<cv::Point2d> offsets{{0.0, -row}, {0.0, row}, {aside, 0.0}, {-aside, 0.0}};
    constexpr int kNear = 5;
    constexpr int kFar = 24;
    const int columns = is_anywhere ? kFar : 2;
    std::vector<cv::Point2d> others;
    for (int up = -kFar; up <= kFar; ++up) {
      for (int right = -columns; right <= columns; ++right) {
        const cv::Point2d offset(0.5 * right * aside, 0.6 * up * row);
        const bool is_near = std::abs(up) <= kNear;
        if ((is_near || is_anywhere) && std::abs(up) > 1) others.push_back(offset);
      }
    }
    std::stable_sort(others.begin(), others.end(), [](const auto& a, const auto& b) {
      return a.x * a.x + a.y * a.y < b.x * b.x + b.y * b.y;
    });
    offsets.insert(offsets.end(), others.begin(), others.end());
    return offsets;
  }

  static bool Covers(const Plate& plate, const std::vector<Plate>& others) {
    return std::any_of(others.begin(), others.end(),
                       [&plate](const Plate& other) { return plate.Covers(other); });
  }

  const FarmSpec& spec_;
  double word_;  // height of a text [cells]
  std::vector<Plate> used_;
  std::vector<Plate> labels_;
  std::vector<Plate> land_;  // islands and rocks
};

void DeleteText(MarkerArray& array, const Maker& maker, const std::string& space, std::int32_t id) {
  array.markers.push_back(maker.Delete((space + "_plate").c_str(), id));
  array.markers.push_back(maker.Delete((space + "_leader").c_str(), id));
  array.markers.push_back(maker.Delete(space.c_str(), id));
}

// Adds the line from a symbol to its label, or deletes it if `line` is empty.
void AddLeader(MarkerArray& array, const Maker& maker, const std::string& space, std::int32_t id,
               const std::vector<cv::Point2d>& line) {
  const std::string name = space + "_leader";
  if (line.empty()) return array.markers.push_back(maker.Delete(name.c_str(), id));
  Marker marker = maker.Make(name.c_str(), id, Marker::TRIANGLE_LIST, kSignLayer, 0.0, 0.0);
  marker.color = Color(kPaper);
  const cv::Point2d along = line[1] - line[0];
  const cv::Point2d aside = cv::Point2d(-along.y, along.x) * (0.04 / cv::norm(along));
  for (const cv::Point2d& corner : {line[0] - aside, line[1] - aside, line[1] + aside,
                                    line[0] - aside, line[1] + aside, line[0] + aside}) {
    marker.points.push_back(Point(corner.x * maker.cell_m(), corner.y * maker.cell_m()));
  }
  array.markers.push_back(marker);
}

// Breaks a text after a comma into two lines if it is wider than `max_width` [heights of a letter].
// The first line contains all parts that fit, and at least one.
std::string InLines(std::string text, double max_width) {
  if (TextWidth(text) <= max_width || text.find('\n') != std::string::npos) return text;
  std::size_t end = std::string::npos;
  for (std::size_t at = text.find(", "); at != std::string::npos; at = text.find(", ", at + 1)) {
    if (end == std::string::npos || TextWidth(text.substr(0, at + 1)) <= max_width) end = at;
  }
  if (end != std::string::npos) text.replace(end, 2, ",\n");
  return text;
}

// Radii of the circles around a device in danger [thing_m()].
constexpr double kCircleInner = 0.72;
constexpr double kCircleOuter = 0.86;
constexpr double kSecondInner = 0.96;  // of a device that is hit first
constexpr double kSecondOuter = 1.06;

// Adds the circle around a device in danger, or two circles if it is hit first.
void AddCircle(MarkerArray& array, const Maker& maker, const DeviceState& device, double risk,
               bool is_first) {
  Marker circle =
      maker.Make("danger", device.id, Marker::TRIANGLE_LIST, kPortLayer, device.x, device.y);
  circle.color = Color(SeverityColor(Severity(risk)));
  const auto band = [&](double inner, double outer) {
    const double inner_m = inner * maker.thing_m();
    const double outer_m = outer * maker.thing_m();
    AddBand(circle, {inner_m, inner_m, inner_m, inner_m}, {outer_m, outer_m, outer_m, outer_m});
  };
  band(kCircleInner, kCircleOuter);
  if (is_first) band(kSecondInner, kSecondOuter);
  array.markers.push_back(circle);
}

// Adds circles around the devices in danger and labels next to them where there is space, the most
// urgent devices first. Deletes the circles and labels of all other devices.
void AddDevices(MarkerArray& array, const Maker& maker, const FarmSpec& spec,
                const FarmState& state, const Outlook& outlook, Labels& labels) {
  std::set<std::int32_t> circled;
  std::set<std::int32_t> labelled;
  for (const DeviceOutlook& one : outlook.devices) {
    if (!(WorstRisk(one) < 0.0)) continue;
    const DeviceState& device =
        *std::find_if(state.devices.begin(), state.devices.end(),
                      [&one](const DeviceState& other) { return other.id == one.id; });
    const bool is_first = IsHitFirst(spec, outlook, one);
    const double radius =
        (is_first ? kSecondOuter : kCircleOuter) * maker.thing_m() / maker.cell_m();
    AddCircle(array, maker, device, WorstRisk(one), is_first);
    circled.insert(one.id);
    if (labelled.size() == kMaxLabels) continue;
    const std::string text = DeviceLabel(one.id) + ": " + FirstAndWorstText(spec, one);
    const auto plate = labels.Place(text, device.x, device.y, /*must_show=*/labelled.empty());
    if (!plate) continue;
    AddOnPlate(
        array, maker, "danger_label", one.id, {plate->x, plate->y},
        {2.0 * plate->half_width * maker.cell_m(), 2.0 * plate->half_height * maker.cell_m()},
        text);
    AddLeader(array, maker, "danger_label", one.id,
              labels.Leader(cv::Point2d(device.x, device.y), radius, *plate));
    labelled.insert(one.id);
    array.markers.push_back(maker.Delete("device_label", one.id));  // the new label contains it
  }
  for (const auto& device : state.devices) {
    if (circled.count(device.id) == 0) array.markers.push_back(maker.Delete("danger", device.id));
    if (labelled.count(device.id) == 0) DeleteText(array, maker, "danger_label", device.id);
  }
}

// Adds a pointer at the edge of the farm for each disaster whose centre is outside the farm.
// Returns the indices of these disasters.
std::vector<std::size_t> AddPointers(MarkerArray& array, const Maker& maker, const FarmSpec& spec,
                                     const FarmState& state, Labels& labels) {
  const double middle_x = (spec.width - 1) / 2.0;
  const double middle_y = (spec.height - 1) / 2.0;
  const double inset = std::min(0.5 + 0.95 * maker.thing_m() / maker.cell_m(),
                                std::min(spec.width, spec.height) / 2.0 - 0.1);
  std::vector<std::size_t> outside;
  for (std::size_t i = 0; i < state.disasters.size(); ++i) {
    const auto& disaster = state.disasters[i];
    const double east = disaster.x - middle_x;
    const double north = disaster.y - middle_y;
    const double beyond = std::max(std::abs(east) / (spec.width / 2.0 - inset),
                                   std::abs(north) / (spec.height / 2.0 - inset));
    if (!disaster.known || disaster.steps_left <= 0 || IsCentreInFarm(spec, disaster)) {
      array.markers.push_back(maker.Delete("pointer", disaster.id));
      continue;
    }
    const cv::Point2d edge(middle_x + east / beyond, middle_y + north / beyond);
    const bool is_beside = std::abs(east) * spec.height > std::abs(north) * spec.width;
    std::vector<cv::Point2d> places{edge};  // others follow along the edge
    for (const double aside : {1.0, -1.0, 1.6, -1.6, 2.2, -2.2}) {
      const double cells = aside * maker.thing_m() / maker.cell_m();
      places.push_back(edge + (is_beside ? cv::Point2d(0.0, cells) : cv::Point2d(cells, 0.0)));
    }
    const cv::Point2d at = labels.FirstFree(places, 0.95 * maker.thing_m() / maker.cell_m());
    const double bearing = std::atan2(east, north) * 180.0 / CV_PI;
    Marker pointer = maker.Shape("pointer", disaster.id, kSignLayer, at.x, at.y, PointerOutline(),
                                 0.75 * maker.thing_m(), GradeColor(disaster.grade));
    pointer.pose.orientation = Turned(bearing, 0.0);
    array.markers.push_back(pointer);
    labels.Block(at.x, at.y, 0.8 * maker.thing_m() / maker.cell_m());
    outside.push_back(i);
  }
  return outside;
}

// Adds one or two lines of text north of the farm, directly above or below the clock. Deletes them
// if `text` is empty.
// @param side  1: above the clock, -1: below it
void AddLines(MarkerArray& array, const Maker& maker, const FarmSpec& spec, const char* space,
              double side, const std::string& text, Rgb color) {
  if (text.empty()) return array.markers.push_back(maker.Delete(space, 0));
  const double side_m = std::max(spec.width, spec.height) * maker.cell_m();
  const std::string lines = InLines(text, kMaxLine * side_m / maker.line_m());
  const auto more = double(std::count(lines.begin(), lines.end(), '\n'));
  array.markers.push_back(
      maker.Line(space, kLineOfClock + side * (1.0 + 0.5 * more), lines, color));
}

// Returns the strength, the position and the motion of the disasters outside the farm: one line for
// each of the first two, and the number of the others.
std::string OutsideText(const FarmSpec& spec, const FarmState& state,
                        const std::vector<Course>& courses,
                        const std::vector<std::size_t>& outside) {
  constexpr std::size_t kMaxLines = 2;
  std::string text;
  for (std::size_t i = 0; i < std::min(outside.size(), kMaxLines); ++i) {
    const DisasterState& disaster = state.disasters[outside[i]];
    const Course& course = courses[outside[i]];
    text += (i == 0 ? "" : "\n") + CentreText(spec, disaster, course) + ", " +
            ApproachText(spec, disaster, course);
  }
  const std::size_t others = outside.size() - std::min(outside.size(), kMaxLines);
  return others == 0 ? text : text + ", and " + std::to_string(others) + " more";
}

// Returns whether the trail of a ship has a move with nothing aboard, which is drawn dashed.
bool HasDashes(const FarmState& state, const Trail& trail) {
  return std::any_of(state.ships.begin(), state.ships.end(), [&trail](const auto& ship) {
    const ShipTrail* way = ship.visible && ship.active ? trail.Find(ship.id) : nullptr;
    return way != nullptr && way->loaded.size() > 1 &&
           std::find(way->loaded.begin() + 1, way->loaded.end(), false) != way->loaded.end();
  });
}

}  // namespace

struct DangerMarkers::Parts {
  CourseReader courses;
};

DangerMarkers::DangerMarkers() : parts_(std::make_unique<Parts>()) {}
DangerMarkers::~DangerMarkers() = default;

MarkerArray DangerMarkers::Of(const FarmSpec& spec, const FarmState& state, const Trail* trail) {
  const std::vector<Course> courses = parts_->courses.Read(spec, state);
  const Outlook outlook = ComputeOutlook(spec, state, courses);
  const Maker maker(spec, state.header);
  MarkerArray array;
  Labels labels(maker, spec, state);
  const std::vector<std::size_t> outside = AddPointers(array, maker, spec, state, labels);
  AddDevices(array, maker, spec, state, outlook, labels);
  const bool is_over = state.terminated || state.truncated;
  AddLines(array, maker, spec, "alarm", 1.0,
           is_over ? "" : Capitalized(OutlookText(spec, state, outlook)),
           IsInDanger(outlook) ? Mix(SeverityColor(Severity(WorstRisk(outlook))), kPaper, 0.25)
                               : kPaper);
  AddLines(array, maker, spec, "outside", -1.0, OutsideText(spec, state, courses, outside), kPaper);
  bool has_rings = false;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    const DisasterState& disaster = state.disasters[i];
    has_rings = has_rings || (disaster.known && disaster.steps_left > 0 &&
                              !OverFarmText(spec, courses[i]).empty());
  }
  AddSignLegend(array, spec,
                {IsInDanger(outlook), HasHitFirst(spec, outlook), !outside.empty(), has_rings,
                 trail != nullptr && HasDashes(state, *trail)});
  return array;
}

}  // namespace aquafarm_viz
