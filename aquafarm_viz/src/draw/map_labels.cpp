// SPDX-License-Identifier: BSD-3-Clause
#include "draw/map_labels.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <set>
#include <utility>

#include "aquafarm/tracks/wind_name.h"
#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/base/disaster_kinds.h"
#include "aquafarm_viz/scene/labels.h"
#include "aquafarm_viz/scene/rings.h"
#include "draw/symbols.h"
#include "scene/nautical.h"
#include "scene/outlook_text.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DeviceState;
using aquafarm_msgs::DisasterState;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

constexpr std::size_t kMaxDangerLabels = 40;  // more labels would be hard to read and slow
constexpr double kDangerRing = 2.0;           // radius of the second danger ring [device radii]
constexpr double kSymbol = 1.2;               // radius blocked around other devices [device radii]

// Returns the part of the map that a symbol with a health bar above it covers.
cv::Rect WithBar(cv::Point2d at, double radius, const Layout& layout) {
  const cv::Rect body = Around(at, radius);
  const int bar = layout.Px(8);
  return {body.x, body.y - bar, body.width, body.height + bar};
}

const DeviceState* Find(const FarmState& state, std::int32_t id) {
  const auto found = std::find_if(state.devices.begin(), state.devices.end(),
                                  [id](const DeviceState& device) { return device.id == id; });
  return found == state.devices.end() ? nullptr : &*found;
}

// Draws a line in the colour of a label from its symbol to the label, if the label is not next to
// the symbol. Leaves out a line that would cross another label.
void DrawLeader(cv::Mat& map, cv::Point2d symbol, double radius, cv::Rect label, Rgb color,
                LabelSpace& space, const Layout& layout) {
  const cv::Point2d to = NearestIn(label, symbol);
  const double length = cv::norm(to - symbol);
  if (length < radius + 7.0 * layout.unit) return;
  const cv::Point2d from = symbol + (to - symbol) * (radius / length);
  if (!space.AddLine(from, to, label, layout.Px(3))) return;
  DrawLine(map, from, to, Bgr(layout.style->halo), layout.Px(3));
  DrawLine(map, from, to, Bgr(color), layout.Px(1.2));
}

constexpr double kPlateMargins = 13.0;  // left and right margin of a text together [design units]
constexpr double kPlateRow = 16.0;      // height of a line on a plate [design units]

// Draws lines of text on a plate with a coloured bar at its left edge.
void DrawPlate(cv::Mat& map, cv::Rect plate, const std::vector<std::string>& lines, Rgb color,
               const Layout& layout, const Fonts& fonts) {
  const Style& style = *layout.style;
  Tint(map, plate, Bgr(style.panel), 0.88);
  const int bar = layout.Px(4);
  cv::rectangle(map, cv::Rect(plate.x, plate.y, bar, plate.height), Bgr(color), cv::FILLED);
  cv::rectangle(map, plate, Bgr(style.rule), 1);
  const int row = plate.height / static_cast<int>(lines.size());
  int base = plate.y + (row + fonts.bold.cap_height()) / 2;
  for (const std::string& line : lines) {
    fonts.bold.Draw(map, line, {plate.x + bar + layout.Px(4), base}, Bgr(style.words));
    base += row;
  }
}

constexpr double kMaxLine = 200.0;  // max width of a line of a label [design units]

// Breaks a text after commas into lines of at most `width` design units. Only a part without a
// comma may be longer.
std::vector<std::string> BrokenAtCommas(const std::string& text, double width, const Layout& layout,
                                        const Fonts& fonts) {
  std::vector<std::string> lines{""};
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t comma = text.find(", ", from);
    const std::size_t end = comma == std::string::npos ? text.size() : comma + 1;
    const std::string part = text.substr(from, end - from);
    const std::string longer = lines.back() + (lines.back().empty() ? "" : " ") + part;
    if (lines.back().empty() || fonts.bold.Width(longer) <= layout.Px(width)) {
      lines.back() = longer;
    } else {
      lines.push_back(part);
    }
    from = end + 1;
  }
  return lines;
}

