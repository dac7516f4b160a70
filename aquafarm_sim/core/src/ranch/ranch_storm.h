// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Selects the storm of a ranch from a file and reports its passage.

#include <string>
#include <vector>

#include "aquafarm/storms/to_disaster.h"
#include "aquafarm/tracks/reader.h"

namespace aquafarm::internal {

/// Returns the storm of `track` in another file: by its id, else by its name, at the same time.
/// @param option name of the option with the file, for messages
/// @throws InputError if the file has no such storm at that time
const StormTrack& SameStorm(const std::string& option, const StormFile& file,
                            const StormTrack& track);

/// Returns the only storm of a file, or the one of a name or id.
/// @throws InputError if there is no such storm, or if several fit
StormTrack StormOf(const StormFile& file, const std::string& storm);

/// Report of `aquafarm scenario` on a storm's passage, one line each.
struct PassageReport {
  std::vector<std::string> lines;
  std::vector<std::string> warnings;
};

/// Reports a passage. It never states that a storm stays away for longer than it is known, and it
/// separates recorded from forecast data.
/// @param storm with at least one waypoint
PassageReport Report(const StormRings& storm, const Passage& passage,
                     const StormKnowledge& knowledge);

/// Returns a warning if the radii of some stretches are those of FineRings::held; else nothing.
std::string CheckWinds(std::int32_t held);

/// Returns the forecasts of an episode from the newest one issued by its start, each with the
/// points after its issue, of the agency that each bulletin lists first.
/// @param warnings receives one about a forecast that ends before the start
std::vector<StormForecast> ForecastsDuring(const std::vector<StormForecast>& forecasts,
                                           std::int64_t start, std::int64_t end,
                                           std::vector<std::string>& warnings);

/// Reports the storms that an archive gives a ranch, in one line.
std::string ArchiveLine(const std::vector<std::string>& files, const StormsSpec& storms);

/// Checks a start against the time of a storm.
/// @param end UTC at which the storm has left the ranch, or at which its known track ends
/// @returns a warning if the start is before the first known position, else ""
/// @throws InputError if the start is not before `end`
std::string CheckStart(std::int64_t start, std::int64_t end, const StormRings& storm,
                       const Passage& passage);

}  // namespace aquafarm::internal
