// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A scenario from a chart, a place and a storm: what `aquafarm scenario` does.

#include <string>
#include <vector>

#include "aquafarm/ranch/ranch_request.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// A ranch made.
struct BuiltRanch {
  Scenario scenario;
  std::string yaml;                   ///< the file, with comments that say where it comes from
  std::vector<std::string> decided;   ///< a line each, for people
  std::vector<std::string> warnings;  ///< of the files read
};

/// @throws InputError for files that cannot be read, a place without water, a storm not in the file
BuiltRanch BuildRanch(const RanchRequest& request);

/// The layout of a scenario's first episode as text, north up: # island, o rock, P port, d device,
/// . water.
std::string RenderAscii(const Scenario& scenario);

}  // namespace aquafarm
