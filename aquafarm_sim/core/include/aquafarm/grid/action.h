// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The actions of a ship, their outcomes, and the reasons why an episode ends. § and Eq. mark
/// sections and equations of the paper, see docs/model.md.

#include <array>
#include <cstdint>
#include <string_view>

#include "aquafarm/grid/cell.h"

namespace aquafarm {

/// Actions of a ship in one step (Eq. 1, §2.2). With kHold the ship stays in its cell. Learners do
/// not use kHold. The server executes kHold for a ship without a command, and some policies that do
/// not learn use it.
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

/// Number of moves. The moves are the first values of Action.
inline constexpr int kMoveCount = 8;
/// Number of actions of learners: all except kHold.
inline constexpr int kActionCount = 10;

/// Displacement of each move [cells], indexed by Action. North is (0, +1) as in Eq. 1.
inline constexpr std::array<Cell, kMoveCount> kMoves{
    {{0, 1}, {0, -1}, {-1, 0}, {1, 0}, {-1, 1}, {1, 1}, {-1, -1}, {1, -1}}};

/// Legal-action mask: bit a is set if action a is legal.
using ActionMask = std::uint16_t;
/// Mask of all moves.
inline constexpr ActionMask kMoveMask = (1U << kMoveCount) - 1;

/// Returns the mask that contains one action.
constexpr ActionMask MaskOf(Action action) {
  return static_cast<ActionMask>(1U << static_cast<unsigned>(action));
}

/// Index of the feature "blocked.north" in an agent's feature vector (Encoder::feature_names). It
/// is the first of eight consecutive features "blocked.<move>". With entity tokens they are called
/// "ship.blocked.<move>".
inline constexpr std::int32_t kFirstBlockedFeature = 5;

/// Outcome of the action of a ship in the last step. A self-propelled device is also an agent with
/// an action and an outcome.
enum class Outcome : std::uint8_t {
  kOk,
  kEdge,            ///< a move off the map; the ship stayed
  kCrash,           ///< a move into a rock or island; the ship stayed
  kCollision,       ///< a move into another ship's cell outside a port; the ship stayed
  kIllegalPickup,   ///< no device to pick up, no capacity, or the agent is a self-propelled device
  kIllegalDropOff,  ///< not at a port, or a rescue ship without a device aboard
  kHeld,            ///< the action was kHold, or the ship has not acted yet
  kOutOfPlay,       ///< a self-propelled device that was delivered; its action was ignored
};
inline constexpr int kOutcomeCount = 8;

/// Reason why an episode ended.
enum class EndReason : std::uint8_t {
  kNone,           ///< the episode has not ended
  kAllRetrieved,   ///< terminated: every device is delivered; the only success
  kDisasterEnded,  ///< terminated: the duration of every disaster has elapsed
  kStepLimit,      ///< truncated, not terminated
};
inline constexpr int kEndReasonCount = 4;
constexpr bool IsTerminated(EndReason reason) {
  return reason == EndReason::kAllRetrieved || reason == EndReason::kDisasterEnded;
}
constexpr bool IsTruncated(EndReason reason) { return reason == EndReason::kStepLimit; }

/// Returns the name that files and feature names use for a value, such as "north_west" or
/// "all_retrieved".
/// @throws LogicError for a value outside the enumeration
std::string_view ToString(Action value);
std::string_view ToString(Outcome value);
std::string_view ToString(EndReason value);

/// Stands for a missing id or index, such as "no ship" or "no device".
inline constexpr std::int32_t kNone = -1;

}  // namespace aquafarm
