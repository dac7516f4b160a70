// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/markers/markers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/base/disaster_kinds.h"
#include "aquafarm_viz/base/palette.h"
#include "aquafarm_viz/base/text.h"
#include "aquafarm_viz/names.h"
#include "aquafarm_viz/scene/directions.h"
#include "aquafarm_viz/scene/labels.h"
#include "aquafarm_viz/scene/rings.h"
#include "markers/axes.h"
#include "markers/legend.h"
#include "markers/maker.h"
#include "markers/rings.h"
#include "scene/arrow.h"
#include "scene/nautical.h"
#include "scene/ship_place.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DeviceState;
using aquafarm_msgs::DisasterState;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;
using aquafarm_msgs::ShipState;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double kShapeNorthDeg = 0.0;   // outlines point north
constexpr double kArrowNorthDeg = 90.0;  // rviz arrows point along x
constexpr double kShipSize = 0.74;       // half the length of a rescue ship [thing_m()]
constexpr double kBetweenHeads = 2.5;    // min distance between arrowheads [thing_m()]

Marker Sea(const Maker& maker, const FarmSpec& spec) {
  Marker sea = maker.Make("sea", 0, Marker::CUBE, kSeaLayer, (spec.width - 1) / 2.0,
                          (spec.height - 1) / 2.0);
  sea.scale.x = spec.width * maker.cell_m();
  sea.scale.y = spec.height * maker.cell_m();
  sea.scale.z = 0.5 * maker.layer_m();
  sea.color = Color(Mix(kSeaDeep, kSeaShallow, 0.25));
  return sea;
}

// Adds a flat convex shape in a cell to a list of triangles.
void AddCell(Marker& marker, const Maker& maker, const aquafarm_msgs::Cell& cell,
             const std::vector<cv::Point2f>& outline, double size_cells) {
  const auto corner = [&](cv::Point2f point) {
    return Point((cell.x + point.x * size_cells) * maker.cell_m(),
                 (cell.y + point.y * size_cells) * maker.cell_m());
  };
  for (std::size_t i = 2; i < outline.size(); ++i) {
    marker.points.push_back(corner(outline[0]));
    marker.points.push_back(corner(outline[i - 1]));
    marker.points.push_back(corner(outline[i]));
  }
}

Marker Island(const Maker& maker, const FarmSpec& spec) {
  static const std::vector<cv::Point2f> kSquare{
      {-0.5F, -0.5F}, {0.5F, -0.5F}, {0.5F, 0.5F}, {-0.5F, 0.5F}};
  Marker island = maker.Make("island", 0, Marker::TRIANGLE_LIST, kLandLayer, 0, 0);
  island.color = Color(kLand);
  for (const auto& cell : spec.islands) {
    if (InGrid(spec, cell.x, cell.y)) AddCell(island, maker, cell, kSquare, 1.0);
  }
  return island;
}

// Returns lines in the cells of islands, along the sides that border water.
Marker Shore(const Maker& maker, const FarmSpec& spec) {
  constexpr float kWidth = 0.12F;  // [cells]
  Marker shore = maker.Make("shore", 0, Marker::TRIANGLE_LIST, kLandLayer, 0, 0);
  shore.pose.position.z += 0.4 * maker.layer_m();  // over the land, below the rings
  shore.color = Color(kSand);
  std::set<std::pair<int, int>> land;
  for (const auto& cell : spec.islands) land.emplace(cell.x, cell.y);
  for (const auto& cell : spec.islands) {
    if (!InGrid(spec, cell.x, cell.y)) continue;
    for (const auto& [x, y] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
      if (!InGrid(spec, cell.x + x, cell.y + y) || land.count({cell.x + x, cell.y + y}) > 0) {
        continue;
      }
      const cv::Point2f out(0.5F * float(x), 0.5F * float(y));
      const cv::Point2f along(-out.y, out.x);
      const cv::Point2f in = out * (1.0F - 2.0F * kWidth);
      AddCell(shore, maker, cell, {in - along, out - along, out + along, in + along}, 1.0);
    }
  }
  return shore;
}

