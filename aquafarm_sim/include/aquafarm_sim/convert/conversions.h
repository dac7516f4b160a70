// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// From the core's types to messages and back, as free functions that know nothing of nodes. Those
/// with a message as last argument fill it and reuse its memory.

#include <aquafarm_msgs/Cell.h>
#include <aquafarm_msgs/DeviceState.h>
#include <aquafarm_msgs/DisasterInfo.h>
#include <aquafarm_msgs/DisasterState.h>
#include <aquafarm_msgs/EpisodeSummary.h>
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/RewardTerms.h>
#include <aquafarm_msgs/Storm.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/OccupancyGrid.h>
#include <ros/time.h>
#include <std_msgs/Float32MultiArray.h>

#include <cstdint>
#include <string>
#include <vector>

#include "aquafarm/farm/farm.h"
#include "aquafarm/observation/encoder.h"
#include "aquafarm/observation/view.h"
#include "aquafarm/storms/track.h"

namespace aquafarm_sim {

/// What a message says besides what the farm knows.
struct MessageContext {
  ros::Time stamp;  ///< of /clock
  std::string map_frame{"map"};
  bool paced{};
  double rate_hz{10.0};
  bool paused{};
};

aquafarm_msgs::Cell ToMsg(aquafarm::Cell cell);
aquafarm_msgs::RewardTerms ToMsg(const aquafarm::RewardTerms& terms);
/// Health and place as they are, not as someone knows them.
aquafarm_msgs::DeviceState ToMsg(const aquafarm::Farm& farm, std::int32_t device);
/// As it is: known, visible and of age 0.
void ToMsg(const aquafarm::ObservableDisaster& disaster, std::int32_t id,
           aquafarm_msgs::DisasterState& message);
/// The whole state.
void ToMsg(const aquafarm::Farm& farm, const MessageContext& context,
           aquafarm_msgs::FarmState& message);
/// What `view.ship` knows; in full view everything. Its reward and return are its own.
void ToMsg(const aquafarm::Farm& farm, const aquafarm::View& view, const MessageContext& context,
           aquafarm_msgs::FarmState& message);
/// `farms` and `yaml` are the number of farms and the canonical text of the farm's scenario.
void ToMsg(const aquafarm::Farm& farm, const aquafarm::Encoder& encoder, std::int32_t farms,
           const std::string& yaml, const MessageContext& context,
           aquafarm_msgs::FarmSpec& message);
aquafarm_msgs::EpisodeSummary ToMsg(const aquafarm::EpisodeRecord& record, std::int32_t farm,
                                    const MessageContext& context);

/// Land and rocks: 100 blocked, 0 water. The grid's origin is the south-west corner of cell (0, 0),
/// whose centre is the origin of the map frame.
nav_msgs::OccupancyGrid ChartToMsg(const aquafarm::Farm& farm, const MessageContext& context);
/// 0 no risk … 100 the worst there can be (-20), rounded.
void RiskToMsg(const std::vector<aquafarm::Disaster>& disasters, const aquafarm::Scenario& scenario,
               const MessageContext& context, nav_msgs::OccupancyGrid& message);

/// map → frame at a point [cells], facing a compass bearing.
geometry_msgs::TransformStamped PoseToMsg(const std::string& frame, double x, double y,
                                          std::int32_t bearing_deg,
                                          const aquafarm::Scenario& scenario,
                                          const MessageContext& context);
/// earth (ECEF of WGS 84) → map (east, north, up at the origin).
geometry_msgs::TransformStamped EarthToMsg(const aquafarm::GeoPoint& origin,
                                           const std::string& earth_frame,
                                           const MessageContext& context);
/// Compass bearing of a move; `otherwise` for what is no move.
std::int32_t BearingOf(aquafarm::Action action, std::int32_t otherwise);

/// Most waypoints that a track in a message may have.
inline constexpr std::size_t kMaxWaypoints = 10000;
/// Checks sizes and closed sets; numbers are checked where the disaster is set.
/// @throws InputError "info.radii: got 1000000 entries, expected at most 4"
aquafarm::DisasterSpec FromMsg(const aquafarm_msgs::DisasterInfo& message);

/// A bulletin of the globe, for ToDisaster of hazard_disaster.h.
/// @throws InputError "storm.fixes[0].latitude_deg: got 95, expected a number in [-90, 90]"
aquafarm::HazardTrack FromMsg(const aquafarm_msgs::Storm& message);

/// A track with the forecast that it goes on with, if it has one.
aquafarm_msgs::Storm ToMsg(const aquafarm::HazardTrack& track);

/// A layer of the sea: 0 its least value … 100 its greatest, -1 unknown.
void SeaToMsg(const aquafarm::SeaLayer& layer, const aquafarm::Scenario& scenario,
              const MessageContext& context, nav_msgs::OccupancyGrid& message);
/// The same in its own units, [1, H, W]; the first dimension's label is "warmth [degC]".
std_msgs::Float32MultiArray SeaToMsg(const aquafarm::SeaLayer& layer,
                                     const aquafarm::Scenario& scenario);

/// Time in the scenario's world after `step` steps; 0 when it cannot be a ros::Time.
ros::Time WorldTime(const aquafarm::Scenario& scenario, std::int64_t step);

}  // namespace aquafarm_sim
