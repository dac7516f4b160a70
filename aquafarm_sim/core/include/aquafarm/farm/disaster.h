// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Disasters that move over the farm (paper §2.1, see docs/model.md).
///
///      . . r2 . .        The risk at a cell is that of the smallest ring that contains the centre
///    .   . r1 .   .      of the cell (Euclidean distance from the centre c). It is 0 outside all
///   .  .   c--->.  .     rings. With several disasters the worst risk applies. Risks are computed
///    .   . . .   .       from the rings, without a grid.
///
/// A ring may have a separate radius for each quadrant, as in typhoon bulletins. A cell due north
/// of the centre belongs to the north-east quadrant, a cell due east to the south-east quadrant,
/// and so on clockwise.
///
/// Difference from the paper: the centre moves by a real number of cells along a heading in whole
/// degrees. By default it is reflected at a border outside the map. The distance from the map to
/// the border is the largest initial radius. Border lists the alternatives. A disaster with a track
/// follows its track instead.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "aquafarm/base/rng.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/grid/grid.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Returns the (east, north) components of the unit vector of a compass bearing. The result is
/// bit-identical on every machine.
/// @param heading_deg in [0, 359]
/// @throws LogicError for another bearing
std::array<float, 2> HeadingVector(std::int32_t heading_deg);

/// State of a disaster in its last bulletin (partial view).
struct Bulletin {
  float x{};  ///< reported centre [cells], with the error of ViewSpec::bulletin_noise
  float y{};
  float speed{};               ///< [cells/step]
  std::int32_t heading_deg{};  ///< compass bearing
  std::int32_t step{kNone};    ///< step of issue; kNone: not issued yet
  /// Radii at `step` [cells]. Farm::SetDisaster replaces them by those of the new disaster.
  std::array<float, kMaxRings> radius{};
  std::array<std::array<float, kMaxRings>, 4> quadrant{};  ///< by quadrant; see `radius`
};

/// The part of a disaster's state that views copy.
struct ObservableDisaster {
  DisasterKind kind{};
  Border border{};
  std::int32_t grade{};
  /// Number of rings. The arrays start with the innermost ring.
  std::int32_t rings{};
  std::array<float, kMaxRings> radius{};          ///< [cells]; 0: the ring is absent
  std::array<float, kMaxRings> radius_squared{};  ///< -1 for an absent ring
  std::array<float, kMaxRings> risk{};            ///< risk inside each ring, negative
  float x{};                                      ///< centre [cells]
  float y{};
  float dx{};  ///< displacement [cells/step]
  float dy{};
  float speed{};                   ///< [cells/step]
  std::int32_t heading_deg{};      ///< compass bearing of the motion
  std::uint32_t turn_threshold{};  ///< the disaster turns if a 31-bit draw is below it
  float radius_growth{};           ///< [cells/step]; not used with a track
  float margin{};  ///< distance from the map to the border [cells]; the largest initial radius
  std::int32_t steps_left{};  ///< 0: the disaster has ended and causes no risk
  /// Index of the last waypoint passed; 0 before the first waypoint; kNone without a track.
  std::int32_t waypoint{kNone};
  /// True: `quadrant` applies, and `radius` has the largest of the four values of each ring.
  bool by_quadrant{};
  std::array<std::array<float, kMaxRings>, 4>
      quadrant{};  ///< radius by quadrant (NE, SE, SW, NW) and ring

  /// Returns whether the disaster has not ended.
  bool active() const { return steps_left > 0; }
  /// Returns the radius of the outermost ring, or 0 if there is no ring.
  float reach() const { return rings == 0 ? 0.0F : radius[static_cast<std::size_t>(rings - 1)]; }
};

/// State of a disaster. The farm stores its track, issued forecasts and last bulletin separately.
struct Disaster : ObservableDisaster {
  std::array<std::uint32_t, 4> draws{};  ///< random draws of the current block of four steps
};

/// Copies the current rings of a disaster into its bulletin.
inline void CopyRings(const ObservableDisaster& disaster, Bulletin& bulletin) {
  bulletin.radius = disaster.radius;
  bulletin.quadrant = disaster.quadrant;
}

/// Waypoints of a disaster. During an episode the vector is not modified: Farm::SetDisaster
/// replaces it by another one.
using Track = std::shared_ptr<const std::vector<Waypoint>>;