Marker Rocks(const Maker& maker, const FarmSpec& spec) {
  static const std::vector<cv::Point2f> kRockOutline{
      {-0.95F, -0.55F}, {0.8F, -0.6F}, {0.9F, -0.1F}, {0.4F, 0.55F}, {-0.1F, 0.8F}, {-0.6F, 0.25F}};
  Marker rocks = maker.Make("rocks", 0, Marker::TRIANGLE_LIST, kRockLayer, 0, 0);
  rocks.color = Color(kRock);
  for (const auto& rock : spec.rocks) {
    if (InGrid(spec, rock.cell.x, rock.cell.y)) {
      AddCell(rocks, maker, rock.cell, kRockOutline, 0.42);
    }
  }
  return rocks;
}

void AddPorts(MarkerArray& array, const Maker& maker, const FarmSpec& spec) {
  for (const auto& port : spec.ports) {
    if (!InGrid(spec, port.cell.x, port.cell.y)) continue;
    Marker disc =
        maker.Make("port", port.id, Marker::CYLINDER, kPortLayer, port.cell.x, port.cell.y);
    disc.scale.x = disc.scale.y = 0.95 * maker.thing_m();
    disc.scale.z = 0.5 * maker.layer_m();
    disc.color = Color(kPort);
    array.markers.push_back(disc);
    Marker letter =
        maker.Text("port_letter", port.id, port.cell.x, port.cell.y, PortLetter(port.id),
                   std::max(0.8 * maker.thing_m(), maker.word_m()), kInk);
    letter.pose.position.z = kDeviceLayer * maker.layer_m();  // below ships
    array.markers.push_back(letter);
  }
}

// Adds the arrows of the legal moves around each port.
void AddDirections(MarkerArray& array, const Maker& maker, const FarmSpec& spec) {
  const double thing = maker.thing_m() / maker.cell_m();
  for (const auto& port : LegalDirections(spec)) {
    if (port.actions.empty()) continue;  // rviz warns about lists without points
    Marker arrows = maker.Make("port_direction", port.port, Marker::TRIANGLE_LIST, kPortLayer,
                               port.cell.x, port.cell.y);
    arrows.color = Color(kDirectionColor);
    for (const std::uint8_t action : port.actions) {
      const int bearing = MoveBearingDeg(action);
      const double turn = bearing * CV_PI / 180.0;
      AddArrow(arrows, thing * std::sin(turn), thing * std::cos(turn), bearing, maker.cell_m(),
               1.2 * thing);
    }
    array.markers.push_back(arrows);
  }
}

// Writes the label of each deployed device at a corner of its symbol: south-east of it or, if a
// ship is there, at the next corner where no ship is.
void AddLabels(MarkerArray& array, const Maker& maker, const FarmSpec& spec,
               const FarmState& state) {
  const double thing = maker.thing_m() / maker.cell_m();
  const double aside = 0.75 * thing;
  std::vector<cv::Point2d> ships;
  for (const auto& ship : state.ships) {
    if (!ship.visible || !ship.active) continue;
    ships.push_back(ShipPlace(spec, state, ship.x, ship.y, kShipAside * thing));
  }
  const auto is_free = [&](cv::Point2d at) {
    return std::none_of(ships.begin(), ships.end(),
                        [&](cv::Point2d ship) { return cv::norm(ship - at) < thing; });
  };
  for (const auto& device : state.devices) {
    if (!IsLabelled(spec, device)) {
      array.markers.push_back(maker.Delete("device_label", device.id));
      continue;
    }
    const cv::Point2d here(device.x, device.y);
    const std::array<cv::Point2d, 4> corners{
        here + cv::Point2d(aside, -aside), here + cv::Point2d(-aside, -aside),
        here + cv::Point2d(-aside, aside), here + cv::Point2d(aside, aside)};
    const auto* found = std::find_if(corners.begin(), corners.end(), is_free);
    const cv::Point2d at = found == corners.end() ? corners.front() : *found;
    array.markers.push_back(maker.Text("device_label", device.id, at.x, at.y,
                                       DeviceLabel(device.id), maker.word_m(), kDirectionColor));
  }
}

