// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "aquafarm_viz/base/text.h"
#include "aquafarm_viz/scene/labels.h"
#include "draw/panel.h"
#include "draw/symbols.h"
#include "scene/nautical.h"
#include "scene/outlook_text.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DeviceState;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

// Returns when a device was fetched, "fetched 0:27"; empty if this is not known.
std::string FetchedText(const FarmSpec& spec, const DeviceState& device, const Trail* trail) {
  const auto at = trail == nullptr ? std::nullopt : trail->FetchedAt(device.id);
  return at ? "fetched " + TimeOfDay(spec, *at) : "";
}

// Returns the status of a device. For a delivered device, this is its port, "port B", or "safe" if
// its cell does not have a port.
std::string StatusText(const FarmSpec& spec, const DeviceState& device) {
  if (device.status != DeviceState::DELIVERED) return StatusName(device.status);
  const std::string port = PortText(spec, device.x, device.y);
  return port.empty() ? "safe" : port;
}

// Returns the outlook of a device that a ring covers or reaches; null if the device is not in
// danger.
const DeviceOutlook* DangerTo(const DeviceState& device, const Outlook& outlook) {
  for (const DeviceOutlook& one : outlook.devices) {
    if (one.id == device.id && WorstRisk(one) < 0.0) return &one;
  }
  return nullptr;
}

// Returns the health and the value of a device: "health 88 %", "value 80".
std::pair<std::string, std::string> HealthAndValue(const DeviceState& device) {
  return {device.health_known ? "health " + Percent(double(device.health)) : "",
          "value " + Number(double(device.value), 0)};
}

// Returns the parts of a danger with commas between them, each in the colour of its ring.
ColoredTexts InRingColors(const DangerParts& parts, const Layout& layout) {
  ColoredTexts colored;
  for (const DangerPart& part : parts) {
    if (!colored.empty()) colored.back().text += ", ";
    colored.push_back({part.text, RiskTextColor(part.risk, layout)});
  }
  return colored;
}

// Draws two rows for a device in danger: the first ring in the first row, worse ones in the second.
void ListDanger(Panel& panel, const FarmSpec& spec, const DeviceState& device,
                const DeviceOutlook& outlook, const Layout& layout) {
  DangerParts parts = PartsOf(spec, outlook, /*is_brief=*/false);
  DangerParts worse(parts.begin() + 1, parts.end());
  if (!panel.Fits("", Joined(worse))) {
    parts = PartsOf(spec, outlook, /*is_brief=*/true);
    worse.assign(parts.begin() + 1, parts.end());
  }
  const std::string label = DeviceLabel(device.id);
  const std::string full = label + " " + DeviceName(device.kind);
  const bool has_kind = panel.Fits(full, parts.front().text);
  panel.Item(has_kind ? full : label, InRingColors({parts.front()}, layout));
  if (worse.empty()) {
    const auto [health, value] = HealthAndValue(device);
    panel.Detail(health, value, layout.style->faint);
  } else {
    panel.Detail("", InRingColors(worse, layout));
  }
}

// Draws one row for each device with its symbol, its kind, and its danger or status.
// @param has_details  true: draws a second row for each device
void ListEachDevice(Panel& panel, const FarmSpec& spec, const FarmState& state, const Trail* trail,
                    const Outlook& outlook, bool has_details, const Layout& layout) {
  for (const auto& device : state.devices) {
    const bool done = device.status == DeviceState::DELIVERED;
    DrawDeviceSymbol(panel.image(), device.kind, {panel.SymbolAt(), 6.0 * layout.unit, 0.0},
                     done ? 0.5 : 0.0);
    std::string status = StatusText(spec, device);
    if (const auto at = trail == nullptr ? std::nullopt : trail->ChangedAt(device.id)) {
      status += " " + TimeOfDay(spec, *at);
    }
    const Rgb color = done ? layout.style->good : layout.style->faint;
    const std::string name = DeviceLabel(device.id) + " " + DeviceName(device.kind);
    const DeviceOutlook* danger = DangerTo(device, outlook);
    if (danger != nullptr && has_details) {
      ListDanger(panel, spec, device, *danger, layout);
      continue;
    }
    if (danger != nullptr) {
      const auto [label, parts] = NameAndDanger(
          spec, DeviceName(device.kind), *danger,
          [&panel](const auto& left, const auto& right) { return panel.Fits(left, right); });
      panel.Item(label, InRingColors(parts, layout));
      continue;
    }
    panel.Item(name, status, color);
    if (!has_details) continue;
    const auto [health, value] = HealthAndValue(device);
    panel.Detail(done ? FetchedText(spec, device, trail) : health, value, layout.style->faint);
  }
}

