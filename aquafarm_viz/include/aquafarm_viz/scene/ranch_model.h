// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What the panel "Ranch" shows, as plain text and numbers: it knows no window and no node.

#include <aquafarm_msgs/DisasterInfo.h>
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/TrainingStatus.h>

#include <cstdint>
#include <string>
#include <vector>

#include "aquafarm_viz/scene/pairing.h"

namespace aquafarm_viz {

/// One point of the training curve.
struct CurvePoint {
  double episode{};
  double mean_return{};
  double success{};  ///< [0, 1]
};

class RanchModel {
 public:
  using Row = std::vector<std::string>;
  /// The curve keeps between half and all of so many points, over the whole training.
  static constexpr std::size_t kMostPoints = 1000;

  /// Each returns why it is refused, or nothing.
  std::string Take(const aquafarm_msgs::FarmSpecConstPtr& spec) { return pairing_.AddSpec(spec); }
  std::string Take(const aquafarm_msgs::FarmStateConstPtr& state);
  void Take(const aquafarm_msgs::TrainingStatusConstPtr& training);

  /// "paper   episode 12   step 17 / 5,000   return −42.5"; "no ranch yet" before the first state.
  std::string Headline() const;
  /// "reward −5.0:   disaster −5.0"
  std::string RewardLine() const;
  /// "q_learning, training   episode 120 / 2,000   mean return 81.2   success 62 %   left 0:42"
  std::string TrainingLine() const;

  /// Columns of the tables; rows have as many entries.
  static const Row& ShipColumns();
  static const Row& DeviceColumns();
  std::vector<Row> Ships() const;
  std::vector<Row> Devices() const;

  const std::vector<CurvePoint>& curve() const { return curve_; }
  const Shown& shown() const { return pairing_.shown(); }
  bool paused() const;

  /// A disaster for `set_disaster`: it begins at a ship's cell, or the farm's middle without one.
  /// @param kind of DisasterState @param grade 1 blue … 4 red, which also sets its rings' risks
  /// @param radius of the largest of its three rings [cells]
  aquafarm_msgs::DisasterInfo MakeDisaster(std::uint8_t kind, std::uint8_t grade,
                                           double radius) const;
  /// Id under which it is one more.
  std::int32_t NextDisaster() const;

 private:
  Pairing pairing_;
  aquafarm_msgs::TrainingStatusConstPtr training_;
  std::vector<CurvePoint> curve_;
  std::uint64_t every_{1};  // of the points that come, one in so many is kept
  std::uint64_t came_{};
};

}  // namespace aquafarm_viz
