// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The content of the panel "Ranch" as plain text and numbers. This code requires neither Qt nor a
/// ROS node.

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

/// Stores the last messages of a ranch and returns the texts and numbers that the panel shows.
class RanchModel {
 public:
  RanchModel();

  /// The texts of one row of a table.
  using Row = std::vector<std::string>;
  /// Capacity of the curve. When it is reached, every second point is removed, so that the points
  /// always cover the whole training.
  static constexpr std::size_t kMaxPoints = 1000;

  /// The Take functions add a message. For a spec or state, they return an empty text, or the
  /// reason if the message is refused.
  std::string Take(const aquafarm_msgs::FarmSpecConstPtr& spec) { return pairing_.AddSpec(spec); }
  std::string Take(const aquafarm_msgs::FarmStateConstPtr& state);
  void Take(const aquafarm_msgs::TrainingStatusConstPtr& training);
  /// @param now time at which the plan was received
  void Take(const aquafarm_msgs::RescuePlanConstPtr& plan, ros::SteadyTime now) {
    plan_ = plan;
    plan_node_seen_ = now;
  }
  /// Adds a heartbeat of plan_node. @param now time at which it was received
  void MarkPlanNodePresent(ros::SteadyTime now) { plan_node_seen_ = now; }

  /// Returns "paper   episode 12   step 17 / 5,000   return -42.5   seed 7", followed by "paused"
  /// if the ranch is paused; "no ranch yet" before the first state.
  std::string Headline() const;
  /// Returns the last reward and its terms that are not 0, "reward -5.0:   disaster -5.0"; empty
  /// before the first state.
  std::string RewardLine() const;
  /// Returns the progress of the training, such as "q_learning, training   120 / 2,000 episodes
  /// mean return 81.2   success 62 %   1.23 k steps/s   left 0:42"; empty without a training.
  std::string TrainingLine() const;

  /// Returns the column titles of the table of Ships. Rows have the same number of entries.
  static const Row& ShipColumns();
  /// Returns the column titles of the table of Devices.
  static const Row& DeviceColumns();
  /// Returns the column titles of the table of Disasters.
  static const Row& DisasterColumns();
  /// Returns a row for each known disaster that has not ended; empty before the first state. The
  /// closest approach is empty if the course is extrapolated or comes no nearer.
  std::vector<Row> Disasters() const;
  /// Returns a row for each ship and self-propelled device; empty before the first state.
  std::vector<Row> Ships() const;
  /// Returns a row for each device; empty before the first state. The column "status" of a device
  /// in danger contains its danger, such as "gale now, 64 kt in 6.4 h".
  std::vector<Row> Devices() const;

  /// Returns the last rescue plan; null before the first one.
  const aquafarm_msgs::RescuePlanConstPtr& plan() const { return plan_; }
  /// Returns the time since the last plan or heartbeat of plan_node [s].
  double PlanSilence(ros::SteadyTime now) const { return (now - plan_node_seen_).toSec(); }
  /// Returns the parameter `now` of PlanShips: the world time of the ranch if the plan follows the
  /// ranch and has started, else the start of the plan. plan() must not be null.
  ros::Time PlanNow() const;

  const std::vector<CurvePoint>& curve() const { return curve_; }
  const Shown& shown() const { return pairing_.shown(); }
  /// Returns true if the ranch is paused; false before the first state.
  bool paused() const;

  /// Returns a disaster for the service `set_disaster`. Its centre is the cell of the first ship.
  /// If there is no ship or the first ship is not visible, the centre is the middle of the farm.
  /// Before the first state it is (0, 0).
  /// @param kind kind of DisasterState
  /// @param grade 1 blue … 4 red; also determines the risks of its rings
  /// @param radius radius of the largest of its three rings [cells]
  aquafarm_msgs::DisasterInfo MakeDisaster(std::uint8_t kind, std::uint8_t grade,
                                           double radius) const;
  /// Returns the id with which `set_disaster` adds a disaster: the number of disasters of the
  /// state, or 0 before the first state.
  std::int32_t NextDisaster() const;

 private:
  Pairing pairing_;
  std::shared_ptr<CourseReader> courses_;
  aquafarm_msgs::TrainingStatusConstPtr training_;
  aquafarm_msgs::RescuePlanConstPtr plan_;
  ros::SteadyTime plan_node_seen_;
  std::vector<CurvePoint> curve_;
  std::uint64_t every_{1};  // one of this many received points is kept
  std::uint64_t came_{};    // number of received points
};

}  // namespace aquafarm_viz
