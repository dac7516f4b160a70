// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Labels on the map. They cover no symbol and no other label; private to this package.

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

/// Returns the space of the map that ports, devices, ships and centres of disasters leave.
FreeSpace BlockSymbols(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                       const Outlook& outlook, const Layout& layout);

/// Draws a ring around each device that a ring of a disaster covers or reaches, in the colour of
/// its worst risk, now or later; the one that is reached first has two, and so have those with the
/// same DangerText.
void DrawDangerMarks(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                     const aquafarm_msgs::FarmState& state, const Outlook& outlook,
                     const Layout& layout);

/// Labels the devices that have a free place nearby, up to 40 and those that are reached first
/// before others: "F3: -10 in 6.5 h". Returns the ids of these devices.
std::set<std::int32_t> LabelDanger(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                                   const aquafarm_msgs::FarmState& state, const Outlook& outlook,
                                   LabelSpace& space, const Layout& layout, const Fonts& fonts);

/// Labels each ring of a disaster that crosses the map, on its line, else next to it, on water:
/// "risk -5", or "gale (34 kt), risk -5" where the wind is given, after the name of the disaster if
/// there are several. A ring without a free place has no label.
/// @param courses  one per disaster of the state
void LabelRings(cv::Mat& map, const aquafarm_msgs::FarmState& state,
                const std::vector<Course>& courses, LabelSpace& space, const Layout& layout,
                const Fonts& fonts);

/// Labels the pointers to disasters outside the map with CentreText, and with MotionNow if there is
/// no panel, which lists it.
void LabelPointers(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                   const aquafarm_msgs::FarmState& state, const std::vector<Course>& courses,
                   LabelSpace& space, const Layout& layout, const Fonts& fonts);

/// Writes F and the id next to each device that is neither aboard nor delivered.
/// @param labelled  ids of devices that have a label
void LabelDevices(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                  const aquafarm_msgs::FarmState& state, const std::set<std::int32_t>& labelled,
                  LabelSpace& space, const Layout& layout, const Fonts& fonts);

/// Writes F, the id and the time at which it was taken aboard, where that is known, next to the
/// former place of each device that a ship has fetched.
void LabelFetched(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                  const aquafarm_msgs::FarmState& state, const Trail* trail, LabelSpace& space,
                  const Layout& layout, const Fonts& fonts);

/// Writes the id next to each ship if there are several.
void LabelShips(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                const aquafarm_msgs::FarmState& state, LabelSpace& space, const Layout& layout,
                const Fonts& fonts);

}  // namespace aquafarm_viz
