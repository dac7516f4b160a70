// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// An upper bound on the return of several agents in an episode, given the true future of the
/// disasters: each device is fetched by its best ship, without conflicts. It is the reference where
/// the exact joint optimum is infeasible.
///
///   bound = Σ over devices of max(0, return of the best single trip for the device)
///
/// A rescue ship's trip begins in any port at any step, fetches the device along the best route
/// through the real disasters and brings it to any port. Waiting before the trip is free. Waiting
/// on the route costs the smallest penalty among a step, an illegal action, a crash into a
/// neighbouring rock and, with several ships, a collision. Everything that the bound ignores has a
/// cost: a ship on two trips at once, other ships in the way, ships without work. With a capacity
/// above 1, ships may fetch several devices on one route, so only the device's own damage counts.
/// The trip of a self-propelled device begins at its deployed position at step 0.

#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

/// Returns an upper bound on the return of an episode.
/// @param farm at step 0 of its episode
/// @throws InputError if the reward of steps, illegal actions or collisions is positive
double TeamBound(const Farm& farm);

}  // namespace aquafarm::agents
