// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// An upper bound on what several agents can earn in an episode, with the disasters' true future:
/// each device by its best ship and no conflicts. The yardstick where the exact optimum of all
/// agents together is out of reach.
///
///   bound = Σ over devices of the best single trip for it, or 0 where none pays
///
/// A rescue ship's trip begins in any port at any step, fetches the device along the best course
/// through the real disasters and brings it to any port. Waiting before the trip is free; waiting
/// on the way costs the least of a step, an illegal action, a crash into a neighbouring rock and,
/// with several ships, a collision. Everything that this leaves out costs: a ship on two trips at
/// once, other ships in the way, ships with nothing to do. With a capacity above 1 ships may share
/// their way between devices, so there only a device's own wear is paid. A self-propelled device's
/// trip begins where and when it is deployed.

#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

/// Bound on the return of the rest of an episode that has just begun.
/// @param farm at step 0 of its episode
/// @throws InputError when the scenario pays for steps, illegal actions or collisions
double TeamBound(const Farm& farm);

}  // namespace aquafarm::agents
