// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/rescue/rescue_case.h"

#include <ctime>

namespace aquafarm::agents {

std::string FormatUtc(std::int64_t time) {
  const std::time_t seconds = time;
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[32];
  return {text, std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

std::int32_t RescueProblem::CarrierOf(std::size_t device) const {
  for (std::size_t ship = 0; ship < ships.size(); ++ship) {
    for (const std::int32_t one : ships[ship].aboard) {
      if (static_cast<std::size_t>(one) == device) return static_cast<std::int32_t>(ship);
    }
  }
  return kNone;
}

std::vector<Cell> RescueCase::Sites() const {
  std::vector<Cell> sites;
  for (const RescueDevice& device : problem.devices) sites.push_back(device.cell);
  return sites;
}

}  // namespace aquafarm::agents
