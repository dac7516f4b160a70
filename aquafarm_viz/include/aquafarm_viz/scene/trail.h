// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Collects what a single state does not contain: the past cells and the headings of ships, and the
/// times at which devices were fetched and delivered.

#include <aquafarm_msgs/FarmState.h>

#include <cstdint>
#include <deque>
#include <map>
#include <opencv2/core/types.hpp>
#include <optional>

namespace aquafarm_viz {

/// The trail of a ship.
struct ShipTrail {
  int bearing_deg{};             ///< bearing of the last move, [0, 359]; 0 before the first move
  std::deque<cv::Point> places;  ///< visited cells, oldest first, the current one last
  /// Per cell in `places`: whether the ship had a device aboard when it reached the cell; always
  /// true for a self-propelled device.
  std::deque<bool> loaded;

  /// Returns the index of the first cell after the last gap; 0 if there is no gap (IsGap).
  std::size_t UnbrokenFrom() const;
};

/// Stores the trail of each ship of one farm: the last cells of the ship, or its whole route.
class Trail {
 public:
  static constexpr std::size_t kLength = 24;        ///< max cells of a trail
  static constexpr std::size_t kWhole = 1'000'000;  ///< max cells of a route
  static constexpr int kMaxJump = 2;  ///< a larger distance [cells] along an axis is a gap

  /// @param length max cells of each trail; kWhole: routes
  explicit Trail(std::size_t length = kLength) : length_(length) {}

  /// Adds the next state. A state of another episode or of an earlier step first clears everything.
  /// The trail of a ship that is not visible is cleared.
  void Update(const aquafarm_msgs::FarmState& state);

  /// Returns true if two successive cells of a trail are more than kMaxJump apart along an axis,
  /// because states between them are missing. A trail restarts after a gap. A route continues after
  /// it, and drawings leave the gap out.
  static bool IsGap(cv::Point from, cv::Point to);

  /// Returns when the status of a device last changed, because it was picked up or delivered [s of
  /// the world time]; nullopt if no such change was observed.
  std::optional<std::int64_t> ChangedAt(std::int32_t device) const;

  /// Returns when a device was last picked up [s of the world time]; nullopt if that was not
  /// observed.
  std::optional<std::int64_t> FetchedAt(std::int32_t device) const;

  /// Returns the trail of a ship; nullptr if the ship is unknown or not visible.
  const ShipTrail* Find(std::int32_t ship) const;

 private:
  std::size_t length_;
  std::uint64_t seed_{};
  std::uint64_t episode_{};
  std::uint64_t step_{};
  std::map<std::int32_t, ShipTrail> ships_;
  std::map<std::int32_t, std::uint8_t> statuses_;    // by device
  std::map<std::int32_t, std::int64_t> changed_at_;  // by device [s of the world time]
  std::map<std::int32_t, std::int64_t> fetched_at_;  // by device [s of the world time]
};

/// Returns the bearing with which a ship is drawn [degrees]: the bearing of its move in this state.
/// For a ship that does not move, returns the bearing of its last move in `trail`; 0 if unknown.
/// @param trail may be null
int ShipBearingDeg(const aquafarm_msgs::ShipState& ship, const Trail* trail);

}  // namespace aquafarm_viz
