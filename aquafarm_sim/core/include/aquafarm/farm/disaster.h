// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Disasters that move over the farm (§2.1).
///
///      . . r2 . .        risk at a cell = the risk of the smallest ring whose radius is at least
///    .   . r1 .   .      the Euclidean distance from the centre to the cell's centre; 0 outside.
///   .  .   c--->.  .     Several disasters: the worst. O(disasters) per look-up, no grid.
///    .   . . .   .
///
/// A ring need not be a circle: by option it has a radius of its own in each quadrant, as bulletins
/// give them. A cell due north of the centre counts as north-east, one due east as south-east, and
/// so on clockwise.
///
/// Where we differ: the centre moves by a real number of cells along a heading in whole degrees,
/// and is reflected at the border of the farm enlarged by the largest radius.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "aquafarm/base/rng.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/grid/grid.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// (east, north) parts of a unit vector along a compass bearing; the same bits on every machine.
/// @param heading_deg in [0, 359]
std::array<float, 2> HeadingVector(std::int32_t heading_deg);

/// What a bulletin last said of a disaster (partial view).
struct Bulletin {
  float x{};
  float y{};
  float speed{};
  std::int32_t heading_deg{};
  std::int32_t step{kNone};                                ///< when it was issued; kNone: none yet
  std::array<float, kMaxRings> radius{};                   ///< as they were then, as in Disaster
  std::array<std::array<float, kMaxRings>, 4> quadrant{};  ///< likewise
};

/// Of one disaster in play what a view copies, as plain data.
struct ObservableDisaster {
  DisasterKind kind{};
  Border border{};
  std::int32_t grade{};
  std::int32_t rings{};
  std::array<float, kMaxRings> radius{};
  std::array<float, kMaxRings> radius_squared{};
  std::array<float, kMaxRings> risk{};
  float x{};  ///< centre [cells]
  float y{};
  float dx{};  ///< displacement in a step [cells]
  float dy{};
  float speed{};
  std::int32_t heading_deg{};
  std::uint32_t turn_threshold{};  ///< a step turns when a 31-bit draw is below it
  float radius_growth{};
  float margin{};                ///< by which the map is enlarged: the largest radius at the start
  std::int32_t steps_left{};     ///< 0: over, no risk any more
  std::int32_t waypoint{kNone};  ///< index of the last waypoint passed; kNone: no track
  bool by_quadrant{};  ///< rings are no circles: the radii below hold, and radius is the largest
  std::array<std::array<float, kMaxRings>, 4> quadrant{};  ///< NE, SE, SW, NW, ring by ring

  bool active() const { return steps_left > 0; }
  /// Largest radius, or 0 when it has no ring.
  float reach() const { return rings == 0 ? 0.0F : radius[static_cast<std::size_t>(rings - 1)]; }
};

/// All of it: everything that may change in an episode.
struct Disaster : ObservableDisaster {
  std::array<std::uint32_t, 4> draws{};  ///< of the present four steps
  Bulletin bulletin;

  /// Its rings are those that the bulletin tells of.
  void TellRings() {
    bulletin.radius = radius;
    bulletin.quadrant = quadrant;
  }
};

/// A disaster's waypoints; shared, never changed in play.
using Track = std::shared_ptr<const std::vector<Waypoint>>;

/// Places a disaster at an episode's start, drawing what its spec leaves open.
Disaster SpawnDisaster(const DisasterSpec& spec, std::int32_t id, std::uint64_t seed,
                       std::uint64_t episode, std::int32_t width, std::int32_t height);

/// Moves a disaster into step `step` (the first move of an episode is into step 1): turns, moves,
/// grows, ages. A disaster that is over does not move.
void MoveDisaster(Disaster& disaster, const Track& track, const StreamKey& turn_key,
                  std::int32_t step, std::int32_t width, std::int32_t height);

/// Puts a tracked disaster where its track says it is at `step`.
void FollowTrack(ObservableDisaster& disaster, const std::vector<Waypoint>& track,
                 std::int32_t step);

/// Sets a ring to a circle; radius 0: the ring is absent, so that a track may gain and lose rings.
void SetRing(ObservableDisaster& disaster, std::size_t ring, float radius);
/// Sets a ring by quadrants.
void SetRing(ObservableDisaster& disaster, std::size_t ring, const QuadrantRadii& radii);
/// Widens every ring by `by` cells, to no less than nothing.
void GrowRings(ObservableDisaster& disaster, float by);

/// Index of the quadrant, NE, SE, SW, NW, in which a point lies seen from a centre.
/// @param west how far the point is west of the centre @param south likewise
constexpr std::size_t QuadrantOf(float west, float south) {
  if (west <= 0.0F && south < 0.0F) return 0;
  if (west < 0.0F) return 1;
  if (south > 0.0F) return 2;
  return west > 0.0F ? 3 : 0;
}

/// Risk of rings that are no circles, at a point so far to the west and south of it.
float RiskByQuadrant(const ObservableDisaster& disaster, float west, float south,
                     float distance_squared);

/// Risk of one disaster at a point [cells]; 0 outside or when it is over, else negative.
inline float RiskOf(const ObservableDisaster& disaster, float x, float y) {
  const float dx = disaster.x - x;
  const float dy = disaster.y - y;
  const float distance_squared = dx * dx + dy * dy;
  if (!disaster.active()) return 0.0F;
  if (disaster.by_quadrant) return RiskByQuadrant(disaster, dx, dy, distance_squared);
  for (std::int32_t ring = 0; ring < disaster.rings; ++ring) {
    const auto k = static_cast<std::size_t>(ring);
    if (distance_squared <= disaster.radius_squared[k]) return disaster.risk[k];
  }
  return 0.0F;
}

/// Worst risk of several disasters at a cell.
inline float RiskAt(const std::vector<Disaster>& disasters, Cell cell) {
  float worst = 0.0F;
  for (const Disaster& disaster : disasters) {
    const float risk = RiskOf(disaster, static_cast<float>(cell.x), static_cast<float>(cell.y));
    worst = risk < worst ? risk : worst;
  }
  return worst;
}

/// Fills the whole risk grid [H, W] of disasters and sea; for those who draw, publish or plan.
void FillRisk(const Scenario& scenario, const std::vector<Disaster>& disasters, Grid<float>& risk);

}  // namespace aquafarm
