// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

namespace aquafarm::python {

/// Defines Policy, Planner, team_bound and _plan_rescue: the planners and saved policies of
/// aquafarm_agents that need no libtorch.
void DefinePolicies(pybind11::module_& module);

}  // namespace aquafarm::python
