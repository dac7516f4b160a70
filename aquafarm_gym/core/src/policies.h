// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

namespace aquafarm::python {

/// Defines the Python classes Policy, Planner and _RescueRequest, and the functions team_bound,
/// _plan_rescue and _set_policy_folder. They make available the planners of aquafarm_agents and
/// those of its policies that do not need libtorch.
void DefinePolicies(pybind11::module_& module);

}  // namespace aquafarm::python
