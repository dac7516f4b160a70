// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Converts the core's types to messages and back. The functions need no ROS node. A message that
/// is an output argument can be reused for the next call: its old content is overwritten.

#include <aquafarm_msgs/Cell.h>
#include <aquafarm_msgs/DeviceState.h>
#include <aquafarm_msgs/DisasterForecast.h>
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
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/farm/farm.h"
#include "aquafarm/observation/encoder.h"
#include "aquafarm/observation/view.h"
#include "aquafarm/tracks/track.h"

namespace aquafarm_sim {

/// Values of messages that are not part of a farm.
struct MessageContext {
  ros::Time stamp;  ///< time of /clock
  std::string map_frame{"map"};
  bool paced{};
  double rate_hz{10.0};  ///< steps per second of /clock
  bool paused{};
};

aquafarm_msgs::Cell ToMsg(aquafarm::Cell cell);
aquafarm_msgs::RewardTerms ToMsg(const aquafarm::RewardTerms& terms);
/// Converts the true state of a device, including its health and position.
aquafarm_msgs::DeviceState ToMsg(const aquafarm::Farm& farm, std::int32_t device);
/// Converts a disaster. Sets `known` and `visible` to true and `age` to 0, as for the true state.
void ToMsg(const aquafarm::ObservableDisaster& disaster, std::int32_t id,
           aquafarm_msgs::DisasterState& message);
/// Converts the whole state.
void ToMsg(const aquafarm::Farm& farm, const MessageContext& context,
           aquafarm_msgs::FarmState& message);
/// Converts the observation of `view.ship`. In full view the message contains the whole state, but
/// the motion of disasters is that of `view`. The joint and total fields contain the values of this
/// ship. Its reward and return are those after sharing.
/// @param view as filled by Observe for the current state of `farm`
void ToMsg(const aquafarm::Farm& farm, const aquafarm::View& view, const MessageContext& context,
           aquafarm_msgs::FarmState& message);
/// Converts the constants of an episode.
/// @param farms number of farms
/// @param yaml canonical YAML of the farm's scenario
void ToMsg(const aquafarm::Farm& farm, const aquafarm::Encoder& encoder, std::int32_t farms,
           const std::string& yaml, const MessageContext& context,
           aquafarm_msgs::FarmSpec& message);
/// Converts the summary of an episode that the farm with index `farm` has played.
/// @param accounts accounts of the episode; nullopt if the scenario has no money
aquafarm_msgs::EpisodeSummary ToMsg(const aquafarm::EpisodeRecord& record,
                                    const std::optional<aquafarm::Accounts>& accounts,
                                    std::int32_t farm, const MessageContext& context);

/// Converts islands and rocks to a grid [H, W]: 100 blocked, 0 water. The origin of the grid is the
/// south-west corner of cell (0, 0). The origin of the map frame is the centre of this cell.
nav_msgs::OccupancyGrid ChartToMsg(const aquafarm::Farm& farm, const MessageContext& context);
/// Converts the risk of disasters and sea to a grid [H, W], rounded: from 0 (no risk) to 100 (the
/// worst possible risk, -20).
void RiskToMsg(const std::vector<aquafarm::Disaster>& disasters, const aquafarm::Scenario& scenario,
               const MessageContext& context, nav_msgs::OccupancyGrid& message);

/// Returns the transform from the map frame to `frame`. The origin of `frame` is at (x, y) [cells],
/// and its x axis points along the compass bearing.
geometry_msgs::TransformStamped PoseToMsg(const std::string& frame, double x, double y,
                                          std::int32_t bearing_deg,
                                          const aquafarm::Scenario& scenario,
                                          const MessageContext& context);
/// Returns the transform from the earth frame (ECEF, WGS 84) to the map frame (axes east, north and
/// up; the origin at `origin`, height 0).
geometry_msgs::TransformStamped EarthToMsg(const aquafarm::GeoPoint& origin,
                                           const std::string& earth_frame,
                                           const MessageContext& context);
/// Returns the compass bearing of a move [degrees]; `fallback` if the action is not a move.
std::int32_t BearingOf(aquafarm::Action action, std::int32_t fallback);

/// Max number of waypoints of a track or of a forecast in a message.
inline constexpr std::size_t kMaxWaypoints = 10000;
/// Converts a disaster. Checks array lengths, `kind` and `border`. FarmServer::SetDisaster checks
/// the numbers.
/// @throws InputError "info.radii: got 1000000 entries, expected at most 4"
aquafarm::DisasterSpec FromMsg(const aquafarm_msgs::DisasterInfo& message);

/// Max number of forecasts in a message.
inline constexpr std::size_t kMaxForecasts = 1000;
/// Converts forecasts. Checks array lengths. FarmServer::SetDisaster checks the numbers.
/// @throws InputError "forecasts[0].points[3].radii: got 9 entries, expected at most 4"
std::vector<aquafarm::IssuedForecast> FromMsg(
    const std::vector<aquafarm_msgs::DisasterForecast>& messages);

/// Converts a storm bulletin to the input of ToDisaster (storms/to_disaster.h).
/// @throws InputError "storm.fixes[0].latitude_deg: got 95, expected a number in [-90, 90]"; also
///         if there is no fix, if the times are not ascending, if an array is too long, or if a fix
///         has two rings of the same wind
aquafarm::StormTrack FromMsg(const aquafarm_msgs::Storm& message);

/// Converts the fixes of a track, and the positions of its newest forecast that are later than the
/// last fix. The name of the storm is that of the track, or its id if the track has no name.
/// @param track with at least one fix
aquafarm_msgs::Storm ToMsg(const aquafarm::StormTrack& track);

/// Converts a sea layer to a grid [H, W], rounded: from 0 (its min value) to 100 (its max value),
/// or -1 for an unknown value (NaN). If all values are equal, they become 0.
void SeaToMsg(const aquafarm::SeaLayer& layer, const aquafarm::Scenario& scenario,
              const MessageContext& context, nav_msgs::OccupancyGrid& message);
/// Converts a sea layer to an array [1, H, W] of its values. The label of the first dimension
/// contains name and unit, for example "warmth [degC]".
std_msgs::Float32MultiArray SeaToMsg(const aquafarm::SeaLayer& layer,
                                     const aquafarm::Scenario& scenario);

/// Returns the scenario's world time after `step` steps; 0 if ros::Time cannot represent it. The
/// world time of a scenario without a start time starts at 0.
ros::Time WorldTime(const aquafarm::Scenario& scenario, std::int64_t step);

}  // namespace aquafarm_sim
