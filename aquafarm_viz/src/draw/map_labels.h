// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Draws the labels of the map, and circles around devices in danger; private to this package. A
/// label covers neither symbols nor other labels. A label is left out if there is no free space
/// near its symbol or ring, except the labels of pointers (LabelPointers).

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <set>
#include <vector>

#include "aquafarm_viz/scene/trail.h"
#include "draw/label_space.h"
#include "scene/outlook.h"

namespace aquafarm_viz {

struct Fonts;
struct Layout;

/// Returns the space that symbols leave free on the map. The symbols are ports, devices, former
/// cells of fetched devices, ships, and signs of disasters.
FreeSpace BlockSymbols(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                       const Outlook& outlook, const Layout& layout);

/// Draws a circle around each device that a ring of a disaster covers now or reaches later. The
/// circle has the colour of the worst risk, now or later. Devices that are hit first (IsHitFirst)
/// have a second circle.
void DrawDangerMarks(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                     const aquafarm_msgs::FarmState& state, const Outlook& outlook,
                     const Layout& layout);

/// Labels the 40 most urgent devices in danger with their danger, such as "F3: risk -10 in 6.5 h".
/// Returns the ids of the labelled devices.
std::set<std::int32_t> LabelDanger(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                                   const aquafarm_msgs::FarmState& state, const Outlook& outlook,
                                   LabelSpace& space, const Layout& layout, const Fonts& fonts);

/// Labels each ring that crosses the map: on the line of the ring or, if there is no free space on
/// the line, next to it. Labels do not cover land. The text is "risk -5", or "gale (34 kt), risk
/// -5" if the wind of the ring is given and there is space for it. If there are several disasters,
/// the text is the kind of the disaster and the risk, "typhoon -5".
/// @param courses  one per disaster of the state
void LabelRings(cv::Mat& map, const aquafarm_msgs::FarmState& state,
                const std::vector<Course>& courses, LabelSpace& space, const Layout& layout,
                const Fonts& fonts);

/// Labels the pointers to disasters outside the map with CentreText and, if there is space next to
/// the pointer, ClosestText. If the picture has no panel, the labels also contain MotionNow. If
/// there is no free space near a pointer, its label may be anywhere on the map.
void LabelPointers(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                   const aquafarm_msgs::FarmState& state, const std::vector<Course>& courses,
                   LabelSpace& space, const Layout& layout, const Fonts& fonts);

/// Writes F and the id next to each deployed device on the map (IsLabelled) that has no label yet.
/// @param labelled  ids of devices that already have a label
void LabelDevices(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                  const aquafarm_msgs::FarmState& state, const std::set<std::int32_t>& labelled,
                  LabelSpace& space, const Layout& layout, const Fonts& fonts);

/// Labels the former cell of each device that a ship has fetched. The text is "F2". If the time of
/// the pickup is known, the text is "F2 13:58". If there is only one agent, the number of the
/// pickup precedes this text: "1. F2 13:58".
/// @param trail  may be null
void LabelFetched(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                  const aquafarm_msgs::FarmState& state, const Trail* trail, LabelSpace& space,
                  const Layout& layout, const Fonts& fonts);

/// If there are several agents, writes "ship" and the id next to each ship that is visible, active
/// and on the map. Self-propelled devices are not labelled.
void LabelShips(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                const aquafarm_msgs::FarmState& state, LabelSpace& space, const Layout& layout,
                const Fonts& fonts);

}  // namespace aquafarm_viz