void AddHealth(MarkerArray& array, const Maker& maker, const DeviceState& device, double x,
               double y, double width_m) {
  const double height_m = 0.16 * maker.thing_m();
  Marker frame = maker.Make("health_frame", device.id, Marker::CUBE, kCargoLayer, x, y);
  frame.scale.x = width_m * 1.08;
  frame.scale.y = height_m * 1.5;
  frame.scale.z = 0.5 * maker.layer_m();
  frame.color = Color(kInk);
  array.markers.push_back(frame);
  const double share = std::clamp(static_cast<double>(device.health), 0.0, 1.0);
  const double full_left = x - width_m / maker.cell_m() * (1.0 - share) / 2.0;
  Marker bar = maker.Make("health", device.id, Marker::CUBE, kBarLayer, full_left, y);
  // rviz refuses a scale of 0.
  bar.scale.x = std::max(share, 1e-3) * width_m;
  bar.scale.y = height_m;
  bar.scale.z = 0.5 * maker.layer_m();
  bar.color = Color(HealthColor(share));
  array.markers.push_back(bar);
}

// Adds the outlines of fetched devices in their former cells.
void AddFetched(MarkerArray& array, const Maker& maker, const FarmSpec& spec,
                const FarmState& state) {
  std::set<std::int32_t> fetched;
  for (const auto& device : state.devices) {
    if (device.status != DeviceState::DEPLOYED) fetched.insert(device.id);
  }
  for (const auto& device : spec.devices) {
    if (device.self_propelled || !InGrid(spec, device.x, device.y)) continue;
    if (fetched.count(device.id) == 0) {
      array.markers.push_back(maker.Delete("fetched", device.id));
      continue;
    }
    Marker outline =
        maker.Make("fetched", device.id, Marker::TRIANGLE_LIST, kRockLayer, device.x, device.y);
    outline.color = Color(Mix(DeviceColor(device.kind), kSeaDeep, 0.2));
    AddOutline(outline, DeviceOutline(device.kind), 0.42 * maker.thing_m());
    array.markers.push_back(outline);
  }
}

void AddDevices(MarkerArray& array, const Maker& maker, const FarmSpec& spec,
                const FarmState& state) {
  std::map<std::pair<int, int>, int> delivered;
  const double thing = maker.thing_m() / maker.cell_m();
  for (const auto& device : state.devices) {
    if (!InGrid(spec, device.x, device.y)) {
      for (const char* space : {"device", "health", "health_frame"}) {
        array.markers.push_back(maker.Delete(space, device.id));
      }
      continue;
    }
    double x = device.x;
    double y = device.y;
    double size = 0.42;
    Layer layer = kDeviceLayer;
    Rgb color = device.health_known ? Mix(kUnknown, DeviceColor(device.kind),
                                          0.35 + 0.65 * static_cast<double>(device.health))
                                    : kUnknown;
    const bool done = device.status == DeviceState::DELIVERED;
    if (done) {
      const int index = delivered[{device.x, device.y}]++;
      const int column = index % 4;
      const int row = index / 4;
      x += thing * (0.35 * column - 0.5);
      y += DeliveredSide(spec, device.y) * thing * (0.75 + 0.35 * row);
      size = 0.18;
      color = Mix(DeviceColor(device.kind), kUnknown, 0.35);
    } else if (device.status == DeviceState::ABOARD) {
      const cv::Point2d at = ShipPlace(spec, state, device.x, device.y, kShipAside * thing);
      x = at.x;
      y = at.y;
      size = 0.24;
      layer = kCargoLayer;
    }
    array.markers.push_back(maker.Shape("device", device.id, layer, x, y,
                                        DeviceOutline(device.kind), size * maker.thing_m(), color));
    if (done || !device.health_known) {
      array.markers.push_back(maker.Delete("health", device.id));
      array.markers.push_back(maker.Delete("health_frame", device.id));
    } else {
      AddHealth(array, maker, device, x, y + 0.66 * thing, 0.9 * maker.thing_m());
    }
  }
}

