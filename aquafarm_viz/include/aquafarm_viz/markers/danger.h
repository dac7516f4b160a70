// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Markers of the danger to devices and of the disasters outside the farm.
///
///     | namespace        | id       | content                                                |
///     | alarm            | 0        | text above the clock: the danger to the devices        |
///     | outside          | 0        | text below the clock: strength, position and motion of |
///     |                  |          | up to two disasters whose centres lie outside the farm |
///     | danger           | device   | circle around a device that a ring covers or reaches   |
///     | danger_label (1) | device   | the ring over the device now, and the worst later ring |
///     | pointer          | disaster | triangle at the edge, towards a centre outside         |
///     | sign_legend,     | 0, 1, …  | meanings of the signs on the map; both namespaces      |
///     | sign_legend_text |          | share one sequence of ids                              |
///
/// The clock is the marker `status` of StateMarkers (markers.h), a line of text north of the farm.
///
/// A label lies on a dark plate, which has the namespace `danger_label_plate`. If a label is not
/// next to its device, a line with the namespace `danger_label_leader` connects label and device,
/// unless the line would cross another label.
///
/// (1) Up to 40 devices get a label if there is free space near them, the most urgent devices
/// first. The most urgent device always gets a label.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <visualization_msgs/MarkerArray.h>

#include <memory>

#include "aquafarm_viz/scene/trail.h"

namespace aquafarm_viz {

/// Makes the markers of one farm. Caches the storm tracks of the last scenario.
class DangerMarkers {
 public:
  DangerMarkers();
  ~DangerMarkers();

  /// Returns a marker for each id of the table. A marker without content has the action DELETE.
  /// Also deletes the labels of StateMarkers (`device_label`) that danger labels replace.
  /// The spec must pass CheckSpec and the state CheckState.
  /// @param trail  trails that StateMarkers draws; the legend explains dashes if a trail has them;
  ///               nullptr: no trails
  visualization_msgs::MarkerArray Of(const aquafarm_msgs::FarmSpec& spec,
                                     const aquafarm_msgs::FarmState& state,
                                     const Trail* trail = nullptr);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace aquafarm_viz
