// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/markers/danger.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/base/disaster_kinds.h"
#include "aquafarm_viz/scene/labels.h"
#include "markers/maker.h"
#include "scene/nautical.h"
#include "scene/outlook.h"
#include "scene/storm_track.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DeviceState;
using aquafarm_msgs::DisasterState;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr std::size_t kMostLabels = 40;  // more are not read, and cost time
constexpr double kLetter = 0.5;          // mean width of a letter of rviz relative to the height
constexpr Rgb kAlarm{0xff, 0xb4, 0x54};

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

// Places labels in the farm, so that they cover neither devices, ships and ports nor each other,
// and rocks only where nothing else is free.
class Labels {
 public:
  Labels(const Maker& maker, const FarmSpec& spec, const FarmState& state)
      : spec_(spec), word_(maker.word_m() / maker.cell_m()) {
    const double half = 0.75 * maker.thing_m() / maker.cell_m();  // with circle and bar
    for (const auto& device : state.devices) Block(device.x, device.y, half);
    for (const auto& ship : state.ships) Block(ship.x, ship.y, half);
    for (const auto& port : spec.ports) Block(port.cell.x, port.cell.y, half);
    for (const auto& rock : spec.rocks)
      rocks_.push_back({rock.cell.x * 1.0, rock.cell.y * 1.0, 0.42, 0.42});
  }

  void Block(double x, double y, double half) { used_.push_back({x, y, half, half}); }

  // Returns the place of a text: below, above or next to a point, or as near to it as possible.
  // Returns nullopt if there is none, or the last place tried if the text must be shown.
  std::optional<Plate> Place(const std::string& text, double x, double y, bool must_show) {
    const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
    std::size_t longest = 0;
    for (std::size_t from = 0; from <= text.size();) {
      const std::size_t end = std::min(text.find('\n', from), text.size());
      longest = std::max(longest, end - from);
      from = end + 1;
    }
    const double half_width =
        std::min(0.5 * kLetter * word_ * double(longest), 0.5 * spec_.width - 0.5);
    const double half_height = (0.1 + 0.5 * double(lines)) * word_;
    const double row = std::max(1.5, 1.5 * word_) + half_height - 0.6 * word_;
    Plate plate{x, y, half_width, half_height};
    for (const bool avoids_rocks : {true, false}) {
      for (const cv::Point2d& offset : OffsetsOf(half_width, row, must_show)) {
        plate.x = std::clamp(x + offset.x, half_width - 0.5, spec_.width - 0.5 - half_width);
        plate.y = std::clamp(y + offset.y, half_height - 0.5, spec_.height - 0.5 - half_height);
        if (Covers(plate, used_) || (avoids_rocks && Covers(plate, rocks_))) continue;
        used_.push_back(plate);
        return plate;
      }
    }
    if (!must_show) return std::nullopt;
    used_.push_back(plate);
    return plate;
  }

 private:
  // Where a label may stand relative to its point, the nearest first: anywhere in the farm if it
  // must be shown.
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
  std::vector<Plate> rocks_;
};

// Adds a text on a dark plate, so that it can be read on any ground.
void AddText(MarkerArray& array, const Maker& maker, const std::string& space, std::int32_t id,
             const Plate& place, const std::string& text) {
  Marker plate =
      maker.Make((space + "_plate").c_str(), id, Marker::CUBE, kWordLayer, place.x, place.y);
  plate.pose.position.z -= 0.5 * maker.layer_m();
  plate.scale.x = 2.0 * place.half_width * maker.cell_m();
  plate.scale.y = 2.0 * place.half_height * maker.cell_m();
  plate.scale.z = 0.1 * maker.layer_m();
  plate.color = Color(kInk, 0.72);
  array.markers.push_back(plate);
  array.markers.push_back(
      maker.Text(space.c_str(), id, place.x, place.y, text, maker.word_m(), kPaper));
}

void DeleteText(MarkerArray& array, const Maker& maker, const std::string& space, std::int32_t id) {
  array.markers.push_back(maker.Delete((space + "_plate").c_str(), id));
  array.markers.push_back(maker.Delete(space.c_str(), id));
}

double NextRisk(const DeviceOutlook& device) {
  return device.arrivals.empty() ? device.risk_now : device.arrivals.front().risk;
}

void AddCircle(MarkerArray& array, const Maker& maker, const DeviceState& device, double risk) {
  Marker circle =
      maker.Make("danger", device.id, Marker::TRIANGLE_LIST, kPortLayer, device.x, device.y);
  circle.color = Color(SeverityColor(Severity(risk)));
  const double inner_m = 0.72 * maker.thing_m();
  const double outer_m = 0.86 * maker.thing_m();
  AddBand(circle, {inner_m, inner_m, inner_m, inner_m}, {outer_m, outer_m, outer_m, outer_m});
  array.markers.push_back(circle);
}

