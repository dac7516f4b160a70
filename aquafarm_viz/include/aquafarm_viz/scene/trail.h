// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Tracks the past positions and headings of ships and the times at which devices were fetched,
/// which a single state does not contain.

#include <aquafarm_msgs/FarmState.h>

#include <cstdint>
#include <deque>
#include <map>
#include <opencv2/core/types.hpp>
#include <optional>

namespace aquafarm_viz {

/// The trail of a ship.
struct ShipTrail {
  int bearing_deg{};             ///< bearing of its last move, [0, 359], clockwise from north
  std::deque<cv::Point> places;  ///< visited cells, oldest first, the current one last

  /// Returns the index of the first cell after the last gap; 0 if there is no gap.
  std::size_t UnbrokenFrom() const;
};

/// Stores the trail of each ship of one farm: its last cells, or its whole route.
class Trail {
 public:
  static constexpr std::size_t kLength = 24;        ///< max cells of a trail
  static constexpr std::size_t kWhole = 1'000'000;  ///< max cells of a route
  static constexpr int kMaxJump = 2;                ///< max distance [cells] that is not a gap

  explicit Trail(std::size_t length = kLength) : length_(length) {}

  /// Adds the next state. Another episode or an earlier step clears all trails.
  void Update(const aquafarm_msgs::FarmState& state);

  /// Returns true if states between two cells are missing. A trail restarts after a gap. A route
  /// continues, and the gap is not drawn.
  static bool IsGap(cv::Point from, cv::Point to);

  /// Returns when a device was last picked up or delivered [s of the world time]; nullopt if that
  /// was before the first state.
  std::optional<std::int64_t> ChangedAt(std::int32_t device) const;

  /// Returns when a device was taken aboard [s of the world time]; nullopt if that was before the
  /// first state, or never.
  std::optional<std::int64_t> FetchedAt(std::int32_t device) const;

  /// Returns the trail of a ship; nullptr for an unknown ship.
  const ShipTrail* Find(std::int32_t ship) const;

 private:
  std::size_t length_;
  std::uint64_t seed_{};
  std::uint64_t episode_{};
  std::uint64_t step_{};
  std::map<std::int32_t, ShipTrail> ships_;
  std::map<std::int32_t, std::uint8_t> statuses_;    // of devices
  std::map<std::int32_t, std::int64_t> changed_at_;  // last change of a status [s]
  std::map<std::int32_t, std::int64_t> fetched_at_;  // [s]
};

/// Returns the bearing to draw a ship at: that of its move in this state, else of its trail, or 0.
int ShipBearingDeg(const aquafarm_msgs::ShipState& ship, const Trail* trail);

}  // namespace aquafarm_viz
