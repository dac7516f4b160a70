// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The content of the panel "Ranch" as plain text and numbers, independent of Qt windows and nodes.

#include <aquafarm_msgs/DisasterInfo.h>
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/RescuePlan.h>
#include <aquafarm_msgs/TrainingStatus.h>
#include <ros/steady_timer.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm_viz/scene/pairing.h"
#include "aquafarm_viz/scene/plan_text.h"

namespace aquafarm_viz {

class CourseReader;

/// One point of the training curve.
struct CurvePoint {
  double episode{};
  double mean_return{};
  double success{};  ///< [0, 1]
};

class RanchModel {
 public:
  RanchModel();

  using Row = std::vector<std::string>;
  /// Capacity of the curve. A long training keeps between half this number and this number of
  /// points, spread over the whole training.
  static constexpr std::size_t kMaxPoints = 1000;

  /// Each Take adds a message. Returns the reason if it is refused; empty if it is accepted.
  std::string Take(const aquafarm_msgs::FarmSpecConstPtr& spec) { return pairing_.AddSpec(spec); }
  std::string Take(const aquafarm_msgs::FarmStateConstPtr& state);
  void Take(const aquafarm_msgs::TrainingStatusConstPtr& training);
  /// @param now steady time at which the plan was received
  void Take(const aquafarm_msgs::RescuePlanConstPtr& plan, ros::SteadyTime now) {
    plan_ = plan;
    plan_node_seen_ = now;
  }
  /// Notes a heartbeat of plan_node.
  void MarkPlanNodePresent(ros::SteadyTime now) { plan_node_seen_ = now; }

  /// Returns "paper   episode 12   step 17 / 5,000   return −42.5", or "no ranch yet" before the
  /// first state.
  std::string Headline() const;
  /// Returns "reward −5.0:   disaster −5.0".
  std::string RewardLine() const;
  /// Returns, for example:
  /// "q_learning, training   120 / 2,000 episodes   mean return 81.2   success 62 %   left 0:42"
  std::string TrainingLine() const;

  /// Column titles of the tables. Each row has the same number of entries.
  static const Row& ShipColumns();
  static const Row& DeviceColumns();
  std::vector<Row> Ships() const;
  /// The status of a device in danger is its danger: "gale now, hurricane in 6.4 h".
  std::vector<Row> Devices() const;

  /// Returns the last rescue plan; null before the first one.
  const aquafarm_msgs::RescuePlanConstPtr& plan() const { return plan_; }
  /// Returns the time since the last plan or heartbeat of plan_node [s].
  double PlanSilence(ros::SteadyTime now) const { return (now - plan_node_seen_).toSec(); }
  /// Returns the time of the plan's next orders: that of the ranch if the plan follows it, else the
  /// plan's start.
  ros::Time PlanNow() const;

  const std::vector<CurvePoint>& curve() const { return curve_; }
  const Shown& shown() const { return pairing_.shown(); }
  bool paused() const;

  /// Returns a disaster for `set_disaster`. Its centre is a ship's cell, or the centre of the farm
  /// if there is no ship.
  /// @param kind kind of DisasterState
  /// @param grade 1 blue … 4 red; also determines the risks of its rings
  /// @param radius radius of the largest of its three rings [cells]
  aquafarm_msgs::DisasterInfo MakeDisaster(std::uint8_t kind, std::uint8_t grade,
                                           double radius) const;
  /// Returns the id that adds a disaster.
  std::int32_t NextDisaster() const;

 private:
  Pairing pairing_;
  std::shared_ptr<CourseReader> courses_;
  aquafarm_msgs::TrainingStatusConstPtr training_;
  aquafarm_msgs::RescuePlanConstPtr plan_;
  ros::SteadyTime plan_node_seen_;
  std::vector<CurvePoint> curve_;
  std::uint64_t every_{1};  // keeps one of this many received points
  std::uint64_t came_{};
};

}  // namespace aquafarm_viz
