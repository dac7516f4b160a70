// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Converts the farm to rviz markers in frame `map`, in metres: the centre of cell (x, y) is at
/// (x, y) * cell_size_m. Markers are flat and low, because rviz's top-down view clips at 500 m.
///
/// Namespaces and ids are stable: an object keeps its marker for the whole episode, and the marker
/// of a removed object is deleted by its id. Lifetimes are 0, so markers do not expire.
///
///     | namespace                       | id                         |
///     | sea, island, shore, rocks       | 0                          |
///     | axis                            | 0, 1, …: ticks and names   |
///     | legend, legend_text             | 0, 1, …: one sequence      |
///     | port, port_letter               | port                       |
///     | device, health, health_frame    | device                     |
///     | fetched (outline in former cell) | device                    |
///     | ship, ship_deck, ship_name      | ship                       |
///     | path (4)                        | ship                       |
///     | ring, ring_edge                 | disaster * kMaxRings + ring |
///     | ring_pattern                    | disaster                   |
///     | heading, disaster (3)           | disaster                   |
///     | disaster_name, disaster_name_plate (3) | disaster            |
///     | status                          | 0                          |
///     | port_direction (1)              | port                       |
///     | device_label (2)                | device                     |
///
/// (1) Only with the layer `directions`. (2) Only with the layer `labels`. (3) Without the layer
/// `risk`, all centres; with this layer, only centres on the farm, because DangerMarkers have
/// pointers to the other centres. (4) Only with the layer `trail`. Other layers have no effect.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <visualization_msgs/MarkerArray.h>

#include "aquafarm_viz/scene/layers.h"
#include "aquafarm_viz/scene/trail.h"

namespace aquafarm_viz {

/// Returns the markers that are constant during an episode: sea, islands, rocks, axes, legend and,
/// with the layer `directions`, the legal moves at ports.
/// @param clear true: the first marker deletes all markers; use it at the start of an episode
visualization_msgs::MarkerArray SpecMarkers(const aquafarm_msgs::FarmSpec& spec, bool clear,
                                            const Layers& layers = {});

/// Returns the markers of ports, ships, devices and disasters, and of the line with time, episode,
/// step and return. A ship in the cell of a port is drawn next to the port.
/// The spec must pass CheckSpec and the state CheckState.
/// @param trail trails of the ships; nullptr: no paths, and ships that do not move point north
visualization_msgs::MarkerArray StateMarkers(const aquafarm_msgs::FarmSpec& spec,
                                             const aquafarm_msgs::FarmState& state,
                                             const Trail* trail = nullptr,
                                             const Layers& layers = {});

/// Returns the markers of both arrays. A marker of `second` replaces the marker of `first` with the
/// same namespace and id, because rviz warns about an array that adds and deletes the same marker.
visualization_msgs::MarkerArray Joined(visualization_msgs::MarkerArray first,
                                       const visualization_msgs::MarkerArray& second);

}  // namespace aquafarm_viz
