// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/scene/labels.h"
#include "draw/free_space.h"
#include "draw/symbols.h"
#include "scene/ship_place.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DeviceState;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;
using aquafarm_msgs::ShipState;

// `at` is the centre of the bar.
void DrawHealthBar(cv::Mat& map, cv::Point2d at, double width_px, double health,
                   const Layout& layout) {
  const int width = std::max(6, cvRound(width_px));
  const int height = std::max(3, layout.Px(5));
  const cv::Rect frame(cvRound(at.x - width / 2.0), cvRound(at.y - height / 2.0), width, height);
  cv::rectangle(map, frame, Bgr(kInk), cv::FILLED);
  const double share = std::clamp(health, 0.0, 1.0);
  const int filled = cvRound((width - 2) * share);
  if (filled < 1) return;
  cv::rectangle(map, cv::Rect(frame.x + 1, frame.y + 1, filled, std::max(1, height - 2)),
                Bgr(HealthColor(share)), cv::FILLED);
}

const DeviceState* FindDevice(const FarmState& state, std::int32_t id) {
  if (id < 0) return nullptr;
  const auto index = static_cast<std::size_t>(id);
  if (index < state.devices.size() && state.devices[index].id == id) return &state.devices[index];
  const auto found = std::find_if(state.devices.begin(), state.devices.end(),
                                  [id](const DeviceState& device) { return device.id == id; });
  return found == state.devices.end() ? nullptr : &*found;
}

void DrawPort(cv::Mat& image, cv::Point2d at, std::int32_t id, const Layout& layout,
              const Fonts& fonts) {
  const double radius = layout.port_radius_px();
  FillCircle(image, at, radius, Bgr(kPort));
  StrokeCircle(image, at, radius, Bgr(kInk), layout.Px(1.5));
  const std::string letter = PortLetter(id);
  fonts.bold.Draw(image, letter,
                  {cvRound(at.x + 0.5 - fonts.bold.Width(letter) / 2.0),
                   cvRound(at.y + 0.5 + fonts.bold.cap_height() / 2.0)},
                  Bgr(kInk));
}

// Returns offsets that place several objects in one cell around its centre.
class Crowd {
 public:
  cv::Point2d Offset(int x, int y, int of, double radius_px) {
    const int index = seen_[{x, y}]++;
    if (of <= 1) return {0.0, 0.0};
    const double angle = CV_PI * (0.75 + 2.0 * index / of);
    return {radius_px * std::cos(angle), radius_px * std::sin(angle)};
  }

 private:
  std::map<std::pair<int, int>, int> seen_;
};

std::map<std::pair<int, int>, int> ShipsPerCell(const FarmState& state) {
  std::map<std::pair<int, int>, int> count;
  for (const auto& ship : state.ships) {
    if (ship.visible && ship.active) ++count[{ship.x, ship.y}];
  }
  return count;
}

void DrawRescueShip(cv::Mat& map, const FarmState& state, const ShipState& ship,
                    const Pose2& placing, const Layout& layout) {
  static const std::vector<cv::Point2f> kDeck{{-0.22F, 0.42F}, {-0.26F, -0.1F}, {-0.22F, -0.68F},
                                              {0.22F, -0.68F}, {0.26F, -0.1F},  {0.22F, 0.42F}};
  StrokeShape(map, HullOutline(), placing, Bgr(kInk), layout.Px(2.4));
  FillShape(map, HullOutline(), placing, Bgr(kPaper));
  FillShape(map, kDeck, placing, Bgr(ShipColor(ship.id)));
  double above = placing.size_px + layout.Px(4);
  for (std::size_t i = 0; i < ship.aboard.size() && i < 3; ++i) {
    const DeviceState* cargo = FindDevice(state, ship.aboard[i]);
    if (cargo == nullptr) continue;
    const cv::Point2d at = Place({0.0, -0.1 - 0.28 * double(i)}, placing);
    DrawDeviceSymbol(map, cargo->kind, {at, 0.40 * placing.size_px, 0.0}, 0.0);
    if (cargo->health_known) {
      DrawHealthBar(map, placing.at - cv::Point2d(0.0, above), 1.5 * placing.size_px, cargo->health,
                    layout);
    }
    above += layout.Px(5);
  }
}

