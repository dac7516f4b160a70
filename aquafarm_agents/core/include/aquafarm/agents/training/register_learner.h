// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Learners of other packages. A shared library registers its learner when it is loaded:
///
///   const bool registered = RegisterLearner({"mine", "one line for users", true, 1000000,
///                                            ObservationTypesOf, MakeLearner, MakePolicy});
///
/// The first call of Algorithms() loads the libraries that the environment variable
/// AQUAFARM_LEARNERS lists (paths separated by ':'). Users then select the learner by its name,
/// like a learner of this package. aquafarm_agents/examples/expected_sarsa is a complete example.

#include <string>
#include <vector>

#include "aquafarm/agents/training/algorithm.h"
#include "aquafarm/base/version.h"

namespace aquafarm::agents {

/// Name of the environment variable that lists libraries with learners.
inline constexpr const char* kLearnersVariable = "AQUAFARM_LEARNERS";

/// Adds a learner or policy to Algorithms(). Must be called before the first call of Algorithms()
/// or by a library that this call loads, for example by the initialization of a static object.
/// @param algorithm its texts must stay valid until the program ends
/// @param built_with version of the headers that the caller was compiled with; do not set it
/// @returns true, so that the call can initialize a static object
bool RegisterLearner(const Algorithm& algorithm, const char* built_with = kVersion);

/// Loads the libraries. Returns all registered learners in the order of their registration. A
/// library that an earlier call loaded is not loaded again.
/// @param libraries paths separated by ':'; may be empty
/// @throws InputError if a library cannot be loaded, registers no learner or was built with the
///   headers of another version
std::vector<Algorithm> LoadLearners(const std::string& libraries);

}  // namespace aquafarm::agents
