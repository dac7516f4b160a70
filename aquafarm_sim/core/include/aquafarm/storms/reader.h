// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Reads published tracks; docs/data.md says what each format holds and what is lost on the way.

#include <optional>
#include <string>
#include <vector>

#include "aquafarm/input/track_format.h"
#include "aquafarm/storms/track.h"

namespace aquafarm {

/// What a file of tracks holds.
struct StormFile {
  TrackFormat format{};
  std::vector<StormTrack> tracks;     ///< at least one, in the order of the file
  std::vector<std::string> warnings;  ///< repairs made: "file:line: what was done"
};

/// Reads a file of tracks in whichever format it is.
/// @throws InputError "CH2021BST.txt:12: latitude: got 950, expected [-900, 900]"
StormFile LoadStormFile(const std::string& path);

/// The same for text; `origin_name` stands for the file in messages.
StormFile ParseStormFile(const std::string& text, const std::string& origin_name);

/// The one track that a word names: an id, or a name in any case.
/// @throws InputError naming what there is when none or more than one fits
const StormTrack& FindTrack(const StormFile& file, const std::string& storm);

}  // namespace aquafarm
