// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The actions of a ship, their outcomes, and the reasons why an episode ends. § and Eq. refer to
/// the paper, see docs/model.md.

#include <array>
#include <cstdint>
#include <string_view>

#include "aquafarm/grid/cell.h"

namespace aquafarm {

/// Actions of a ship in one step (Eq. 1, §2.2). kHold is used in paced running when no command
/// arrives in time. It is not part of the learners' action space.
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

/// Legal-action mask: bit a is set if action a is legal.
using ActionMask = std::uint16_t;
inline constexpr ActionMask kMoveMask = (1U << kMoveCount) - 1;

constexpr ActionMask MaskOf(Action action) {
  return static_cast<ActionMask>(1U << static_cast<unsigned>(action));
}

/// Index of the first of the eight features blocked.<move> in an agent's feature vector;
/// Encoder::feature_names lists all features.
inline constexpr std::int32_t kFirstBlockedFeature = 5;

/// Outcome of a ship's action in the last step.
enum class Outcome : std::uint8_t {
  kOk,
  kEdge,            ///< a move off the map; the ship stayed
  kCrash,           ///< a move into a rock or island; the ship stayed
  kCollision,       ///< a move into another ship's cell; the ship stayed
  kIllegalPickup,   ///< no device to pick up here, or no capacity left
  kIllegalDropOff,  ///< not at a port, or no device aboard
  kHeld,            ///< the action was kHold, or no command arrived in time
  kOutOfPlay,       ///< a delivered self-propelled device; its action was ignored
};
inline constexpr int kOutcomeCount = 8;

/// Reason why an episode ended.
enum class EndReason : std::uint8_t {
  kNone,           ///< it has not ended
  kAllRetrieved,   ///< terminated: every device is delivered; the only success
  kDisasterEnded,  ///< terminated: the duration of every disaster has elapsed
  kStepLimit,      ///< truncated, not terminated
};
inline constexpr int kEndReasonCount = 4;
constexpr bool IsTerminated(EndReason reason) {
  return reason == EndReason::kAllRetrieved || reason == EndReason::kDisasterEnded;
}
constexpr bool IsTruncated(EndReason reason) { return reason == EndReason::kStepLimit; }

/// Returns the name used in scenario files, such as "north_west" or "all_retrieved".
std::string_view ToString(Action value);
std::string_view ToString(Outcome value);
std::string_view ToString(EndReason value);

/// Id that refers to no ship or device.
inline constexpr std::int32_t kNone = -1;

}  // namespace aquafarm
