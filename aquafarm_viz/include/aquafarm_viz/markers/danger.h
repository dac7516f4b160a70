// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Markers of the danger to devices, with the same words as in pictures.
///
///     | namespace        | id       | content                                                |
///     | alarm            | 0        | the next danger, in one or two lines above the farm    |
///     | outside          | 0        | above the clock: strength, place and motion of the     |
///     |                  |          | disasters whose centres lie outside the farm           |
///     | danger           | device   | circle around a device that a ring covers or reaches   |
///     | danger_label (1) | device   | the ring over it, the worst one and its arrival        |
///     | pointer          | disaster | where a centre outside the farm lies                   |
///
/// A label has a plate below it, in the namespace of the label with _plate, and a line to its
/// symbol where it is not next to it, with _leader.
///
/// (1) of as many devices as have a free place nearby, up to 40, those that are reached first
/// before others.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <visualization_msgs/MarkerArray.h>

#include <memory>

namespace aquafarm_viz {

/// Makes the markers of one farm. Keeps the storm tracks of the last scenario.
class DangerMarkers {
 public:
  DangerMarkers();
  ~DangerMarkers();

  /// Returns a marker for each id of the table; a marker without content deletes its predecessor.
  /// The spec must pass CheckSpec and the state CheckState.
  visualization_msgs::MarkerArray Of(const aquafarm_msgs::FarmSpec& spec,
                                     const aquafarm_msgs::FarmState& state);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace aquafarm_viz
