// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What a single state cannot tell: where ships came from and which way they point.

#include <aquafarm_msgs/FarmState.h>

#include <cstdint>
#include <deque>
#include <map>
#include <opencv2/core/types.hpp>

namespace aquafarm_viz {

/// The recent way of a ship.
struct ShipWake {
  int bearing_deg{};             ///< of its last move, [0, 359], clockwise from north
  std::deque<cv::Point> places;  ///< cells it stood at, oldest first, the present one last

  /// The first place from which on no state was missed.
  std::size_t UnbrokenFrom() const;
};

/// Remembers the recent way of each ship of one farm; with room for it, its whole route.
class Wake {
 public:
  static constexpr std::size_t kLength = 24;        ///< places remembered of a wake
  static constexpr std::size_t kWhole = 1'000'000;  ///< the same of a route
  static constexpr int kMaxJump = 2;                ///< cells; farther apart: states were missed

  explicit Wake(std::size_t length = kLength) : length_(length) {}

  /// Takes the next state in; another episode or an earlier step starts anew.
  void Update(const aquafarm_msgs::FarmState& state);

  /// Whether states were missed between two places. A wake begins anew there; a route goes on, and
  /// is drawn without that piece.
  static bool IsGap(cv::Point from, cv::Point to);

  /// The way of a ship; nullptr for one never seen.
  const ShipWake* Find(std::int32_t ship) const;

 private:
  std::size_t length_;
  std::uint64_t seed_{};
  std::uint64_t episode_{};
  std::uint64_t step_{};
  std::map<std::int32_t, ShipWake> ships_;
};

/// The bearing to draw a ship at: of its move in this state, else of its wake, else 0.
int ShipBearingDeg(const aquafarm_msgs::ShipState& ship, const Wake* wake);

}  // namespace aquafarm_viz
