// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// An upper bound on the team's return in an episode with the true future of the disasters. It is
/// the reference where the exact joint optimum of several agents is infeasible.
///
///   bound = Σ over devices of max(0, return of the best single trip for the device)
///
/// A trip starts in any port at any step, fetches the device along the best route, and brings it to
/// any port or ends with the pickup. Time before the trip costs nothing. In calm water, a step of
/// waiting on the route costs the smallest of the penalties for a step, an illegal action, a crash
/// into a neighbouring rock or island and, if there are several agents, a collision. The bound
/// ignores that a ship makes one trip at a time, that other ships may be in the way, and that ships
/// without work also pay for each step.
///
/// A ship with a capacity above 1 may fetch several devices on one route. Each trip then ignores
/// the costs of the route (steps, risks and energy) and subtracts only the damage of its device.
/// The trip of a self-propelled device starts at the device's initial cell at step 0.

#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

/// Returns an upper bound of the sum of all agents' individual returns in an episode.
/// @param farm must be at step 0 of the episode
/// @throws InputError if the reward of steps, illegal actions or collisions is positive, or if the
///   drop-off reward is negative and ships have a capacity above 1
double TeamBound(const Farm& farm);

}  // namespace aquafarm::agents
