// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Converts the observation message of a ship to the core's View, the input of agents.

#include <aquafarm_msgs/FarmState.h>

#include "aquafarm/observation/view.h"

namespace aquafarm_sim {

/// Converts a ship's information about a disaster.
aquafarm::KnownDisaster FromMsg(const aquafarm_msgs::DisasterState& message);

/// Converts the observation message of a ship to the View that Observe fills for this ship. The
/// message does not contain View::sensors, which is left unchanged. It also lacks some fields of
/// disasters (for example border, turns and growth), which get default values. Forecast positions
/// are computed from the motion in the message.
/// @param layout layout of the observation's episode; scenario and layout must outlive the view
/// @throws InputError if the message is not a ship's observation of a farm of `scenario`
void FromMsg(const aquafarm_msgs::FarmState& message, const aquafarm::Scenario& scenario,
             const aquafarm::Layout& layout, aquafarm::View& view);

}  // namespace aquafarm_sim
