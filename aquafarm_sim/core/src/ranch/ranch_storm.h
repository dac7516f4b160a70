// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Selects the storm of a ranch from a file and reports its passage.

#include <string>
#include <vector>

#include "aquafarm/storms/to_disaster.h"
#include "aquafarm/tracks/reader.h"

namespace aquafarm::internal {

/// Finds the storm of `track` in another file. If the file contains only one storm, this storm
/// matches if its name equals that of `track` or if one of these names is missing. In other cases
/// the storm with the same id matches, unless the id is kUnknownStormId. If no id matches, the
/// storm with the same name matches.
/// @param option name of the option with the file, for messages
/// @throws InputError if no storm or more than one matches, or if the period of the storm does not
///   overlap that of `track`
const StormTrack& SameStorm(const std::string& option, const StormFile& file,
                            const StormTrack& track);

/// Returns the storm of a file with the given name or id. `storm` may be empty if the file contains
/// only one storm.
/// @throws InputError if no storm or more than one matches
StormTrack StormOf(const StormFile& file, const std::string& storm);

/// Report of `aquafarm scenario` on a storm's passage; each entry is one line.
struct PassageReport {
  std::vector<std::string> lines;
  std::vector<std::string> warnings;
};

/// Describes the passage of a storm until its last known position. Separates recorded from forecast
/// data.
/// @param storm with at least one waypoint
PassageReport Report(const StormRings& storm, const Passage& passage,
                     const StormKnowledge& knowledge);

/// Returns a warning if `held` (FineRings::held) is above 0, else "".
std::string CheckWinds(std::int32_t held);

/// Returns the forecasts that agents receive during an episode: the newest one issued at or before
/// the start, and those issued between start and end. Each keeps only its points after its time of
/// issue. Of several forecasts with the same time of issue, the first one with such points is kept.
/// @param forecasts sorted by time of issue
/// @param start, end UTC [s since 1970]
/// @param warnings receives a line if the first of these forecasts ends at or before the start.
///   This forecast is left out.
std::vector<StormForecast> ForecastsDuring(const std::vector<StormForecast>& forecasts,
                                           std::int64_t start, std::int64_t end,
                                           std::vector<std::string>& warnings);

/// Returns one line that describes the storms that a ranch uses from the archive `files`.
std::string ArchiveLine(const std::vector<std::string>& files, const StormsSpec& storms);

/// Checks that an episode starts before its storm ends, and not before the storm's first known
/// position.
/// @param end UTC at which the storm ends in the episode: one to two hours after the storm has left
///   the ranch. If the storm does not reach the ranch, `end` is 13 to 14 hours after the storm was
///   nearest. If the known track ends earlier, `end` is its end. Other disasters may make the
///   episode longer.
/// @returns a warning if the start is before the first known position, else ""
/// @throws InputError if the start is not before `end`
std::string CheckStart(std::int64_t start, std::int64_t end, const StormRings& storm,
                       const Passage& passage);

}  // namespace aquafarm::internal
