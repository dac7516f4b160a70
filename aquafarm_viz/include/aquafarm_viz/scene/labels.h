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

/// Returns the name of an action: a compass point such as "NE" for a move, "pickup", "drop-off", or
/// "hold" for any other action.
std::string ActionName(std::uint8_t action);

/// Returns the choice of a compared policy for a ship: "NW (value 87.5)", or "NW" if the policy has
/// no values; empty if the choice has no action for the ship, or if the ship is not active.
std::string ChoiceText(const aquafarm_msgs::PolicyChoice& choice,
                       const aquafarm_msgs::ShipState& ship);

/// Returns a short name of an outcome: "edge", "crash", "collision", "illegal" or "delivered";
/// empty for all other outcomes, such as OK.
std::string OutcomeName(std::uint8_t outcome);

/// Returns the time in the scenario: "2021-07-24 16:00 UTC", or "0 h 51 min" if the scenario has no
/// start time.
std::string ClockText(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state);

/// Returns the result of a command with its reward: "executed, -1.0, step 5" or "illegal pickup,
/// -10.0, step 5". On a paced ranch the result is not known yet: "accepted for step 6".
std::string DescribeResult(const aquafarm_msgs::CommandResult& result);

/// Returns the name of a device status: "deployed", "aboard" or "delivered"; empty if it is
/// unknown.
std::string StatusName(std::uint8_t status);

/// Returns the label of a device: F and its id, such as "F2" (F_j in Fig. 5 of the paper).
std::string DeviceLabel(std::int32_t id);

/// Returns the name of the port in a cell, such as "port B"; empty if there is none.
std::string PortText(const aquafarm_msgs::FarmSpec& spec, int x, int y);

/// Returns true if drawings label the device in its cell: it is deployed, and the cell is inside
/// the grid.
bool IsLabelled(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::DeviceState& device);

/// Returns why an episode ended: "All devices retrieved". Without success, the text contains the
/// number of devices in port: "The disaster has ended: 2 of 3 devices in port".
std::string EndText(const aquafarm_msgs::FarmState& state);

/// Returns the name of a training phase, such as "evaluating"; empty for an unknown phase.
std::string PhaseName(std::uint8_t phase);

/// Formats a duration as "1:02:03" (hours, minutes, seconds), or "2:03" below an hour; empty if it
/// is not in [0, 1e8] seconds.
std::string Duration(double seconds);

/// Formats a rate with a suffix for thousands and millions: "850", "1.23 k", "12.3 M".
std::string Rate(double value);

/// Formats a number with one decimal, and with "+" if it is above 0.
std::string Signed(double value);

/// Returns a warning about missing steps: "2 steps are missing; 'verify' names the first".
std::string MissingSteps(std::uint64_t count);

/// Returns the name and the value of each reward term of the last step, summed over the ships.
std::vector<std::pair<std::string, float>> RewardTermsOf(const aquafarm_msgs::FarmState& state);

}  // namespace aquafarm_viz
