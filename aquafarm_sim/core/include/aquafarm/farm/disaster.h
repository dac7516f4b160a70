// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Disasters that move over the farm (paper §2.1, see docs/model.md).
///
///      . . r2 . .        risk at a cell = the risk of the smallest ring whose radius is at least
///    .   . r1 .   .      the Euclidean distance from the centre to the cell's centre; 0 outside.
///   .  .   c--->.  .     With several disasters the worst risk counts. A look-up takes
///    .   . . .   .       O(disasters) and needs no grid.
///
/// A ring may have a separate radius for each quadrant, as in typhoon bulletins. A cell due north
/// of the centre belongs to the north-east quadrant, a cell due east to the south-east quadrant,
/// and so on clockwise.
///
/// Difference from the paper: the centre moves by a real number of cells along a heading in whole
/// degrees, and is reflected at the border of the farm enlarged by the largest radius.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "aquafarm/base/rng.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/grid/grid.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Returns the (east, north) components of a unit vector along a compass bearing. The result is
/// bit-identical on every machine.
/// @param heading_deg in [0, 359]
std::array<float, 2> HeadingVector(std::int32_t heading_deg);

/// State of a disaster as last reported by a bulletin (partial view).
struct Bulletin {
  float x{};
  float y{};
  float speed{};
  std::int32_t heading_deg{};
  std::int32_t step{kNone};                                ///< step of issue; kNone: not issued yet
  std::array<float, kMaxRings> radius{};                   ///< at the step of issue
  std::array<std::array<float, kMaxRings>, 4> quadrant{};  ///< at the step of issue
};

/// The part of a disaster's state that views copy, as plain data.
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
  std::uint32_t turn_threshold{};  ///< the disaster turns if a 31-bit draw is below it
  float radius_growth{};
  float margin{};                ///< border around the map: the largest radius at the start [cells]
  std::int32_t steps_left{};     ///< 0: the disaster has ended and causes no risk
  std::int32_t waypoint{kNone};  ///< index of the last waypoint passed; kNone: no track
  bool by_quadrant{};  ///< if true, `quadrant` applies and `radius` holds the largest of the four
  std::array<std::array<float, kMaxRings>, 4> quadrant{};  ///< NE, SE, SW, NW, ring by ring

  bool active() const { return steps_left > 0; }
  /// Returns the largest radius, or 0 if there is no ring.
  float reach() const { return rings == 0 ? 0.0F : radius[static_cast<std::size_t>(rings - 1)]; }
};

/// Complete state of a disaster, without its last bulletin: everything that may change during an
/// episode.
struct Disaster : ObservableDisaster {
  std::array<std::uint32_t, 4> draws{};  ///< random draws of the current block of four steps
};

/// Copies the present rings of a disaster into its bulletin.
inline void CopyRings(const ObservableDisaster& disaster, Bulletin& bulletin) {
  bulletin.radius = disaster.radius;
  bulletin.quadrant = disaster.quadrant;
}

/// Waypoints of a disaster; shared and constant during an episode.
using Track = std::shared_ptr<const std::vector<Waypoint>>;

/// Creates a disaster at the start of an episode. Unset fields of its spec are drawn at random.
/// @param track that it follows instead of spec.track; null: spec.track
Disaster SpawnDisaster(const DisasterSpec& spec, std::int32_t id, std::uint64_t seed,
                       std::uint64_t episode, std::int32_t width, std::int32_t height,
                       const std::vector<Waypoint>* track = nullptr);

/// Advances a disaster to step `step` (the first move of an episode is to step 1): turns, moves,
/// grows and ages it. A disaster that has ended does not move.
void MoveDisaster(Disaster& disaster, const Track& track, const StreamKey& turn_key,
                  std::int32_t step, std::int32_t width, std::int32_t height);

/// Sets a tracked disaster to the state of its track at `step`.
void FollowTrack(ObservableDisaster& disaster, const std::vector<Waypoint>& track,
                 std::int32_t step);

/// Sets a ring to a circle. Radius 0 means that the ring is absent, so a track may gain and lose
/// rings.
void SetRing(ObservableDisaster& disaster, std::size_t ring, float radius);
/// Sets a ring by quadrants.
void SetRing(ObservableDisaster& disaster, std::size_t ring, const QuadrantRadii& radii);
/// Adds `by` cells to the radius of every ring, with a minimum of 0.
void GrowRings(ObservableDisaster& disaster, float by);

/// Returns the index of the quadrant (NE, SE, SW, NW) of a point relative to a centre.
/// @param west distance of the point west of the centre @param south distance south of it
constexpr std::size_t QuadrantOf(float west, float south) {
  if (west <= 0.0F && south < 0.0F) return 0;
  if (west < 0.0F) return 1;
  if (south > 0.0F) return 2;
  return west > 0.0F ? 3 : 0;
}

/// Returns the risk of rings by quadrant at a point `west` and `south` of the centre.
float RiskByQuadrant(const ObservableDisaster& disaster, float west, float south,
                     float distance_squared);

/// Returns the risk of one disaster at a point [cells]; 0 outside its rings or after its end, else
/// negative.
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

/// Returns the worst risk of several disasters at a cell.
inline float RiskAt(const std::vector<Disaster>& disasters, Cell cell) {
  float worst = 0.0F;
  for (const Disaster& disaster : disasters) {
    const float risk = RiskOf(disaster, static_cast<float>(cell.x), static_cast<float>(cell.y));
    worst = risk < worst ? risk : worst;
  }
  return worst;
}

/// Returns the risk that damages a device at a cell: of the disasters' risks there, each times the
/// factor of its kind, the worst. May be below kWorstRisk.
/// @param factors of the device's kind, by kind of disaster (DamageSpec::FactorsOf)
inline float DamagingRiskAt(const std::vector<Disaster>& disasters, Cell cell,
                            const std::array<float, kDisasterKindCount>& factors) {
  float worst = 0.0F;
  for (const Disaster& disaster : disasters) {
    const float risk = RiskOf(disaster, static_cast<float>(cell.x), static_cast<float>(cell.y)) *
                       factors[static_cast<std::size_t>(disaster.kind)];
    worst = risk < worst ? risk : worst;
  }
  return worst;
}

/// Fills the risk grid [H, W] of disasters and sea, for drawing, publishing and planning.
void FillRisk(const Scenario& scenario, const std::vector<Disaster>& disasters, Grid<float>& risk);

/// Risk grids by kind of device; a grid is empty if its kind is not needed.
using DamagingRisks = std::array<Grid<float>, kDeviceKindCount>;

/// As FillRisk; also fills the grids [H, W] in `by_kind` that are not empty with the risk that
/// damages each kind (DamagingRiskAt).
void FillRisks(const Scenario& scenario, const std::vector<Disaster>& disasters, Grid<float>& risk,
               DamagingRisks& by_kind);

}  // namespace aquafarm