void DrawSelfPropelled(cv::Mat& map, const FarmState& state, const ShipState& ship,
                       const Pose2& placing, const Layout& layout) {
  static const std::vector<cv::Point2f> kBow{{0.0F, 1.25F}, {0.45F, 0.7F}, {-0.45F, 0.7F}};
  const double radius = layout.device_radius_px();
  const DeviceState* device = FindDevice(state, ship.own_device);
  const Pose2 own{placing.at, radius, placing.bearing_deg};
  StrokeShape(map, kBow, own, Bgr(kInk), 2);
  FillShape(map, kBow, own, Bgr(kPaper));
  DrawDeviceSymbol(map, device == nullptr ? 255 : device->kind, {placing.at, radius, 0.0}, 0.0);
  if (device == nullptr || !device->health_known) return;
  DrawHealthBar(map, placing.at - cv::Point2d(0.0, 1.25 * radius + layout.Px(4)), 2.0 * radius,
                device->health, layout);
}

}  // namespace

void DrawDeviceSymbol(cv::Mat& image, std::uint8_t kind, const Pose2& placing, double faded) {
  const Rgb color = Mix(DeviceColor(kind), kUnknown, faded);
  const auto& outline = DeviceOutline(kind);
  const int rim = placing.size_px >= 14.0 ? 2 : 1;
  StrokeShape(image, outline, placing, Bgr(kInk), rim + 1);
  FillShape(image, outline, placing, Bgr(color));
  if (placing.size_px < 7.0) return;
  // Draws a smaller outline inside, such as the net pen in its frame.
  StrokeShape(image, outline, {placing.at, 0.55 * placing.size_px, placing.bearing_deg},
              Bgr(Mix(color, kInk, 0.55)), rim);
}

void DrawSight(cv::Mat& map, const FarmSpec& spec, const FarmState& state, const Layout& layout) {
  if (spec.view_mode != FarmSpec::PARTIAL) return;
  const double radius_px = double(spec.sensor_radius) * layout.view.cell_px();
  if (!(radius_px > 0.0 && radius_px < map.rows + map.cols)) return;  // also if it is NaN
  for (const auto& ship : state.ships) {
    if (!ship.visible || !ship.active || !InGrid(spec, ship.x, ship.y)) continue;
    StrokeCircle(map, layout.view.ToPixel(ship.x, ship.y), radius_px, Bgr(kPaper), layout.Px(1.5));
  }
}

cv::Point2d ShipPlace(const FarmSpec& spec, const FarmState& state, const ShipState& ship,
                      const Layout& layout) {
  const double aside_px = 0.72 * (layout.ship_radius_px() + layout.port_radius_px());
  const cv::Point2d at = ShipPlace(spec, state, ship.x, ship.y, aside_px / layout.view.cell_px());
  return layout.view.ToPixel(at.x, at.y);
}

void DrawPorts(cv::Mat& map, const FarmSpec& spec, const Layout& layout, const Fonts& fonts) {
  for (const auto& port : spec.ports) {
    if (!InGrid(spec, port.cell.x, port.cell.y)) continue;
    DrawPort(map, layout.view.ToPixel(port.cell.x, port.cell.y), port.id, layout, fonts);
  }
}

namespace {

// Returns the size of the arrow of a legal move for DrawArrow [pixels].
double DirectionSize(const Layout& layout) {
  return std::max(0.62 * layout.view.cell_px(), 14.0 * layout.unit);
}

}  // namespace

void BlockDirections(const std::vector<PortDirections>& ports, const Layout& layout,
                     FreeSpace& space) {
  for (const auto& port : ports) {
    space.Block(Around(layout.view.ToPixel(port.cell.x, port.cell.y),
                       layout.port_radius_px() + 0.9 * DirectionSize(layout)));
  }
}