// Returns the size of a plate for lines of text.
cv::Size PlateSize(const std::vector<std::string>& lines, const Layout& layout,
                   const Fonts& fonts) {
  int width = 0;
  for (const std::string& line : lines) width = std::max(width, fonts.bold.Width(line));
  return {width + layout.Px(kPlateMargins), layout.Px(2.0 + kPlateRow * double(lines.size()))};
}

constexpr double kTextMargin = 2.5;  // around a text without a plate [design units]

// Returns the size of a text without a plate, with its margin.
cv::Size TextSize(const Font& font, const std::string& text, const Layout& layout) {
  const int margin = layout.Px(kTextMargin);
  return {font.Width(text) + 2 * margin, font.cap_height() + 2 * margin};
}

// Returns the upper left corner of a text in a place of TextSize.
cv::Point TextAt(cv::Rect place, const Layout& layout) {
  const int margin = layout.Px(kTextMargin);
  return place.tl() + cv::Point(margin, margin);
}

}  // namespace

FreeSpace BlockSymbols(const FarmSpec& spec, const FarmState& state, const Outlook& outlook,
                       const Layout& layout) {
  FreeSpace space(layout.map.size());
  const double gap = 2.0 * layout.unit;
  for (const auto& port : spec.ports) {
    if (!InGrid(spec, port.cell.x, port.cell.y)) continue;
    space.Block(
        Around(layout.view.ToPixel(port.cell.x, port.cell.y), layout.port_radius_px() + gap));
  }
  std::set<std::pair<int, int>> quays;
  for (const auto& device : state.devices) {
    if (!InGrid(spec, device.x, device.y)) continue;
    const cv::Point2d at = layout.view.ToPixel(device.x, device.y);
    if (device.status == DeviceState::DEPLOYED) {
      const bool is_marked = std::any_of(
          outlook.devices.begin(), outlook.devices.end(),
          [&device](const auto& one) { return one.id == device.id && WorstRisk(one) < 0.0; });
      const double radius = (is_marked ? kDangerRing : kSymbol) * layout.device_radius_px();
      space.Block(WithBar(at, radius + gap, layout));
    } else if (device.status == DeviceState::DELIVERED &&
               quays.insert({device.x, device.y}).second) {
      space.Block(Around(at, 30.0 * layout.unit));  // rows of delivered devices
    }
  }
  for (const auto& device : spec.devices) {  // the former cells of fetched devices
    if (device.self_propelled || !InGrid(spec, device.x, device.y)) continue;
    space.Block(Around(layout.view.ToPixel(device.x, device.y), layout.device_radius_px()));
  }
  for (const auto& ship : state.ships) {
    if (!ship.visible || !ship.active || !InGrid(spec, ship.x, ship.y)) continue;
    space.Block(
        WithBar(ShipPlace(spec, state, ship, layout), 1.1 * layout.ship_radius_px(), layout));
  }
  const std::vector<SignPlace> signs = PlaceSigns(state, layout);
  for (std::size_t i = 0; i < signs.size(); ++i) {
    if (!IsDrawn(state.disasters[i])) continue;
    const SignPlace& sign = signs[i];
    // LabelPointers places the label of a pointer just outside this square.
    space.Block(Around(sign.at, (sign.is_inside ? 12.0 : 14.0) * layout.unit));
    const cv::Point2d middle = (sign.at + sign.arrow_to) * 0.5;
    const cv::Point2d half(std::abs(sign.arrow_to.x - sign.at.x) / 2.0 + 8.0 * layout.unit,
                           std::abs(sign.arrow_to.y - sign.at.y) / 2.0 + 8.0 * layout.unit);
    space.Block({cvFloor(middle.x - half.x), cvFloor(middle.y - half.y), cvCeil(2.0 * half.x),
                 cvCeil(2.0 * half.y)});
  }
  return space;
}