void AddDevices(MarkerArray& array, const Maker& maker, const FarmSpec& spec,
                const FarmState& state, const Outlook& outlook, Labels& labels) {
  std::vector<std::int32_t> shown;
  std::vector<std::int32_t> labelled;
  for (const DeviceOutlook& one : outlook.devices) {
    if (!(NextRisk(one) < 0.0)) continue;
    const auto device =
        std::find_if(state.devices.begin(), state.devices.end(),
                     [&one](const DeviceState& other) { return other.id == one.id; });
    AddCircle(array, maker, *device, NextRisk(one));
    shown.push_back(one.id);
    if (labelled.size() == kMostLabels) continue;
    const std::string text = DeviceLabel(one.id) + ": " + DangerText(spec, one);
    const auto plate = labels.Place(text, device->x, device->y, /*must_show=*/labelled.empty());
    if (!plate) continue;
    AddText(array, maker, "danger_label", one.id, *plate, text);
    labelled.push_back(one.id);
  }
  const auto is_in = [](const std::vector<std::int32_t>& ids, std::int32_t id) {
    return std::find(ids.begin(), ids.end(), id) != ids.end();
  };
  for (const auto& device : state.devices) {
    if (!is_in(shown, device.id)) array.markers.push_back(maker.Delete("danger", device.id));
    if (!is_in(labelled, device.id)) DeleteText(array, maker, "danger_label", device.id);
  }
}

// Points at the edge of the farm towards the centre of each disaster outside it. The labels of the
// pointers are placed before those of devices, which have more places to go.
void AddPointers(MarkerArray& array, const Maker& maker, const FarmSpec& spec,
                 const FarmState& state, const std::vector<Course>& courses, Labels& labels) {
  static const std::vector<cv::Point2f> kPointer{{0.0F, 0.7F}, {-0.5F, -0.5F}, {0.5F, -0.5F}};
  const double middle_x = (spec.width - 1) / 2.0;
  const double middle_y = (spec.height - 1) / 2.0;
  for (std::size_t i = 0; i < state.disasters.size(); ++i) {
    const auto& disaster = state.disasters[i];
    const double east = disaster.x - middle_x;
    const double north = disaster.y - middle_y;
    const double beyond = std::max(std::abs(east) / (spec.width / 2.0 - 0.8),
                                   std::abs(north) / (spec.height / 2.0 - 0.8));
    if (!disaster.known || disaster.steps_left <= 0 || IsCentreInFarm(spec, disaster)) {
      array.markers.push_back(maker.Delete("pointer", disaster.id));
      DeleteText(array, maker, "pointer_label", disaster.id);
      continue;
    }
    const double x = middle_x + east / beyond;
    const double y = middle_y + north / beyond;
    const double bearing = std::atan2(east, north) * 180.0 / CV_PI;
    Marker pointer = maker.Shape("pointer", disaster.id, kSignLayer, x, y, kPointer,
                                 1.2 * maker.thing_m(), GradeColor(disaster.grade));
    pointer.pose.orientation = Turned(bearing, 0.0);
    array.markers.push_back(pointer);
    labels.Block(x, y, 0.8 * maker.thing_m() / maker.cell_m());
    const std::string text = DisasterName(disaster.kind) + ", centre " +
                             DistanceText(MetresFromFarm(spec, disaster.x, disaster.y)) + " " +
                             PointFromFarm(spec, disaster.x, disaster.y) + "\n" +
                             ApproachText(spec, disaster, courses[i]);
    const auto plate = labels.Place(text, x, y, /*must_show=*/true);
    AddText(array, maker, "pointer_label", disaster.id, *plate, text);
  }
}

}  // namespace

struct DangerMarkers::Parts {
  std::string scenario_yaml;  // of the tracks
  StormTracks tracks;
};

DangerMarkers::DangerMarkers() : parts_(std::make_unique<Parts>()) {}
DangerMarkers::~DangerMarkers() = default;

MarkerArray DangerMarkers::Of(const FarmSpec& spec, const FarmState& state) {
  if (parts_->scenario_yaml != spec.scenario_yaml) {
    parts_->scenario_yaml = spec.scenario_yaml;
    parts_->tracks = ReadStormTracks(spec.scenario_yaml, spec.cell_size_m);
  }
  std::vector<Course> courses;
  for (std::size_t i = 0; i < state.disasters.size(); ++i) {
    courses.push_back(CourseOf(spec, state, i, parts_->tracks));
  }
  const Outlook outlook = ComputeOutlook(spec, state, courses);
  const Maker maker(spec, state.header);
  MarkerArray array;
  Labels labels(maker, spec, state);
  AddPointers(array, maker, spec, state, courses, labels);
  AddDevices(array, maker, spec, state, outlook, labels);
  const std::string alarm = OutlookText(spec, state, outlook);
  if (alarm.empty() || state.terminated || state.truncated) {
    array.markers.push_back(maker.Delete("alarm", 0));
    return array;
  }
  array.markers.push_back(maker.Text("alarm", 0, (spec.width - 1) / 2.0, maker.LineAbove(0), alarm,
                                     maker.line_m(), IsInDanger(outlook) ? kAlarm : kPaper));
  return array;
}

}  // namespace aquafarm_viz
