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
  std::vector<std::string> decided;   ///< choices that BuildRanch made, one line each
  std::vector<std::string> warnings;  ///< warnings about the input files and the request
};

/// Builds a scenario.
/// @throws InputError for a value out of range, an unreadable or unsuitable file, a place without
///   water or too small for the ports and devices, or a storm that is not in the file
BuiltRanch BuildRanch(const RanchRequest& request);

/// Returns a layout of the scenario as text, north up: # island, o rock, P port, d device, . water.
/// The layout is that of episode 0 with the seed Scenario::layout_seed. With LayoutMode::kFixed all
/// episodes have this layout.
/// @throws InputError if the layout cannot be drawn
std::string RenderAscii(const Scenario& scenario);

}  // namespace aquafarm