void DrawDangerMarks(cv::Mat& map, const FarmSpec& spec, const FarmState& state,
                     const Outlook& outlook, const Layout& layout) {
  for (const DeviceOutlook& one : outlook.devices) {
    const DeviceState* device = Find(state, one.id);
    const double risk = WorstRisk(one);
    if (device == nullptr || !(risk < 0.0)) continue;
    const cv::Point2d at = layout.view.ToPixel(device->x, device->y);
    const double radius = layout.device_radius_px();
    const cv::Scalar color = Bgr(RiskColor(risk, layout));
    const bool is_first = IsHitFirst(spec, outlook, one);
    for (const double times :
         is_first ? std::vector<double>{1.5, kDangerRing} : std::vector<double>{1.5}) {
      StrokeCircle(map, at, times * radius, Bgr(layout.style->halo), layout.Px(4));
      StrokeCircle(map, at, times * radius, color, layout.Px(2));
    }
  }
}

std::set<std::int32_t> LabelDanger(cv::Mat& map, const FarmSpec& spec, const FarmState& state,
                                   const Outlook& outlook, LabelSpace& space, const Layout& layout,
                                   const Fonts& fonts) {
  std::set<std::int32_t> labelled;
  std::size_t tries = 0;
  for (const DeviceOutlook& one : outlook.devices) {
    const DeviceState* device = Find(state, one.id);
    const std::string danger = DangerText(spec, one);
    if (device == nullptr || danger.empty()) continue;
    if (tries++ == kMaxDangerLabels) break;
    const auto lines = BrokenAtCommas(DeviceLabel(one.id) + ": " + danger, kMaxLine, layout, fonts);
    const cv::Point2d at = layout.view.ToPixel(device->x, device->y);
    const cv::Size size = PlateSize(lines, layout, fonts);
    auto plate = space.Take(Cover::kNothing, size, at, 110.0 * layout.unit);
    if (!plate) plate = space.Take(size, at, 140.0 * layout.unit);
    if (!plate) continue;
    const Rgb color = RiskColor(WorstRisk(one), layout);
    DrawLeader(map, at, kDangerRing * layout.device_radius_px(), *plate, color, space, layout);
    DrawPlate(map, *plate, lines, color, layout, fonts);
    labelled.insert(one.id);
  }
  return labelled;
}

namespace {

// A point of a ring on the map, and the direction away from the centre.
struct RingPoint {
  cv::Point2d at;
  cv::Point2d outwards;
};

// Returns points of a ring that are on the map, those nearest to the middle of the map first.
std::vector<RingPoint> PointsOnMap(const DisasterState& disaster, std::size_t ring, cv::Size map,
                                   const Layout& layout) {
  constexpr int kBearings = 72;
  const cv::Point2d middle(map.width / 2.0, map.height / 2.0);
  const cv::Rect2d inside(0.0, 0.0, map.width, map.height);
  const auto radii = RingQuadrants(disaster, ring);
  const cv::Point2d centre = layout.view.ToPixel(disaster.x, disaster.y);
  const cv::Point2d towards = middle - centre;
  const double half_map = cv::norm(middle);
  // Seen from a centre far outside, the map spans a narrow range of bearings.
  const bool is_far = cv::norm(towards) > half_map;
  const double half = is_far ? std::asin(half_map / cv::norm(towards)) : CV_PI;
  const double first = std::atan2(towards.x, -towards.y) - half;
  std::vector<RingPoint> points;
  for (int i = 0; i < kBearings; ++i) {
    double bearing = std::fmod(first + 2.0 * half * i / (kBearings - 1), 2.0 * CV_PI);
    if (bearing < 0.0) bearing += 2.0 * CV_PI;
    const double radius = radii[std::min<std::size_t>(3, std::size_t(bearing / (CV_PI / 2.0)))];
    const cv::Point2d at = layout.view.ToPixel(double(disaster.x) + radius * std::sin(bearing),
                                               double(disaster.y) + radius * std::cos(bearing));
    if (!(radius > 0.0) || !inside.contains(at)) continue;
    points.push_back({at, {std::sin(bearing), -std::cos(bearing)}});
  }
  std::sort(points.begin(), points.end(), [&middle](const auto& a, const auto& b) {
    return cv::norm(a.at - middle) < cv::norm(b.at - middle);
  });
  return points;
}

// A place for one of several texts.
struct TextPlace {
  std::size_t text{};  // index of the text
  cv::Rect place;
};

// Finds and takes a place for the label of a ring: on its line, else outside it, else inside it.
// @param sizes  size of each possible text; the first that fits is chosen
std::optional<TextPlace> PlaceBesideRing(const std::vector<RingPoint>& points,
                                         const std::vector<cv::Size>& sizes, FreeSpace& space,
                                         const Layout& layout) {
  for (const double side : {0.0, 1.0, -1.0}) {
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      for (const RingPoint& point : points) {
        const double away = std::abs(point.outwards.x) * sizes[i].width / 2.0 +
                            std::abs(point.outwards.y) * sizes[i].height / 2.0 + 6.0 * layout.unit;
        const auto place =
            space.Take(sizes[i], point.at + point.outwards * (side * away), 5.0 * layout.unit);
        if (place) return TextPlace{i, *place};
      }
    }
  }
  return std::nullopt;
}