void AddShip(MarkerArray& array, const Maker& maker, const ShipState& ship, cv::Point2d at,
             bool is_named, const Trail* trail) {
  static const std::vector<cv::Point2f> kBow{{0.0F, 1.25F}, {-0.5F, 0.6F}, {0.5F, 0.6F}};
  static const std::vector<cv::Point2f> kDeck{{-0.22F, 0.42F}, {-0.26F, -0.1F}, {-0.22F, -0.68F},
                                              {0.22F, -0.68F}, {0.26F, -0.1F},  {0.22F, 0.42F}};
  const auto turned = Turned(ShipBearingDeg(ship, trail), kShapeNorthDeg);
  const bool own = ship.own_device >= 0;
  Marker hull = maker.Shape("ship", ship.id, kShipLayer, at.x, at.y, own ? kBow : HullOutline(),
                            (own ? 0.42 : kShipSize) * maker.thing_m(), kPaper);
  hull.pose.orientation = turned;
  array.markers.push_back(hull);
  if (own) return;
  Marker deck = maker.Shape("ship_deck", ship.id, kDeckLayer, at.x, at.y, kDeck,
                            kShipSize * maker.thing_m(), ShipColor(ship.id));
  deck.pose.orientation = turned;
  array.markers.push_back(deck);
  if (!is_named) return array.markers.push_back(maker.Delete("ship_name", ship.id));
  const double aside = 0.75 * maker.thing_m() / maker.cell_m();
  array.markers.push_back(maker.Text("ship_name", ship.id, at.x + aside, at.y - aside,
                                     std::to_string(ship.id), maker.word_m(), kPaper));
}

// Adds the trail of a ship. Older moves are more transparent. Each move is a rectangle, because
// the lines of rviz have an uneven width in the top-down view. The trail runs to the right of the
// cells' centres, so that moves in opposite directions do not cover each other.
void AddPath(MarkerArray& array, const Maker& maker, const FarmState& state, const ShipState& ship,
             const Trail* trail) {
  const ShipTrail* way = trail == nullptr ? nullptr : trail->Find(ship.id);
  const std::size_t count = way == nullptr ? 0 : way->places.size();
  if (count < 2) return array.markers.push_back(maker.Delete("path", ship.id));
  Marker path = maker.Make("path", ship.id, Marker::TRIANGLE_LIST, kPortLayer, 0, 0);
  path.color =
      Color(state.ships.size() > 1 ? Mix(ShipColor(ship.id), kPaper, 0.35) : HealthColor(1.0));
  const double half_m = 0.06 * maker.thing_m();
  double since_head_m = 0.0;
  for (std::size_t i = 1; i < count; ++i) {
    cv::Point2d from = cv::Point2d(way->places[i - 1]) * maker.cell_m();
    cv::Point2d to = cv::Point2d(way->places[i]) * maker.cell_m();
    const double length = cv::norm(to - from);
    if (length == 0.0 || Trail::IsGap(way->places[i - 1], way->places[i])) continue;
    const cv::Point2d along = (to - from) * (half_m / length);  // overlaps the next rectangle
    const cv::Point2d side(-along.y, along.x);
    from -= 1.6 * side;
    to -= 1.6 * side;
    const bool is_dash = !way->loaded[i];
    const cv::Point2d a = is_dash ? from + 0.2 * (to - from) : from - along;
    const cv::Point2d b = is_dash ? to - 0.2 * (to - from) : to + along;
    std::vector<cv::Point2d> corners{a - side, b - side, b + side, a - side, b + side, a + side};
    since_head_m += length;
    if (since_head_m >= kBetweenHeads * maker.thing_m()) {  // an arrowhead in the middle
      since_head_m = 0.0;
      const cv::Point2d middle = 0.5 * (from + to);
      corners.insert(corners.end(), {middle - 3.0 * along - 3.5 * side, middle + 5.0 * along,
                                     middle - 3.0 * along + 3.5 * side});
    }
    for (const cv::Point2d& corner : corners) {
      path.points.push_back(Point(corner.x, corner.y));
      path.colors.push_back(path.color);
      path.colors.back().a = static_cast<float>(0.3 + 0.7 * double(i) / double(count - 1));
    }
  }
  if (path.points.empty()) return array.markers.push_back(maker.Delete("path", ship.id));
  array.markers.push_back(path);
}

