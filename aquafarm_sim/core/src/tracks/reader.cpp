// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/tracks/reader.h"

#include <algorithm>
#include <map>
#include <set>

#include "aquafarm/base/check.h"
#include "aquafarm/base/suggest.h"
#include "aquafarm/input/track_format.h"
#include "base/field_error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/time.h"
#include "input/file_type.h"
#include "input/json_object.h"
#include "tracks/formats/formats.h"

namespace aquafarm {
namespace {

// Makes the ids of storms unique. In files of several years, storms may share an id.
void DistinguishFormats(StormFile& file, internal::ParseContext& place) {
  std::map<std::string, int> times;
  std::set<std::string> seen;
  for (const StormTrack& track : file.tracks) {
    ++times[internal::Upper(track.id)];
    seen.insert(internal::Upper(track.id));
  }
  std::map<std::string, int> last;
  place.path.clear();
  for (std::size_t i = 0; i < file.tracks.size(); ++i) {
    StormTrack& track = file.tracks[i];
    const std::string shared = internal::Upper(track.id);
    const int storms = times[shared];
    if (storms == 1) continue;
    std::string id;
    do {
      id = track.id + "-" + std::to_string(++last[shared]);
    } while (!seen.insert(internal::Upper(id)).second);
    const std::string what = "storm " + track.id + " occurs " + std::to_string(storms) +
                             " times; this one is called " + id;
    place.line = track.line;
    if (place.locate) {
      place.WarnValue(internal::At("", i), what);
    } else {
      place.Warn(what);
    }
    track.shared_id = track.id;
    track.id = id;
  }
}

}  // namespace

StormFile ParseStormFile(const std::string& text, const std::string& origin_name) {
  StormFile file;
  internal::ParseContext place(origin_name, file.warnings);
  place.line = 1;
  const std::string clean = internal::CleanJson(text);
  std::string_view content = clean;
  const std::string_view first = internal::TakeLine(content);
  if (first == "[]") place.Fail("got an empty list, expected a list of storms");
  const bool binary = text.find('\0') != std::string::npos;
  const std::optional<TrackFormat> format = binary ? std::nullopt : DetectTrackFormat(text);
  if (!format) {
    place.Fail("got " + internal::DetectFileType(text).words +
               ", expected tracks of storms: a CMA or JMA best track, an ATCF b-deck, IBTrACS "
               "CSV, a storm archive of aquafarm, or JSON of a bulletin or a weather service's "
               "track");
  }
  file.format = *format;
  const auto* const reader =
      std::find_if(internal::kTrackReaders.begin(), internal::kTrackReaders.end(),
                   [&file](const auto& one) { return one.format == file.format; });
  AQUAFARM_CHECK_EQ(reader != internal::kTrackReaders.end(), true);
  if (reader->is_json) {
    place.line = 0;
    place.locate_bytes = clean.size();
    place.locate = [&clean](const std::string& path) { return internal::LineOfJson(clean, path); };
  }
  file.tracks = reader->read(reader->is_json ? clean : internal::WithoutMark(text), place);
  DistinguishFormats(file, place);
  return file;
}

StormFile LoadStormFile(const std::string& path) {
  return ParseStormFile(internal::ReadTextFile(path), path);
}

const StormTrack& FindTrack(const StormFile& file, const std::string& storm) {
  const std::string wanted = internal::Upper(storm);
  std::vector<const StormTrack*> found;
  std::vector<const StormTrack*> named;
  std::vector<std::string> names;
  std::vector<std::string> words;  // ids and names, in capitals
  for (const StormTrack& track : file.tracks) {
    if (!storm.empty() &&
        (internal::Upper(track.id) == wanted || internal::Upper(track.shared_id) == wanted)) {
      found.push_back(&track);
    } else if (!storm.empty() &&
               (internal::Upper(track.name) == wanted || track.local_name == storm)) {
      named.push_back(&track);
    }
    names.push_back(track.id + (track.name.empty() ? "" : " " + track.name));
    words.push_back(internal::Upper(track.name));
    words.push_back(internal::Upper(track.id));
  }
  constexpr std::size_t kMaxNamed = 60;
  if (names.size() > kMaxNamed) {
    const std::string more = std::to_string(names.size() - kMaxNamed) + " more";
    names.resize(kMaxNamed);
    names.push_back(more);
  }
  if (found.empty()) found = named;
  if (found.size() == 1) return *found[0];
  std::string where;
  for (const StormTrack* track : found) {
    where += (where.empty() ? "" : ", ") + track->id + " from " +
             internal::FormatTime(track->fixes.front().time);
  }
  throw InputError("storm: got '" + storm + "'" + (found.empty() ? DidYouMean(wanted, words) : "") +
                   ", expected " +
                   (found.empty() ? "one of: " + internal::List(names)
                                  : "an id, because several storms match: " + where));
}

}  // namespace aquafarm
