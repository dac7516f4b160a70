// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Converts the observation message of a ship for agents.

#include <aquafarm_msgs/FarmState.h>

#include "aquafarm/observation/view.h"

namespace aquafarm_sim {

/// Converts what a ship knows of a disaster.
aquafarm::KnownDisaster FromMsg(const aquafarm_msgs::DisasterState& message);

/// Restores the View of a ship from its observation message, as filled by Observe. It does not
/// restore `sensors` and the disaster fields that a view does not contain.
/// @param layout layout of the observation's episode; scenario and layout must outlive the view
/// @throws InputError if the message is not a ship's observation of a farm of `scenario`
void FromMsg(const aquafarm_msgs::FarmState& message, const aquafarm::Scenario& scenario,
             const aquafarm::Layout& layout, aquafarm::View& view);

}  // namespace aquafarm_sim
