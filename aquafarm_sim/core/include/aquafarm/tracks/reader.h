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
/// @throws InputError if the file cannot be read, its format is unknown or its content is invalid,
///   for example "CH2021BST.txt:12: number of points: got 'x', expected a whole number in …"
StormFile LoadStormFile(const std::string& path);

/// Does the same as LoadStormFile, for a text; `origin_name` replaces the file name in messages.
StormFile ParseStormFile(const std::string& text, const std::string& origin_name);

/// Returns the track whose id or shared_id is `storm` or, without such a track, the track whose
/// name or local_name is `storm`. Ignores case, except in local_name.
/// @throws InputError if no track matches (the message lists tracks of the file), or if several
///   tracks match (the message lists them)
const StormTrack& FindTrack(const StormFile& file, const std::string& storm);

}  // namespace aquafarm