void AddShips(MarkerArray& array, const Maker& maker, const FarmSpec& spec, const FarmState& state,
              const Trail* trail, bool has_paths) {
  const double aside = kShipAside * maker.thing_m() / maker.cell_m();
  for (const auto& ship : state.ships) {
    if (ship.visible && ship.active && InGrid(spec, ship.x, ship.y)) {
      AddShip(array, maker, ship, ShipPlace(spec, state, ship.x, ship.y, aside),
              /*is_named=*/state.ships.size() > 1, trail);
      AddPath(array, maker, state, ship, has_paths ? trail : nullptr);
      continue;
    }
    array.markers.push_back(maker.Delete("ship", ship.id));
    array.markers.push_back(maker.Delete("path", ship.id));
    if (ship.own_device >= 0) continue;
    array.markers.push_back(maker.Delete("ship_deck", ship.id));
    array.markers.push_back(maker.Delete("ship_name", ship.id));
  }
}

// Returns the radius of the outermost ring north (side 1) or south (-1) of the centre [cells].
double RadiusTowards(const DisasterState& disaster, double side) {
  if (disaster.radii.empty()) return 0.0;
  const auto radii = RingQuadrants(disaster, disaster.radii.size() - 1);  // NE, SE, SW, NW
  return side > 0.0 ? std::max(radii[0], radii[3]) : std::max(radii[1], radii[2]);
}

// Returns whether a rectangle around (x, y) contains a ship, a deployed device or a port.
// @param half_width, half_height  of the rectangle [cells]
bool CoversSymbol(const FarmSpec& spec, const FarmState& state, double x, double y,
                  double half_width, double half_height) {
  const auto is_near = [&](double other_x, double other_y) {
    return std::abs(other_x - x) < half_width && std::abs(other_y - y) < half_height;
  };
  return std::any_of(state.ships.begin(), state.ships.end(),
                     [&](const auto& ship) { return is_near(ship.x, ship.y); }) ||
         std::any_of(state.devices.begin(), state.devices.end(),
                     [&](const auto& device) {
                       return device.status == DeviceState::DEPLOYED && is_near(device.x, device.y);
                     }) ||
         std::any_of(spec.ports.begin(), spec.ports.end(),
                     [&](const auto& port) { return is_near(port.cell.x, port.cell.y); });
}

// Returns how far north of the centre the name of a disaster is [cells]; negative: south of it. The
// preferred place is on the side without the arrow of the motion: outside the rings if they are
// small, next to the centre if they are large. If the name would be off the map or cover a symbol
// there, the other of these two places is tried, and then two places on the other side.
double NameOffset(const Maker& maker, const FarmSpec& spec, const FarmState& state,
                  const DisasterState& disaster, double name_width) {
  const double near =
      std::max(0.9 * maker.thing_m(), 0.4 * maker.thing_m() + 0.75 * maker.word_m()) /
      maker.cell_m();
  const double side =
      disaster.speed > 0.0F && std::cos(disaster.heading_deg * CV_PI / 180.0) < -0.1 ? 1.0 : -1.0;
  const double outside = near + RadiusTowards(disaster, side);
  const bool is_small = outside < 5.0 * near;
  const std::array<double, 4> offsets{
      side * (is_small ? outside : near), side * (is_small ? near : outside),
      -side * (near + RadiusTowards(disaster, -side)), -side * near};
  const auto is_on_map = [&](double offset) {
    const double y = disaster.y + offset;
    return y >= 0.0 && y <= spec.height - 1.0;
  };
  const auto is_free = [&](double offset) {
    return is_on_map(offset) && !CoversSymbol(spec, state, disaster.x, disaster.y + offset,
                                              0.5 * name_width + near, near);
  };
  const auto free = std::find_if(offsets.begin(), offsets.end(), is_free);
  const auto on_map = std::find_if(offsets.begin(), offsets.end(), is_on_map);
  return free != offsets.end() ? *free : on_map != offsets.end() ? *on_map : offsets.front();
}

