// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Builds a scenario from a chart, a place and a storm, as `aquafarm scenario` does.

#include <string>
#include <vector>

#include "aquafarm/ranch/ranch_request.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Result of BuildRanch.
struct BuiltRanch {
  Scenario scenario;
  std::string yaml;                   ///< text of the scenario file, with comments on the sources
  std::vector<std::string> decided;   ///< decisions, one line each, for people
  std::vector<std::string> warnings;  ///< warnings about the input files
};

/// Builds a scenario.
/// @throws InputError for unreadable files, a place without water, or a storm that is not in the
///   file
BuiltRanch BuildRanch(const RanchRequest& request);

/// Draws the layout of a scenario's first episode as text, north up: # island, o rock, P port, d
/// device, . water.
std::string RenderAscii(const Scenario& scenario);

}  // namespace aquafarm
