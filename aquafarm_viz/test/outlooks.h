// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A ranch and a storm for the tests of outlooks.

#include <string>

#include "fixture.h"
#include "scene/outlook.h"

namespace aquafarm_viz::test {

// A ranch with one device at (10, 12) and a storm that moves west by one cell a step from (40, 12).
struct Outlooks {
  aquafarm_msgs::FarmSpec spec = MakeSpec();
  aquafarm_msgs::FarmState state = MakeState();
  StormTracks storms;

  Outlooks() {
    state.step = 0;
    state.devices = {MakeDevice(3, 0, 10, 12, 1.0F)};
    state.disasters = {MakeDisaster(0, 40.0F, 12.0F)};
    state.disasters[0].heading_deg = 270;
    state.disasters[0].speed = 1.0F;
    state.disasters[0].radii = {5.0F, 10.0F};
    state.disasters[0].risks = {-20.0F, -5.0F};
  }
  Course course() const { return CourseOf(spec, state, 0, storms); }
  Outlook outlook() const { return ComputeOutlook(spec, state, {course()}); }
};

constexpr const char* kRecorded = R"(
disasters:
  - kind: typhoon
    risks: [-20, -5]
    track:
      - {step: -10, x: 60, y: 12, radii: [5, 10], grade: 3, risks: [-20, -5]}
      - {step: 0, x: 40, y: 12, radii: [5, 10], grade: 3, risks: [-20, -5]}
      - {step: 10, x: 20, y: 12, radii: [5, 10], grade: 3, risks: [-20, -5]}
      - {step: 30, x: 20, y: 40, radii: [0, 0], grade: 1, risks: [-20, -5]}
)";

// Returns kRecorded with the winds of its rings.
inline std::string WithWinds(const std::string& winds) {
  return std::string(kRecorded).replace(std::string(kRecorded).find("    track:"), 0,
                                        "    ring_winds_kt: " + winds + "\n");
}

}  // namespace aquafarm_viz::test
