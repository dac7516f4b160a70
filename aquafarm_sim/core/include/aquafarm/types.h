// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Axes, units and the small closed sets of the farm. They are defined here and only here.
///
///        y (north)
///        ^        (0, H-1) . . . (W-1, H-1)
///        |           .               .        linear index = y * W + x
///        |         (0, 0)  . . . (W-1, 0)     as nav_msgs/OccupancyGrid; images are flipped
///        +------> x (east)
///
/// Lengths are cells, times are steps unless a name says otherwise. (§2.4, Eq. 1)

#include <array>
#include <cstdint>
#include <string_view>

namespace aquafarm {

/// A grid cell; its centre has the integer coordinates (x, y).
struct Cell {
  std::int32_t x{};
  std::int32_t y{};
  friend constexpr bool operator==(Cell a, Cell b) { return a.x == b.x && a.y == b.y; }
  friend constexpr bool operator!=(Cell a, Cell b) { return !(a == b); }
};

/// What a ship may do in one step (Eq. 1, §2.2). kHold is a command for a ship that answers late
/// in paced running; it is no part of the learners' action space.
enum class Action : std::uint8_t {
  kNorth,
  kSouth,
  kWest,
  kEast,
  kNorthWest,
  kNorthEast,
  kSouthWest,
  kSouthEast,
  kPickup,
  kDropOff,
  kHold,
};

inline constexpr int kMoveCount = 8;
inline constexpr int kActionCount = 10;

/// The displacement of each move, indexed by Action; N = (0, +1) as in Eq. 1.
inline constexpr std::array<Cell, kMoveCount> kMoves{
    {{0, 1}, {0, -1}, {-1, 0}, {1, 0}, {-1, 1}, {1, 1}, {-1, -1}, {1, -1}}};

/// Legal-action mask: bit a is set when action a would not be ILLEGAL.
using ActionMask = std::uint16_t;
inline constexpr ActionMask kMoveMask = (1U << kMoveCount) - 1;

constexpr ActionMask MaskOf(Action action) {
  return static_cast<ActionMask>(1U << static_cast<unsigned>(action));
}

/// Where in an agent's feature vector the eight blocked.<move> begin; Encoder::feature_names has
/// all.
inline constexpr std::int32_t kFirstBlockedFeature = 5;

/// What became of a ship's action in the last step.
enum class Outcome : std::uint8_t {
  kOk,
  kEdge,            ///< a move off the map; the ship stayed
  kCrash,           ///< a move into a rock or island; the ship stayed
  kCollision,       ///< a move into another ship's cell; the ship stayed
  kIllegalPickup,   ///< nothing to pick up here, or no capacity left
  kIllegalDropOff,  ///< not at a port, or nothing aboard
  kHeld,            ///< the ship was told to hold, or gave no command in time
  kOutOfPlay,       ///< a delivered self-propelled device; its action was ignored
};
inline constexpr int kOutcomeCount = 8;

/// Why an episode is over.
enum class EndReason : std::uint8_t {
  kNone,           ///< it is not over
  kAllRetrieved,   ///< terminated: every device is delivered; the only success
  kDisasterEnded,  ///< terminated: every disaster's duration is over
  kStepLimit,      ///< truncated, not terminated
};
inline constexpr int kEndReasonCount = 4;
constexpr bool IsTerminated(EndReason reason) {
  return reason == EndReason::kAllRetrieved || reason == EndReason::kDisasterEnded;
}
constexpr bool IsTruncated(EndReason reason) { return reason == EndReason::kStepLimit; }

/// The four kinds of breeding equipment of Fig. 1.
enum class DeviceKind : std::uint8_t {
  kTemporaryBreeding,
  kMonitoring,
  kBreedingRelease,
  kDeepWaterBreeding
};
inline constexpr int kDeviceKindCount = 4;

enum class DeviceStatus : std::uint8_t { kDeployed, kAboard, kDelivered };
inline constexpr int kDeviceStatusCount = 3;

enum class DisasterKind : std::uint8_t {
  kTyphoon,
  kStormSurge,
  kWave,
  kRedTide,
  kOilSpill,
  kChemicalSpill
};
inline constexpr int kDisasterKindCount = 6;

/// Names as scenario files and people write them, such as "north_west" or "all_retrieved".
std::string_view ToString(Action value);
std::string_view ToString(Outcome value);
std::string_view ToString(EndReason value);
std::string_view ToString(DeviceKind value);
std::string_view ToString(DeviceStatus value);
std::string_view ToString(DisasterKind value);

/// Names no ship or device.
inline constexpr std::int32_t kNone = -1;

}  // namespace aquafarm
