// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/observation/disaster_slots.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "observation/risk_raster.h"

namespace aquafarm {
namespace {

constexpr std::size_t kFixedFeatures = 9;  // without kind and forecast

float WorstRisk(const ObservableDisaster& disaster) {
  float worst = 0.0F;
  for (std::size_t k = 0; k < static_cast<std::size_t>(disaster.rings); ++k) {
    if (disaster.radius[k] > 0.0F) worst = std::min(worst, disaster.risk[k]);
  }
  return worst;
}

// Returns the distance from a ship to the edge of a disaster with its centre at (x, y), at least 0.
float Gap(Cell ship, float x, float y, float reach) {
  const float east = x - static_cast<float>(ship.x);
  const float north = y - static_cast<float>(ship.y);
  return std::max(0.0F, std::sqrt(east * east + north * north) - reach);
}

float DangerOf(const View& view, const KnownDisaster& known) {
  const float reach = known.belief.reach();
  float gap = Gap(view.self, known.belief.x, known.belief.y, reach);
  for (const std::array<float, 2>& position : known.forecast) {
    gap = std::min(gap, Gap(view.self, position[0], position[1], reach));
  }
  const auto side = static_cast<float>(std::max(view.scenario->width, view.scenario->height));
  return -WorstRisk(known.belief) / (1.0F + gap / side);
}

// Writes one slot and returns the end of its features.
float* WriteSlot(const FeatureScales& scales, const View& view, const KnownDisaster& known,
                 float* out) {
  const ObservableDisaster& disaster = known.belief;
  const auto east = static_cast<float>(view.self.x);
  const auto north = static_cast<float>(view.self.y);
  const float scale = scales.length;
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

std::int32_t LeadSteps(const Scenario& scenario, std::size_t lead) {
  const double lead_s = static_cast<double>(scenario.view.forecast_leads_h[lead]) * 3600.0;
  const double steps = std::min(lead_s / scenario.step_duration_s, 1.0e7);
  return std::max(1, static_cast<std::int32_t>(steps + 0.5));
}

void ExtrapolateMotion(const Scenario& scenario, KnownDisaster& known) {
  known.forecast.resize(scenario.view.forecast_leads_h.size());
  for (std::size_t lead = 0; lead < known.forecast.size(); ++lead) {
    const auto steps = static_cast<float>(known.age + LeadSteps(scenario, lead));
    known.forecast[lead] = {known.belief.x + steps * known.belief.dx,
                            known.belief.y + steps * known.belief.dy};
  }
}

void RankByDanger(View& view) {
  view.by_danger.clear();
  for (std::size_t id = 0; id < view.disasters.size(); ++id) {
    const KnownDisaster& known = view.disasters[id];
    if (known.known && known.belief.active()) {
      view.by_danger.push_back(static_cast<std::int32_t>(id));
    }
  }
  if (view.by_danger.size() < 2) return;
  const auto danger = [&view](std::int32_t id) {
    return DangerOf(view, view.disasters[static_cast<std::size_t>(id)]);
  };
  std::sort(view.by_danger.begin(), view.by_danger.end(),
            [&danger](std::int32_t a, std::int32_t b) {
              const float of_a = danger(a);
              const float of_b = danger(b);
              return of_a != of_b ? of_a > of_b : a < b;
            });
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
      names.push_back(here + "is_" + std::string(ToString(static_cast<DisasterKind>(kind))));
    }
    for (const float lead_h : scenario.view.forecast_leads_h) {
      for (const char* part : {"east_", "north_"}) {
        names.push_back(here + part + internal::Format(lead_h) + 'h');
      }
    }
  }
  return names;
}

void WriteSlots(const FeatureScales& scales, const View& view, float* out) {
  const auto slots = static_cast<std::size_t>(SlotCount(*view.scenario));
  const std::size_t size = kFixedFeatures + static_cast<std::size_t>(kDisasterKindCount) +
                           2 * view.scenario->view.forecast_leads_h.size();
  const std::size_t filled = std::min(slots, view.by_danger.size());
  for (std::size_t slot = 0; slot < filled; ++slot) {
    const auto id = static_cast<std::size_t>(view.by_danger[slot]);
    out = WriteSlot(scales, view, view.disasters[id], out);
  }
  std::fill_n(out, (slots - filled) * size, 0.0F);
}

}  // namespace aquafarm
