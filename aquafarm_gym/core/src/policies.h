// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

namespace aquafarm::python {

/// Defines Policy, Planner, team_bound, _RescueRequest and _plan_rescue. They give access to the
/// planners of aquafarm_agents, and to its saved policies that do not need libtorch.
void DefinePolicies(pybind11::module_& module);

}  // namespace aquafarm::python