void DrawDirections(cv::Mat& map, const std::vector<PortDirections>& ports, const Layout& layout) {
  const double size = DirectionSize(layout);
  for (const auto& port : ports) {
    const cv::Point2d middle = layout.view.ToPixel(port.cell.x, port.cell.y);
    for (const std::uint8_t action : port.actions) {
      const int bearing = MoveBearingDeg(action);
      const Pose2 placing{middle, layout.port_radius_px() + 0.5 * size, double(bearing)};
      const cv::Point2d at = Place({0.0, 1.0}, placing);
      DrawArrow(map, at, bearing, size, Bgr(kInk), layout.Px(4.5));
      DrawArrow(map, at, bearing, size, Bgr(kDirectionColor), layout.Px(2.5));
    }
  }
}

void DrawFetched(cv::Mat& image, std::uint8_t kind, cv::Point2d at, double radius_px,
                 const Layout& layout) {
  const Rgb color = Mix(DeviceColor(kind), layout.style->label, 0.5);  // legible in both styles
  StrokeShape(image, DeviceOutline(kind), {at, radius_px, 0.0},
              Bgr(Mix(color, layout.style->sea_south, 0.25)), layout.Px(1.2));
}

namespace {

// Draws the outline of a fetched device in its former cell.
void DrawFormerPlace(cv::Mat& map, const FarmSpec& spec, std::int32_t id, const Layout& layout) {
  for (const DeviceState& device : spec.devices) {
    if (device.id != id || device.self_propelled || !InGrid(spec, device.x, device.y)) continue;
    DrawFetched(map, device.kind, layout.view.ToPixel(device.x, device.y),
                0.8 * layout.device_radius_px(), layout);
  }
}

}  // namespace

void DrawDevices(cv::Mat& map, const FarmSpec& spec, const FarmState& state, const Layout& layout) {
  const double radius = layout.device_radius_px();
  for (const auto& device : state.devices) {
    if (device.status != DeviceState::DEPLOYED) DrawFormerPlace(map, spec, device.id, layout);
  }
  std::map<std::pair<int, int>, int> delivered;
  for (const auto& device : state.devices) {
    if (!InGrid(spec, device.x, device.y)) continue;
    cv::Point2d at = layout.view.ToPixel(device.x, device.y);
    if (device.status == DeviceState::DELIVERED) {
      // Delivered devices are in rows of four next to the port.
      const int index = delivered[{device.x, device.y}]++;
      const double step = 9.0 * layout.unit;
      const double down = -DeliveredSide(spec, device.y);
      const int row = index / 4;
      at += cv::Point2d(step * (index % 4 - 1.0), down * step * (1.9 + row));
      DrawDeviceSymbol(map, device.kind, {at, 4.5 * layout.unit, 0.0}, 0.35);
    } else if (device.status == DeviceState::DEPLOYED && !device.self_propelled) {
      DrawDeviceSymbol(map, device.kind, {at, radius, 0.0}, device.health_known ? 0.0 : 0.6);
      if (!device.health_known) continue;
      DrawHealthBar(map, at - cv::Point2d(0.0, radius + layout.Px(3)), 2.0 * radius, device.health,
                    layout);
    }
  }
}

void DrawShips(cv::Mat& map, const FarmSpec& spec, const FarmState& state, const Trail* trail,
               const Layout& layout) {
  const auto per_cell = ShipsPerCell(state);
  Crowd crowd;
  // Draws the last ship first, so that ships with lower ids, which have right of way, are on top.
  for (auto ship = state.ships.rbegin(); ship != state.ships.rend(); ++ship) {
    if (!ship->visible || !ship->active || !InGrid(spec, ship->x, ship->y)) continue;
    const double radius = layout.ship_radius_px();
    const cv::Point2d at =
        ShipPlace(spec, state, *ship, layout) +
        crowd.Offset(ship->x, ship->y, per_cell.at({ship->x, ship->y}), 0.75 * radius);
    const Pose2 placing{at, radius, double(ShipBearingDeg(*ship, trail))};
    if (ship->own_device >= 0) {
      DrawSelfPropelled(map, state, *ship, placing, layout);
    } else {
      DrawRescueShip(map, state, *ship, placing, layout);
    }
  }
}

}  // namespace aquafarm_viz
