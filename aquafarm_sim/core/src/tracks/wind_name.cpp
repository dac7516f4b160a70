// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/tracks/wind_name.h"

#include <array>

namespace aquafarm {
namespace {

struct Force {
  std::int32_t from_kt;
  const char* name;
};

// The strongest first.
constexpr std::array<Force, 4> kForces{
    {{kHurricaneForce_kt, "hurricane force"}, {48, "storm"}, {34, "gale"}, {28, "near gale"}}};

}  // namespace

const char* WindName(std::int32_t wind_kt) {
  for (const Force& force : kForces) {
    if (wind_kt >= force.from_kt) return force.name;
  }
  return "wind";
}

std::string RingName(std::int32_t wind_kt) {
  return std::string(WindName(wind_kt)) + " (" + std::to_string(wind_kt) + " kt)";
}

}  // namespace aquafarm
