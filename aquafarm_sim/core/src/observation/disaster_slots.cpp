// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/observation/disaster_slots.h"

#include <algorithm>

#include "base/text.h"
#include "observation/risk_raster.h"

namespace aquafarm {
namespace {

constexpr std::size_t kFixedFeatures = 9;  // features of a slot without kind and forecast

// Writes one slot and returns the end of its features.
float* WriteSlot(float scale, const View& view, const KnownDisaster& known, float* out) {
  const ObservableDisaster& disaster = known.belief;
  const auto east = static_cast<float>(view.self.x);
  const auto north = static_cast<float>(view.self.y);
  const auto period = static_cast<float>(std::max(1, view.scenario->view.bulletin_period));
  *out++ = 1.0F;
  *out++ = (disaster.x - east) * scale;
  *out++ = (disaster.y - north) * scale;
  *out++ = disaster.dx;
  *out++ = disaster.dy;
  *out++ = disaster.reach() * scale;
  *out++ = static_cast<float>(known.age) / period;
  *out++ = -WorstRisk(disaster) * kRiskScale;
  *out++ = static_cast<float>(disaster.grade) / 4.0F;
  for (int kind = 0; kind < kDisasterKindCount; ++kind) {
    *out++ = kind == static_cast<int>(disaster.kind) ? 1.0F : 0.0F;
  }
  for (const std::array<float, 2>& position : known.forecast) {
    *out++ = (position[0] - east) * scale;
    *out++ = (position[1] - north) * scale;
  }
  return out;
}

}  // namespace

std::int32_t SlotCount(const Scenario& scenario) {
  if (scenario.view.disaster_slots == 0) return 0;
  return static_cast<std::int32_t>(scenario.disasters.size()) + scenario.view.disaster_slots;
}

std::vector<std::string> SlotNames(const Scenario& scenario) {
  std::vector<std::string> names;
  for (std::int32_t slot = 0; slot < SlotCount(scenario); ++slot) {
    const std::string here = "slot" + std::to_string(slot) + '.';
    for (const char* part : {"known", "east", "north", "motion_east", "motion_north", "reach",
                             "age", "risk", "grade"}) {
      names.push_back(here + part);
    }
    for (int kind = 0; kind < kDisasterKindCount; ++kind) {
      names.push_back(here + std::string(ToString(static_cast<DisasterKind>(kind))));
    }
    for (const float lead_h : scenario.view.forecast_leads_h) {
      for (const char* part : {"east_", "north_"}) {
        names.push_back(here + part + internal::Format(lead_h) + 'h');
      }
    }
  }
  return names;
}

void WriteSlots(float length_scale, const View& view, float* out) {
  const auto slots = static_cast<std::size_t>(SlotCount(*view.scenario));
  const std::size_t size = kFixedFeatures + static_cast<std::size_t>(kDisasterKindCount) +
                           2 * view.scenario->view.forecast_leads_h.size();
  const std::size_t filled = std::min(slots, view.by_danger.size());
  for (std::size_t slot = 0; slot < filled; ++slot) {
    const auto id = static_cast<std::size_t>(view.by_danger[slot]);
    out = WriteSlot(length_scale, view, view.disasters[id], out);
  }
  std::fill_n(out, (slots - filled) * size, 0.0F);
}

}  // namespace aquafarm