/// Creates a disaster. A centre or heading that the spec does not set is drawn from (seed, episode,
/// id). With a track, the disaster is in the state of the track at step 0.
/// @param width, height size of the farm [cells]
/// @param track waypoints that replace those of the spec; null: those of the spec apply
Disaster SpawnDisaster(const DisasterSpec& spec, std::int32_t id, std::uint64_t seed,
                       std::uint64_t episode, std::int32_t width, std::int32_t height,
                       const std::vector<Waypoint>* track = nullptr);

/// Advances a disaster by one step, to step `step` of the episode (1 for the first step). With a
/// track, the disaster follows it. Without a track, the disaster turns, moves and grows. A disaster
/// that has ended does not change.
/// @param turn_key key of the random turns
/// @param width, height size of the farm [cells]
void MoveDisaster(Disaster& disaster, const Track& track, const StreamKey& turn_key,
                  std::int32_t step, std::int32_t width, std::int32_t height);

/// Sets position, rings and risks of a disaster to those of its track at `step`. Before the first
/// waypoint they are those of the first one, and after the last waypoint those of the last one.
/// Sets grade and motion only if `step` is 0 or a new leg of the track has begun. Before the first
/// waypoint the motion is that of the first leg, and after the last waypoint it is 0.
/// @param disaster `waypoint` must not be kNone. The search for the current leg starts at this
///   waypoint, so `step` must not decrease from call to call.
void FollowTrack(ObservableDisaster& disaster, const std::vector<Waypoint>& track,
                 std::int32_t step);

/// Sets a ring to a circle. A ring of radius 0 is absent.
void SetRing(ObservableDisaster& disaster, std::size_t ring, float radius);
/// Sets the radius of a ring in each quadrant.
void SetRing(ObservableDisaster& disaster, std::size_t ring, const QuadrantRadii& radii);
/// Adds `by` cells to the radius of every ring. Radii do not fall below 0. In a disaster with
/// quadrants, a radius of 0 stays 0.
void GrowRings(ObservableDisaster& disaster, float by);

/// Returns the index of the quadrant (0 NE, 1 SE, 2 SW, 3 NW) in which a point lies.
/// @param west how far the point is west of the centre; negative if it is east
/// @param south how far the point is south of the centre; negative if it is north
constexpr std::size_t QuadrantOf(float west, float south) {
  if (west <= 0.0F && south < 0.0F) return 0;
  if (west < 0.0F) return 1;
  if (south > 0.0F) return 2;
  return west > 0.0F ? 3 : 0;
}

/// Returns the risk of a disaster with quadrants at a point; 0 outside its rings. Does not check
/// whether the disaster has ended.
/// @param west, south position of the point as in QuadrantOf [cells]
/// @param distance_squared squared distance of the point from the centre
float RiskByQuadrant(const ObservableDisaster& disaster, float west, float south,
                     float distance_squared);

/// Returns the risk of one disaster at a point [cells]: negative inside its rings; 0 outside them
/// or after its end.
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

/// Returns the worst risk of several disasters at a cell, 0 or negative.
inline float RiskAt(const std::vector<Disaster>& disasters, Cell cell) {
  float worst = 0.0F;
  for (const Disaster& disaster : disasters) {
    const float risk = RiskOf(disaster, static_cast<float>(cell.x), static_cast<float>(cell.y));
    worst = risk < worst ? risk : worst;
  }
  return worst;
}

/// Returns the risk with which disasters damage a device at a cell. The risk of the sea is not
/// included. The risk of each disaster is multiplied by the factor of its kind, and the result is
/// the worst product. It may be worse than kWorstRisk.
/// @param factors factors of the device's kind, indexed by DisasterKind (DamageSpec::FactorsOf)
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

/// Writes the worst risk of disasters and sea to each cell of `risk`, for drawing, publishing and
/// planning.
/// @param risk [H, W], already of this size
void FillRisk(const Scenario& scenario, const std::vector<Disaster>& disasters, Grid<float>& risk);

/// Risk grids [H, W], indexed by DeviceKind. A grid is empty if its kind is not needed.
using DamagingRisks = std::array<Grid<float>, kDeviceKindCount>;

/// As FillRisk; also writes the risk that damages devices of a kind (Farm::DamagingRiskAt) to the
/// grid of that kind in `by_kind`. Skips kinds with an empty grid.
void FillRisks(const Scenario& scenario, const std::vector<Disaster>& disasters, Grid<float>& risk,
               DamagingRisks& by_kind);

}  // namespace aquafarm
