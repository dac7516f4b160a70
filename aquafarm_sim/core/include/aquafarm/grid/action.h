// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The actions of a ship, their outcomes, and the reasons for which an episode ends.

#include <array>
#include <cstdint>
#include <string_view>

#include "aquafarm/grid/cell.h"

namespace aquafarm {

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

/// Names as scenario files and people write them, such as "north_west" or "all_retrieved".
std::string_view ToString(Action value);
std::string_view ToString(Outcome value);
std::string_view ToString(EndReason value);

/// Names no ship or device.
inline constexpr std::int32_t kNone = -1;

}  // namespace aquafarm