void AddDisasterSigns(MarkerArray& array, const Maker& maker, const FarmSpec& spec,
                      const FarmState& state, const DisasterState& disaster) {
  Marker eye =
      maker.Make("disaster", disaster.id, Marker::CYLINDER, kSignLayer, disaster.x, disaster.y);
  eye.scale.x = eye.scale.y = 0.7 * maker.thing_m();
  eye.scale.z = 0.5 * maker.layer_m();
  eye.color = Color(GradeColor(disaster.grade));
  array.markers.push_back(eye);
  const std::string name = DisasterName(disaster.kind);
  const double width_m = (TextWidth(name) + 0.8) * maker.word_m();
  const double north = NameOffset(maker, spec, state, disaster, width_m / maker.cell_m());
  AddOnPlate(array, maker, "disaster_name", disaster.id,
             {double(disaster.x), double(disaster.y) + north}, {width_m, 1.2 * maker.word_m()},
             name);
  if (!(disaster.speed > 0.0F)) {
    array.markers.push_back(maker.Delete("heading", disaster.id));
    return;
  }
  Marker heading =
      maker.Make("heading", disaster.id, Marker::ARROW, kSignLayer, disaster.x, disaster.y);
  heading.pose.orientation = Turned(disaster.heading_deg, kArrowNorthDeg);
  heading.scale.x = 2.4 * maker.thing_m();
  heading.scale.y = 0.32 * maker.thing_m();
  heading.scale.z = maker.layer_m();
  heading.color = Color(GradeColor(disaster.grade));
  array.markers.push_back(heading);
}

void AddDisasters(MarkerArray& array, const Maker& maker, const FarmSpec& spec,
                  const FarmState& state, bool has_pointers) {
  for (const auto& disaster : state.disasters) {
    const bool drawn = disaster.known && disaster.steps_left > 0;
    AddRings(array, maker, spec, disaster, drawn);
    // A centre outside the farm has a pointer at the edge instead (danger.h).
    if (drawn && (!has_pointers || IsCentreInFarm(spec, disaster))) {
      AddDisasterSigns(array, maker, spec, state, disaster);
      continue;
    }
    for (const char* space : {"disaster", "disaster_name", "disaster_name_plate", "heading"}) {
      array.markers.push_back(maker.Delete(space, disaster.id));
    }
  }
}

Marker Status(const Maker& maker, const FarmSpec& spec, const FarmState& state) {
  const std::string text = WorldTimeText(spec, state) + "  episode " + Count(state.episode) +
                           "  step " + Count(state.step) + "  return " +
                           Number(state.joint_return, 1);
  return maker.Line("status", kLineOfClock, text, kPaper);
}

}  // namespace

MarkerArray SpecMarkers(const FarmSpec& spec, bool clear, const Layers& layers) {
  const Maker maker(spec, spec.header);
  MarkerArray array;
  if (clear) {
    Marker all = maker.Delete("", 0);
    all.action = Marker::DELETEALL;
    array.markers.push_back(all);
  }
  array.markers.push_back(Sea(maker, spec));
  // rviz warns about lists without points.
  for (auto& list : {Island(maker, spec), Shore(maker, spec), Rocks(maker, spec)}) {
    if (!list.points.empty()) array.markers.push_back(list);
  }
  if (layers.directions) AddDirections(array, maker, spec);
  AddAxes(array, maker, spec);
  AddLegend(array, spec);
  return array;
}

MarkerArray StateMarkers(const FarmSpec& spec, const FarmState& state, const Trail* trail,
                         const Layers& layers) {
  const Maker maker(spec, state.header);
  MarkerArray array;
  AddDisasters(array, maker, spec, state, layers.risk);
  AddPorts(array, maker, spec);
  AddFetched(array, maker, spec, state);
  AddDevices(array, maker, spec, state);
  AddShips(array, maker, spec, state, trail, /*has_paths=*/layers.trail);
  if (layers.labels) AddLabels(array, maker, spec, state);
  array.markers.push_back(Status(maker, spec, state));
  return array;
}

MarkerArray Joined(MarkerArray first, const MarkerArray& second) {
  std::set<std::pair<std::string, std::int32_t>> replaced;
  for (const Marker& marker : second.markers) replaced.emplace(marker.ns, marker.id);
  const auto is_replaced = [&replaced](const Marker& marker) {
    return marker.action != Marker::DELETEALL && replaced.count({marker.ns, marker.id}) > 0;
  };
  first.markers.erase(std::remove_if(first.markers.begin(), first.markers.end(), is_replaced),
                      first.markers.end());
  first.markers.insert(first.markers.end(), second.markers.begin(), second.markers.end());
  return first;
}

}  // namespace aquafarm_viz
