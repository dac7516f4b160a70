// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/base/checks.h"

#include <cmath>
#include <sstream>

namespace aquafarm_viz {
namespace {

template <typename Value, typename Limit>
std::string Fault(const std::string& where, Value got, Limit low, Limit high) {
  std::ostringstream line;
  line << where << ": got " << got << ", expected [" << low << ", " << high << "]";
  return line.str();
}

bool Within(double value, double low, double high) {
  return std::isfinite(value) && value >= low && value <= high;
}

std::string CheckCount(const std::string& where, std::size_t got, std::size_t max) {
  return got <= max ? "" : Fault(where + ".size", got, std::size_t{0}, max);
}

std::string CheckDisaster(const std::string& where, const aquafarm_msgs::DisasterState& disaster) {
  if (disaster.radii.size() != disaster.risks.size()) {
    return where + ".risks.size: got " + std::to_string(disaster.risks.size()) +
           ", expected as many as radii, " + std::to_string(disaster.radii.size());
  }
  if (auto fault = CheckCount(where + ".radii", disaster.radii.size(), kMaxRings); !fault.empty()) {
    return fault;
  }
  for (const float radius : disaster.radii) {
    if (!Within(radius, 0.0, kMaxDistance)) {
      return Fault(where + ".radii", radius, 0.0, kMaxDistance);
    }
  }
  if (!disaster.quadrants.empty() && disaster.quadrants.size() != 4 * disaster.radii.size()) {
    return where + ".quadrants.size: got " + std::to_string(disaster.quadrants.size()) +
           ", expected 0 or four per ring, " + std::to_string(4 * disaster.radii.size());
  }
  for (const float radius : disaster.quadrants) {
    if (!Within(radius, 0.0, kMaxDistance)) {
      return Fault(where + ".quadrants", radius, 0.0, kMaxDistance);
    }
  }
  for (const float risk : disaster.risks) {
    if (!std::isfinite(risk)) return where + ".risks: got a number that is not finite";
  }
  if (!Within(disaster.x, -kMaxDistance, kMaxDistance)) {
    return Fault(where + ".x", disaster.x, -kMaxDistance, kMaxDistance);
  }
  if (!Within(disaster.y, -kMaxDistance, kMaxDistance)) {
    return Fault(where + ".y", disaster.y, -kMaxDistance, kMaxDistance);
  }
  return "";
}

}  // namespace

std::string CheckSpec(const aquafarm_msgs::FarmSpec& spec) {
  if (spec.width < 1 || spec.width > kMaxSide) {
    return Fault("spec.width", spec.width, 1, kMaxSide);
  }
  if (spec.height < 1 || spec.height > kMaxSide) {
    return Fault("spec.height", spec.height, 1, kMaxSide);
  }
  if (!Within(spec.cell_size_m, 1.0e-3, 1.0e6)) {
    return Fault("spec.cell_size_m", spec.cell_size_m, 1.0e-3, 1.0e6);
  }
  const auto cells = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  for (const auto& [name, count] : {std::pair{"spec.islands", spec.islands.size()},
                                    {"spec.rocks", spec.rocks.size()},
                                    {"spec.ports", spec.ports.size()}}) {
    if (auto fault = CheckCount(name, count, cells); !fault.empty()) return fault;
  }
  return "";
}

std::string CheckState(const aquafarm_msgs::FarmState& state) {
  for (const auto& [name, count, max] :
       {std::tuple{"state.ships", state.ships.size(), kMaxShips},
        {"state.devices", state.devices.size(), kMaxDevices},
        {"state.disasters", state.disasters.size(), kMaxDisasters}}) {
    if (auto fault = CheckCount(name, count, static_cast<std::size_t>(max)); !fault.empty()) {
      return fault;
    }
  }
  for (std::size_t i = 0; i < state.disasters.size(); ++i) {
    if (!state.disasters[i].known) continue;
    const std::string where = "state.disasters[" + std::to_string(i) + "]";
    if (auto fault = CheckDisaster(where, state.disasters[i]); !fault.empty()) return fault;
  }
  for (std::size_t i = 0; i < state.devices.size(); ++i) {
    if (!std::isfinite(state.devices[i].health)) {
      return "state.devices[" + std::to_string(i) + "].health: got a number that is not finite";
    }
  }
  return "";
}

}  // namespace aquafarm_viz
