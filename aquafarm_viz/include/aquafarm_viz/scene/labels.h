// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Formats parts of a state as short texts for pictures and the panel.

#include <aquafarm_msgs/CommandResult.h>
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/PolicyChoice.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace aquafarm_viz {

/// Name of an action: "NE", "pickup", "drop-off" or "hold".
std::string ActionName(std::uint8_t action);

/// A compared policy's choice for a ship: "NW (value 87.5)", or "NW" without values; empty if it
/// has none.
std::string ChoiceText(const aquafarm_msgs::PolicyChoice& choice,
                       const aquafarm_msgs::ShipState& ship);

/// Name of an outcome: "crash", "edge", …; empty for OK.
std::string OutcomeName(std::uint8_t outcome);

/// The time in the scenario: "2021-07-24 16:00 UTC", or "0 h 51 min" without a start time.
std::string ClockText(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state);

/// The result of a command: "executed, -1.0, step 5", "illegal pickup, -10.0, step 5"; paced:
/// "accepted for step 6", because its result is not known yet.
std::string DescribeResult(const aquafarm_msgs::CommandResult& result);

/// Name of a device status: "deployed", "aboard" or "delivered".
std::string StatusName(std::uint8_t status);

/// Label of a device in a drawing: F_j of Fig. 5 of the paper, where j is the id, such as "F2".
std::string DeviceLabel(std::int32_t id);

/// Returns true if a drawing labels the device: inside the grid, neither aboard nor delivered.
bool IsLabelled(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::DeviceState& device);

/// Name of a training phase, such as "evaluating"; empty for an unknown phase.
std::string PhaseName(std::uint8_t phase);

/// Formats a duration as 1:02:03 (hours, minutes, seconds); empty if it is not a valid duration.
std::string Duration(double seconds);

/// Formats a rate with three digits and a suffix for thousands.
std::string Rate(double value);

/// Formats a number with its sign and one decimal.
std::string Signed(double value);

/// Warning about missing steps: "2 steps are missing; 'verify' names the first".
std::string MissingSteps(std::uint64_t count);

/// Returns the reward terms of the last step with their names, each summed over ships.
std::vector<std::pair<std::string, float>> RewardTermsOf(const aquafarm_msgs::FarmState& state);

}  // namespace aquafarm_viz
