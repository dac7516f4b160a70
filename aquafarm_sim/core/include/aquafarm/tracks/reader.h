// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Reads published tracks. docs/data.md describes each format and the fields that are not read.

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
  std::vector<std::string> warnings;  ///< "file:line: …", for example about points left out
};

/// Reads a file of tracks and detects its format.
/// @throws InputError if the format is unknown or the content is invalid, for example
///   "CH2021BST.txt:12: latitude: got 950, expected [-900, 900]"
StormFile LoadStormFile(const std::string& path);

/// As LoadStormFile, for a text; `origin_name` replaces the file name in messages.
StormFile ParseStormFile(const std::string& text, const std::string& origin_name);

/// Returns the track with the given id or, if no id matches, with the given name. Case is ignored.
/// @throws InputError if no track matches (the message lists the tracks of the file), or if several
///   tracks match (the message lists the matching ones)
const StormTrack& FindTrack(const StormFile& file, const std::string& storm);

}  // namespace aquafarm
