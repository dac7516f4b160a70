// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Converts the farm to rviz markers in frame `map`, in metres: the centre of cell (x, y) is at
/// (x, y) * cell_size_m. Markers are flat and low, because rviz's top-down view clips at 500 m.
///
/// Namespaces and ids are stable: an object keeps its marker for the whole episode, and the marker
/// of a removed object is deleted by its id. Lifetimes are 0.
///
///     | namespace                       | id                         |
///     | sea, island, shore, rocks       | 0                          |
///     | axis                            | tick                       |
///     | port, port_letter               | port                       |
///     | device, health, health_frame    | device                     |
///     | ship, ship_deck, ship_name      | ship                       |
///     | ring, ring_edge                 | disaster * kMaxRings + ring |
///     | ring_pattern                    | disaster                   |
///     | heading, disaster, disaster_name (3) | disaster              |
///     | status                          | 0                          |
///     | port_direction (1)              | port                       |
///     | device_label (2)                | device                     |
///
/// (1) only with the layer `directions`, (2) only with the layer `labels`, (3) with the layer
/// `risk` only if the centre lies on the farm, because DangerMarkers then point at a centre
/// outside; other layers are ignored.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <visualization_msgs/MarkerArray.h>

#include "aquafarm_viz/scene/layers.h"
#include "aquafarm_viz/scene/trail.h"

namespace aquafarm_viz {

/// Returns the sea, islands, rocks, axes and the legend, which are constant during an episode. If
/// `clear`, the first one deletes all markers; use it at the start of an episode.
visualization_msgs::MarkerArray SpecMarkers(const aquafarm_msgs::FarmSpec& spec, bool clear,
                                            const Layers& layers = {});

/// Returns the markers of ports, ships, devices and disasters, and of the line with time, episode,
/// step and return. A ship is drawn next to its port.
/// The spec must pass CheckSpec and the state CheckState.
visualization_msgs::MarkerArray StateMarkers(const aquafarm_msgs::FarmSpec& spec,
                                             const aquafarm_msgs::FarmState& state,
                                             const Trail* trail = nullptr,
                                             const Layers& layers = {});

}  // namespace aquafarm_viz
