// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Facts of a state in a few words, as pictures and the panel say them.

#include <aquafarm_msgs/FarmState.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>

namespace aquafarm_viz {

/// "NE", "pickup", "drop-off" or "hold".
std::string ActionName(std::uint8_t action);

/// "crash", "edge", …; empty for what went as wanted.
std::string OutcomeName(std::uint8_t outcome);

/// "deployed", "aboard" or "delivered".
std::string StatusName(std::uint8_t status);

/// The phase of a training, such as "evaluating"; empty for one that does not exist.
std::string PhaseName(std::uint8_t phase);

/// Hours, minutes and seconds as 1:02:03; empty for what is no duration.
std::string Duration(double seconds);

/// A rate with three digits and a thousands letter.
std::string Rate(double value);

/// With its sign, one decimal.
std::string Signed(double value);

/// "2 steps are missing; 'verify' says which".
std::string MissingSteps(std::uint64_t count);

/// The reward terms of the last step by name, each summed over ships.
std::array<std::pair<const char*, float>, 7> RewardTermsOf(const aquafarm_msgs::FarmState& state);

}  // namespace aquafarm_viz
