// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The storm of a ranch: which one of a file, and what is known of its passage.

#include <string>
#include <vector>

#include "aquafarm/storms/reader.h"
#include "aquafarm/storms/to_disaster.h"

namespace aquafarm::internal {

/// The storm of `track` in another file: by its id, else by its name, at the same time.
/// @param option that names the file, for messages
/// @throws InputError when the file has no such storm at that time
const StormTrack& SameStorm(const std::string& option, const StormFile& file,
                            const StormTrack& track);

/// What `aquafarm scenario` reports of a storm's passage, a line each.
struct PassageReport {
  std::vector<std::string> lines;
  std::vector<std::string> warnings;
};

/// Reports a passage. It never states that a storm stays away for longer than it is known, and it
/// separates what is recorded from what is forecast.
/// @param storm with at least one waypoint
PassageReport Report(const StormRings& storm, const Passage& passage,
                     const StormKnowledge& knowledge);

/// Checks a start against the time of a storm.
/// @param end UTC at which the storm has left the ranch, or is known no more
/// @returns a warning when the start is before the first known position, or ""
/// @throws InputError when the start is not before `end`
std::string CheckStart(std::int64_t start, std::int64_t end, const StormRings& storm,
                       const Passage& passage);

}  // namespace aquafarm::internal