// Returns the label of a device with its danger or status: the longest text that fits in half a
// row.
ColoredTexts DeviceInHalf(const Panel& panel, const FarmSpec& spec, const DeviceState& device,
                          const Trail* trail, const Outlook& outlook, const Layout& layout) {
  const bool done = device.status == DeviceState::DELIVERED;
  const std::string status = StatusText(spec, device);
  const auto at = trail == nullptr ? std::nullopt : trail->ChangedAt(device.id);
  if (const DeviceOutlook* one = DangerTo(device, outlook)) {
    const auto [name, danger] = NameAndDanger(spec, DeviceName(device.kind), *one,
                                              [&panel](const auto& left, const auto& right) {
                                                return panel.FitsInHalf(left + " " + right);
                                              });
    ColoredTexts parts = InRingColors(danger, layout);
    parts.insert(parts.begin(), {name + " ", parts.front().color});
    return parts;
  }
  const std::string text = DeviceLabel(device.id) + " " + status;
  const std::string longer = at ? text + " " + TimeOfDay(spec, *at) : text;
  return {
      {panel.FitsInHalf(longer) ? longer : text, done ? layout.style->good : layout.style->faint}};
}

// Draws two devices in each row. The left column contains the first half of the devices.
void ListInHalves(Panel& panel, const FarmSpec& spec, const FarmState& state, const Trail* trail,
                  const Outlook& outlook, const Layout& layout) {
  const std::size_t rows = (state.devices.size() + 1) / 2;
  for (std::size_t row = 0; row < rows; ++row) {
    std::array<ColoredTexts, 2> halves;
    const std::array<cv::Point2d, 2> symbols{panel.SymbolAt(), panel.SecondSymbolAt()};
    for (std::size_t half = 0; half < 2; ++half) {
      if (row + half * rows >= state.devices.size()) continue;
      const DeviceState& device = state.devices[row + half * rows];
      DrawDeviceSymbol(panel.image(), device.kind, {symbols[half], 6.0 * layout.unit, 0.0},
                       device.status == DeviceState::DELIVERED ? 0.5 : 0.0);
      halves[half] = DeviceInHalf(panel, spec, device, trail, outlook, layout);
    }
    panel.Pair(halves[0], halves[1]);
  }
}

void ListKinds(Panel& panel, const FarmState& state, const Layout& layout) {
  constexpr std::size_t kKinds = 4;
  std::array<int, kKinds> total{};
  std::array<int, kKinds> delivered{};
  for (const auto& device : state.devices) {
    if (device.kind >= kKinds) continue;
    ++total[device.kind];
    delivered[device.kind] += device.status == DeviceState::DELIVERED ? 1 : 0;
  }
  for (std::uint8_t kind = 0; kind < kKinds; ++kind) {
    DrawDeviceSymbol(panel.image(), kind, {panel.SymbolAt(), 6.0 * layout.unit, 0.0},
                     total[kind] == 0 ? 0.75 : 0.0);
    panel.Item(DeviceName(kind),
               std::to_string(delivered[kind]) + " / " + std::to_string(total[kind]),
               layout.style->faint);
  }
}

}  // namespace

void ListDevices(Panel& panel, const FarmSpec& spec, const FarmState& state, const Trail* trail,
                 const Outlook& outlook, const Layout& layout) {
  constexpr std::size_t kMaxRows = 6;
  constexpr int kRowsBelow = 8;  // kept free for disasters and ships
  const auto delivered = std::count_if(
      state.devices.begin(), state.devices.end(),
      [](const DeviceState& device) { return device.status == DeviceState::DELIVERED; });
  const std::string zone = spec.has_start_time && trail != nullptr ? ", " + ZoneText(spec) : "";
  panel.Heading("DEVICES" + zone,
                std::to_string(delivered) + " / " + std::to_string(state.devices.size()) + " safe");
  if (state.devices.size() <= kMaxRows) {
    const auto rows = 2 * state.devices.size() + 3 * state.disasters.size() + state.ships.size();
    const bool has_details = panel.RowsLeft() >= static_cast<int>(rows) + Panel::kRowsOfRegion;
    ListEachDevice(panel, spec, state, trail, outlook, has_details, layout);
  } else if (state.devices.size() <= 2 * kMaxRows &&
             panel.RowsLeft() >= int(kMaxRows) + kRowsBelow) {
    ListInHalves(panel, spec, state, trail, outlook, layout);
  } else {
    ListKinds(panel, state, layout);
  }
}

}  // namespace aquafarm_viz
