// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Learners of other packages. A shared library registers its learner when it is loaded:
///
///   const bool registered = RegisterLearner({"mine", "one line for people", true, 1000000,
///                                            ObservationTypesOf, MakeLearner, MakePolicy});
///
/// Every program and node loads the libraries listed in the environment variable AQUAFARM_LEARNERS
/// (paths separated by ':') before it looks up a learner. The learner is then selected by its name
/// like one of this package. aquafarm_agents/examples/expected_sarsa has a complete one.

#include <string>
#include <vector>

#include "aquafarm/agents/training/algorithm.h"
#include "aquafarm/base/version.h"

namespace aquafarm::agents {

/// Name of the environment variable that lists libraries with learners.
inline constexpr const char* kLearnersVariable = "AQUAFARM_LEARNERS";

/// Adds a learner or policy to Algorithms(). Its texts must live as long as the program. Call it
/// before the first use of Algorithms(), for example for a static object.
/// @param built_with version of the headers; leave it out
/// @returns true, so that the call can initialize a static object
bool RegisterLearner(const Algorithm& algorithm, const char* built_with = kVersion);

/// Loads the libraries and returns all registered learners in their order. A library that is listed
/// or loaded before adds nothing.
/// @param libraries paths separated by ':'; may be empty
/// @throws InputError if a library cannot be loaded, registers nothing or was built with the
/// headers of another version
std::vector<Algorithm> LoadLearners(const std::string& libraries);

}  // namespace aquafarm::agents