// Marks the lines of all rings but one as used.
void BlockOtherRings(const FarmState& state, const DisasterState& own, std::size_t own_ring,
                     cv::Size map, FreeSpace& space, const Layout& layout) {
  for (const DisasterState& disaster : state.disasters) {
    if (!IsDrawn(disaster)) continue;
    for (std::size_t ring = 0; ring < disaster.radii.size(); ++ring) {
      if (&disaster == &own && ring == own_ring) continue;
      for (const RingPoint& point : PointsOnMap(disaster, ring, map, layout)) {
        space.Block(Around(point.at, 2.0 * layout.unit));
      }
    }
  }
}

}  // namespace

void LabelRings(cv::Mat& map, const FarmState& state, const std::vector<Course>& courses,
                LabelSpace& space, const Layout& layout, const Fonts& fonts) {
  const bool are_several =
      std::count_if(state.disasters.begin(), state.disasters.end(), IsDrawn) > 1;
  const Style& style = *layout.style;
  for (std::size_t index = 0; index < state.disasters.size(); ++index) {
    const DisasterState& disaster = state.disasters[index];
    const std::vector<std::int32_t>& winds = courses[index].ring_winds_kt;
    if (!IsDrawn(disaster)) continue;
    for (std::size_t ring = 0; ring < std::min(disaster.radii.size(), disaster.risks.size());
         ++ring) {
      const std::string risk = Number(double(disaster.risks[ring]), 0);
      const std::string wind = ring < winds.size() ? aquafarm::RingName(winds[ring]) + ", " : "";
      // The second text is for a ring with little space. Rings of several disasters have no plates,
      // because many plates would cover the rings. They always have their kind, because rings of
      // different disasters may have the same risk.
      const std::vector<std::string> texts =
          are_several ? std::vector<std::string>{DisasterName(disaster.kind) + " " + risk}
                      : std::vector<std::string>{wind + "risk " + risk, "risk " + risk};
      std::vector<cv::Size> sizes;
      for (const std::string& text : texts) {
        sizes.push_back(are_several ? TextSize(fonts.bold, text, layout)
                                    : PlateSize({text}, layout, fonts));
      }
      FreeSpace water = space.space(Cover::kNothing);
      BlockOtherRings(state, disaster, ring, map.size(), water, layout);
      const auto found =
          PlaceBesideRing(PointsOnMap(disaster, ring, map.size(), layout), sizes, water, layout);
      if (!found) continue;  // only the key of risks explains the ring
      const auto& [text, place] = *found;
      space.Add(place);
      const Rgb color = RiskColor(double(disaster.risks[ring]), layout);
      if (are_several) {
        DrawLabel(map, fonts.bold, texts[text], TextAt(place, layout), layout,
                  Mix(color, style.label, 0.3));
      } else {
        DrawPlate(map, place, {texts[text]}, color, layout, fonts);
      }
    }
  }
}

