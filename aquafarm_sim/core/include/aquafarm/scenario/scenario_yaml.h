// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Reads a scenario file. Unknown keys are rejected.
/// @throws InputError "ranch.yaml:12: disasters[0].grade: got 7, expected [1, 4]"; the message for
///         an unknown key lists the valid keys
Scenario LoadScenario(const std::string& path);

/// Reads a scenario from text; `origin_name` replaces the file name in messages.
Scenario ParseScenario(const std::string& text, const std::string& origin_name);

/// Writes every used parameter of a scenario, in a fixed order and in grid units.
/// ParseScenario(ToYaml(s)) returns s, and equal scenarios give equal texts. Run folders store this
/// text.
///
/// @param old_names  whether renamed keys get the names of version 0.1.0
std::string ToYaml(const Scenario& scenario, bool old_names = false);

/// Hash of the parameters that affect episodes: HashBytes of ToYaml with an empty name and
/// description and without winds. ParseScenario stores it in Scenario::hash.
std::uint64_t HashScenario(const Scenario& scenario);

/// Converts a time to UTC seconds since 1970: YYYY-MM-DDTHH:MM[:SS] and a zone, Z or ±HH:MM. A time
/// without a zone is refused.
/// @param name of the option or column, for the message
/// @throws InputError
std::int64_t ParseUtc(const std::string& name, const std::string& text);

}  // namespace aquafarm
