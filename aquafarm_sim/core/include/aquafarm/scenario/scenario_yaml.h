// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Reads a scenario file. Every key is used or refused.
/// @throws InputError "ranch.yaml:12: disasters[0].grade: got 7, expected [1, 4]"; an unknown key
///         is answered with the keys allowed there
Scenario LoadScenario(const std::string& path);

/// The same for text; `origin_name` stands for the file in messages.
Scenario ParseScenario(const std::string& text, const std::string& origin_name);

/// Writes every number in use of a scenario, in a fixed order and in grid units, so that
/// ParseScenario(ToYaml(s)) gives s and equal scenarios give equal texts: what run folders keep.
std::string ToYaml(const Scenario& scenario);

/// Hash of what decides the play: HashBytes of ToYaml with an empty name and description. What
/// ParseScenario sets Scenario::hash to.
std::uint64_t HashScenario(const Scenario& scenario);

/// UTC seconds since 1970 of YYYY-MM-DDTHH:MM:SSZ. @throws InputError "name: got …"
std::int64_t ParseUtc(const std::string& name, const std::string& text);

}  // namespace aquafarm