namespace {

// Takes the nearest free place; nullopt if there is none or the line to it would cross a label.
std::optional<cv::Rect> TakeInSight(LabelSpace& space, Cover cover, cv::Size size,
                                    cv::Point2d symbol, double farthest) {
  const FreeSpace& open = space.space(cover);
  const auto place = open.Find(size, symbol, farthest);
  if (!place || open.CrossesLabel(symbol, NearestIn(*place, symbol), *place)) return std::nullopt;
  space.Add(*place);
  return place;
}

}  // namespace

void LabelPointers(cv::Mat& map, const FarmSpec& spec, const FarmState& state,
                   const std::vector<Course>& courses, LabelSpace& space, const Layout& layout,
                   const Fonts& fonts) {
  const std::vector<SignPlace> signs = PlaceSigns(state, layout);
  for (std::size_t i = 0; i < signs.size(); ++i) {
    const DisasterState& disaster = state.disasters[i];
    const SignPlace& sign = signs[i];
    if (!IsDrawn(disaster) || sign.is_inside) continue;
    const std::string centre = CentreText(spec, disaster, courses[i]);
    const std::string closest = ClosestText(spec, courses[i]);
    std::vector<std::string> texts{centre};
    if (!closest.empty()) texts.insert(texts.begin(), centre + ", closest " + closest);
    // A place next to the pointer is tried first, because labels of other pointers may be above and
    // below it. If the text does not fit there, shorter lines are tried.
    std::vector<std::string> lines;
    cv::Size size;
    cv::Point2d place_aside;
    std::optional<cv::Rect> place;
    const auto break_lines = [&](const std::string& text, double width) {
      lines = BrokenAtCommas(text, width, layout, fonts);
      if (layout.panel.empty()) lines.push_back(MotionNow(spec, disaster));
      size = PlateSize(lines, layout, fonts);
      const double aside = size.width / 2.0 + 15.0 * layout.unit;
      place_aside = {sign.at.x < map.cols / 2.0 ? sign.at.x + aside : sign.at.x - aside, sign.at.y};
    };
    for (const std::string& text : texts) {
      for (const double width : {kMaxLine, 0.0}) {
        if (place) break;
        break_lines(text, width);
        place = space.Take(Cover::kNothing, size, place_aside, 24.0 * layout.unit);
      }
    }
    for (const double reach : {0.8, 1.2}) {  // still with short lines
      if (!place) place = TakeInSight(space, Cover::kNothing, size, sign.at, reach * size.width);
    }
    if (!place) place = space.Take(Cover::kPaths, size, place_aside, 24.0 * layout.unit);
    if (!place) break_lines(centre, kMaxLine);
    if (!place) place = space.Take(Cover::kPaths, size, place_aside, 24.0 * layout.unit);
    if (!place) place = TakeInSight(space, Cover::kPaths, size, sign.at, 0.8 * size.width);
    if (!place) place = space.Take(size, place_aside, 24.0 * layout.unit);
    if (!place) place = space.Take(size, sign.at, double(map.cols + map.rows));
    if (!place) continue;
    const Rgb color = GradeColor(disaster.grade);
    DrawLeader(map, sign.at, 9.0 * layout.unit, *place, color, space, layout);
    DrawPlate(map, *place, lines, color, layout, fonts);
  }
}

void LabelDevices(cv::Mat& map, const FarmSpec& spec, const FarmState& state,
                  const std::set<std::int32_t>& labelled, LabelSpace& space, const Layout& layout,
                  const Fonts& fonts) {
  for (const auto& device : state.devices) {
    if (!IsLabelled(spec, device) || labelled.count(device.id) > 0) continue;
    const std::string text = DeviceLabel(device.id);
    const cv::Size size = TextSize(fonts.bold, text, layout);
    const double radius = layout.device_radius_px();
    const cv::Point2d at = layout.view.ToPixel(device.x, device.y);
    const cv::Point2d aside(1.3 * radius + size.width / 2.0 + 4.0 * layout.unit, 0.0);
    std::optional<cv::Rect> place;  // next to the symbol, else near its right side
    for (const cv::Point2d& offset : {aside, -aside}) {
      if (!place) place = space.Take(Cover::kNothing, size, at + offset, 6.0 * layout.unit);
    }
    const cv::Point2d east = at + cv::Point2d(radius, 0.0);
    if (!place) place = space.Take(size, east, 3.0 * radius + 20.0 * layout.unit);
    if (!place) continue;
    DrawLabel(map, fonts.bold, text, TextAt(*place, layout), layout);
  }
}

