// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Reads a scenario file. Prints a notice to stderr for each key that is given by its old name.
/// @throws InputError for an unreadable or invalid file, for example
///         "ranch.yaml:12: disasters[0].grade: got 7, expected [1, 4]". For an unknown key,
///         the message lists the valid keys.
Scenario LoadScenario(const std::string& path);

/// Reads a scenario from text as LoadScenario does, but prints no notices. `origin_name` replaces
/// the file name in messages. Paths in the text are relative to the folder of `origin_name`.
Scenario ParseScenario(const std::string& text, const std::string& origin_name);

/// Returns the YAML text of every used parameter of a scenario, in a fixed order and in grid units.
/// ParseScenario(ToYaml(s)) returns s, with defaults for the parameters that s does not use. Equal
/// scenarios give equal texts. Run folders store this text.
/// @param old_names whether renamed keys get their old names
std::string ToYaml(const Scenario& scenario, bool old_names = false);

/// Returns a hash of a scenario: HashBytes of ToYaml with old names. The hash ignores the
/// scenario's name and description, the names of disasters, and the winds of rings and waypoints.
/// ParseScenario stores it in Scenario::hash.
std::uint64_t HashScenario(const Scenario& scenario);

/// Converts a time to UTC seconds since 1970. The format is YYYY-MM-DDTHH:MM[:SS] followed by a
/// zone: Z or ±HH:MM.
/// @param name name of the option or column, for the message
/// @throws InputError if `text` is not such a time or has no zone
std::int64_t ParseUtc(const std::string& name, const std::string& text);

}  // namespace aquafarm
