// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Reads published tracks. docs/data.md describes the content of each format and what is lost.

#include <optional>
#include <string>
#include <vector>

#include "aquafarm/input/track_format.h"
#include "aquafarm/tracks/track.h"

namespace aquafarm {

/// Content of a file of tracks.
struct StormFile {
  TrackFormat format{};
  std::vector<StormTrack> tracks;     ///< at least one, in the order of the file
  std::vector<std::string> warnings;  ///< repairs: "file:line: what was done"
};

/// Reads a file of tracks and detects its format.
/// @throws InputError "CH2021BST.txt:12: latitude: got 950, expected [-900, 900]"
StormFile LoadStormFile(const std::string& path);

/// Reads the same from a text; `origin_name` replaces the file name in messages.
StormFile ParseStormFile(const std::string& text, const std::string& origin_name);

/// Returns the track with the given id, or with the given name (case is ignored).
/// @throws InputError that lists the tracks of the file if no track or more than one matches
const StormTrack& FindTrack(const StormFile& file, const std::string& storm);

}  // namespace aquafarm