namespace {

// Returns the rank of a device in the order of pickups, "1. "; "" if there are several ships.
std::string OrderText(const FarmSpec& spec, const FarmState& state, const Trail& trail,
                      std::int64_t at_s) {
  if (state.ships.size() > 1) return "";
  const auto before = std::count_if(spec.devices.begin(), spec.devices.end(), [&](const auto& one) {
    const auto other_s = trail.FetchedAt(one.id);
    return other_s && *other_s < at_s;
  });
  return std::to_string(before + 1) + ". ";
}

}  // namespace

void LabelFetched(cv::Mat& map, const FarmSpec& spec, const FarmState& state, const Trail* trail,
                  LabelSpace& space, const Layout& layout, const Fonts& fonts) {
  for (const DeviceState& device : spec.devices) {
    const DeviceState* now = Find(state, device.id);
    const bool was_fetched = now != nullptr && now->status != DeviceState::DEPLOYED;
    if (!was_fetched || device.self_propelled || !InGrid(spec, device.x, device.y)) continue;
    const auto at_s = trail == nullptr ? std::nullopt : trail->FetchedAt(device.id);
    const std::string text = at_s ? OrderText(spec, state, *trail, *at_s) + DeviceLabel(device.id) +
                                        " " + TimeOfDay(spec, *at_s)
                                  : DeviceLabel(device.id);
    const cv::Size size = TextSize(fonts.small, text, layout);
    const double radius = layout.device_radius_px();
    const cv::Point2d at = layout.view.ToPixel(device.x, device.y);
    const cv::Point2d aside(1.2 * radius + size.width / 2.0, 0.0);
    const cv::Point2d above(0.0, -1.4 * radius - size.height / 2.0);
    std::optional<cv::Rect> place;  // next to the outline
    for (const cv::Point2d& offset : {aside, -aside, above, -above}) {
      if (!place) place = space.Take(Cover::kNothing, size, at + offset, 12.0 * layout.unit);
    }
    if (!place) place = space.Take(Cover::kPaths, size, at, size.width / 2.0 + 3.0 * radius);
    if (!place) continue;
    DrawLabel(map, fonts.small, text, TextAt(*place, layout), layout,
              Mix(layout.style->label, layout.style->sea_south, 0.25));
  }
}

void LabelShips(cv::Mat& map, const FarmSpec& spec, const FarmState& state, LabelSpace& space,
                const Layout& layout, const Fonts& fonts) {
  if (state.ships.size() < 2) return;
  for (const auto& ship : state.ships) {
    if (!ship.visible || !ship.active || ship.own_device >= 0) continue;
    if (!InGrid(spec, ship.x, ship.y)) continue;
    const std::string text = "ship " + std::to_string(ship.id);
    const cv::Size size = TextSize(fonts.bold, text, layout);
    const cv::Point2d at = ShipPlace(spec, state, ship, layout);
    // A label next to its ship may cover a path, so that it is not next to another symbol.
    const double above = layout.ship_radius_px() + size.height + 8.0 * layout.unit;
    const double aside = 2.0 * layout.ship_radius_px() + size.width / 2.0 + 6.0 * layout.unit;
    auto place = space.Take(Cover::kNothing, size, at, above);
    if (!place) place = space.Take(Cover::kPaths, size, at, above);
    if (!place) place = space.Take(size, at, aside);
    if (!place) continue;
    const Rgb color = Mix(ShipColor(ship.id), layout.style->label, 0.7);
    DrawLeader(map, at, layout.ship_radius_px(), *place, color, space, layout);
    DrawLabel(map, fonts.bold, text, TextAt(*place, layout), layout, color);
  }
}

}  // namespace aquafarm_viz
