// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/base/disaster_kinds.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "aquafarm/base/angle.h"

namespace aquafarm_viz {
namespace {

using aquafarm::kPi;

double ToLine(double at, double period) {
  const double rest = std::fmod(std::fmod(at, period) + period, period);
  return std::min(rest, period - rest);
}

float Rising(int x, int y, int period) {
  return static_cast<float>(ToLine(x + y, period) / std::sqrt(2.0));
}

float Falling(int x, int y, int period) {
  return static_cast<float>(ToLine(x - y, period) / std::sqrt(2.0));
}

float Level(int, int y, int period) { return static_cast<float>(ToLine(y, period)); }

float Upright(int x, int, int period) { return static_cast<float>(ToLine(x, period)); }

float Waves(int x, int y, int period) {
  return static_cast<float>(ToLine(y + 0.18 * period * std::sin(kPi * x / period), period));
}

float StaggeredDots(int x, int y, int period) {
  const int row = (2 * y + period) / (2 * period);  // of the nearest dots
  const double shifted = x + (row % 2 == 0 ? 0.0 : 0.5 * period);
  return static_cast<float>(
      std::max(0.0, std::hypot(ToLine(shifted, period), ToLine(y, period)) - 0.8));
}

float Crossed(int x, int y, int period) {
  return std::min(Rising(x, y, period), Falling(x, y, period));
}

struct DisasterKind {
  const char* name;
  float (*distance)(int x, int y, int period);  // as DistanceToPattern
};

// Indexed by the kinds of DisasterState.
constexpr std::array<DisasterKind, 6> kKinds{{{"typhoon", Rising},
                                              {"storm surge", Level},
                                              {"wave", Waves},
                                              {"red tide", StaggeredDots},
                                              {"oil spill", Crossed},
                                              {"chemical spill", Upright}}};

}  // namespace

std::size_t DisasterKindCount() { return kKinds.size(); }

std::string DisasterName(std::uint8_t kind) {
  return kind < kKinds.size() ? kKinds[kind].name : "disaster";
}

float DistanceToPattern(std::uint8_t kind, int x, int y, int period) {
  return kKinds[std::min<std::size_t>(kind, kKinds.size() - 1)].distance(x, y, period);
}

}  // namespace aquafarm_viz
