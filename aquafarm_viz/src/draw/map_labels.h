// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Draws labels on the map, which cover no symbol and no other label, and the marks around devices
/// in danger; private to this package.

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

/// Draws a ring around each device that a ring of a disaster covers or reaches. Its colour is that
/// of the worst risk, now or later. The most urgent device has a second ring, and so have the
/// devices with the same DangerText.
void DrawDangerMarks(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                     const aquafarm_msgs::FarmState& state, const Outlook& outlook,
                     const Layout& layout);

/// Writes the danger next to the 40 most urgent devices in danger, "F3: risk -10 in 6.5 h". A
/// device without free space nearby gets no label. Returns the ids of the labelled devices.
std::set<std::int32_t> LabelDanger(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                                   const aquafarm_msgs::FarmState& state, const Outlook& outlook,
                                   LabelSpace& space, const Layout& layout, const Fonts& fonts);

/// Labels each ring that crosses the map, on its line or, if that is not free, next to it. Labels
/// do not cover land. The text is "risk -5", or "gale (34 kt), risk -5" if the wind is given; if
/// there are several disasters, the name of the disaster comes first. A ring without free space has
/// no label.
/// @param courses  one per disaster of the state
void LabelRings(cv::Mat& map, const aquafarm_msgs::FarmState& state,
                const std::vector<Course>& courses, LabelSpace& space, const Layout& layout,
                const Fonts& fonts);

/// Labels the pointers to disasters outside the map with CentreText. If the picture has no panel,
/// the labels also contain MotionNow.
void LabelPointers(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                   const aquafarm_msgs::FarmState& state, const std::vector<Course>& courses,
                   LabelSpace& space, const Layout& layout, const Fonts& fonts);

/// Writes F and the id next to each deployed device, see IsLabelled.
/// @param labelled  ids of devices that already have a label
void LabelDevices(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                  const aquafarm_msgs::FarmState& state, const std::set<std::int32_t>& labelled,
                  LabelSpace& space, const Layout& layout, const Fonts& fonts);

/// Writes F and the id next to the former cell of each device that a ship has fetched, with the
/// time at which the device was picked up if that is known.
/// @param trail  may be null
void LabelFetched(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                  const aquafarm_msgs::FarmState& state, const Trail* trail, LabelSpace& space,
                  const Layout& layout, const Fonts& fonts);

/// Writes "ship" and the id next to each ship if there are several. Self-propelled devices are not
/// labelled.
void LabelShips(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                const aquafarm_msgs::FarmState& state, LabelSpace& space, const Layout& layout,
                const Fonts& fonts);

}  // namespace aquafarm_viz
