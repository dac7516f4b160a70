// SPDX-License-Identifier: BSD-3-Clause
// Reads the recorded storms of a scenario and keeps those in reach of the farm.
#include <algorithm>
#include <filesystem>

#include "aquafarm/base/check.h"
#include "aquafarm/tracks/archive.h"
#include "aquafarm/tracks/place_storm.h"
#include "aquafarm/tracks/reader.h"
#include "scenario/schema.h"

namespace aquafarm::internal {
namespace {

std::string RangeText(Range<std::int32_t> years) {
  return "[" + Format(years.min) + ", " + Format(years.max) + "]";
}

bool Has(Range<std::int32_t> years, std::int32_t year) {
  return year >= years.min && year <= years.max;
}

void CheckTimes(const StormsSpec& storms, double duration_h, const std::string& path) {
  if (storms.years.min <= storms.evaluation_years.max &&
      storms.evaluation_years.min <= storms.years.max) {
    throw FieldError(Join(path, "evaluation_years"), "got " + RangeText(storms.evaluation_years) +
                                                         ", expected years outside of 'years', " +
                                                         RangeText(storms.years) +
                                                         ": training must not see them");
  }
  const double first_h = storms.approach_h - storms.perturbation.start_h;
  const double last_h = storms.approach_h + storms.perturbation.start_h;
  if (first_h >= 0.0 && last_h <= duration_h) return;
  throw FieldError(Join(path, "approach_h"),
                   "got " + Format(storms.approach_h) + " +- perturbation.start_h " +
                       Format(storms.perturbation.start_h) +
                       ", expected a closest approach in the episode, [0, " + Format(duration_h) +
                       "] hours; change approach_h, start_h or the disaster's duration");
}

StormSite SiteOf(const StormsSpec& storms, const WorldFrame& frame, double duration_h) {
  // A displacement along the track changes the time of the closest approach.
  constexpr double kMargin_h = 12.0;
  StormSite site{*frame.grid, frame.cell_size_m, frame.step_duration_s, frame.x,
                 frame.y,     storms.within_km,  storms.approach_h};
  site.before_h = storms.approach_h + storms.perturbation.start_h + kMargin_h;
  site.after_h = duration_h - storms.approach_h + storms.perturbation.start_h + kMargin_h;
  return site;
}

std::vector<StormTrack> ReadFiles(const std::vector<std::string>& files, const WorldFrame& frame,
                                  const std::string& path) {
  std::vector<StormTrack> tracks;
  for (std::size_t i = 0; i < files.size(); ++i) {
    try {
      StormFile file = LoadStormFile((std::filesystem::path(frame.folder) / files[i]).string());
      std::move(file.tracks.begin(), file.tracks.end(), std::back_inserter(tracks));
    } catch (const InputError& error) {
      throw FieldError(At(Join(path, "archive"), i), error.what());
    }
  }
  return tracks;
}

std::vector<StormTrack> ReadTracks(const std::string& text, const std::string& path) {
  if (text.empty()) throw FieldError(Join(path, "archive"), "missing, expected a list of files");
  try {
    return ParseStormFile(text, "tracks").tracks;
  } catch (const InputError& error) {
    throw FieldError(Join(path, "tracks"), error.what());
  }
}

void CheckFound(const std::vector<ArchivedStorm>& found, const char* key, Range<std::int32_t> years,
                std::size_t read, const StormsSpec& storms, const std::string& path) {
  if (!found.empty()) return;
  throw FieldError(Join(path, key),
                   "got " + RangeText(years) + ", but none of the archive's " +
                       std::to_string(read) +
                       " storms is from these years, has gales and comes within within_km = " +
                       Format(storms.within_km) +
                       " km of the middle of the farm; expected at least one: check the years, "
                       "within_km and grid.origin");
}

}  // namespace

void Resolve(const std::vector<std::string>& files, const WorldFrame* frame,
             const std::string& path, DisasterSpec& disaster) {
  if (frame == nullptr || !frame->grid) {
    throw FieldError(path, "needs grid.origin, which is missing");
  }
  StormsSpec& storms = *disaster.storms;
  const double duration_h = disaster.duration * frame->step_duration_s / 3600.0;
  CheckTimes(storms, duration_h, path);
  const std::vector<StormTrack> read =
      files.empty() ? ReadTracks(storms.tracks, path) : ReadFiles(files, *frame, path);
  const StormSite site = SiteOf(storms, *frame, duration_h);
  std::vector<StormTrack> kept;
  auto library = std::make_shared<StormLibrary>();
  for (StormTrack& track : SelectStorms(read, site)) {
    ArchivedStorm storm = PlaceAtSite(track, site);
    const bool training = Has(storms.years, storm.year);
    if (!training && !Has(storms.evaluation_years, storm.year)) continue;
    (training ? library->training : library->evaluation).push_back(std::move(storm));
    kept.push_back(std::move(track));
  }
  CheckFound(library->training, "years", storms.years, read.size(), storms, path);
  CheckFound(library->evaluation, "evaluation_years", storms.evaluation_years, read.size(), storms,
             path);
  storms.tracks = WriteArchive(kept);
  Check(Join(path, "tracks"), storms.tracks, TextOf{0, kMaxArchiveBytes});
  storms.risks =
      disaster.grade_risks.empty() ? GradeRisks(4, disaster.risks) : disaster.grade_risks;
  disaster.track = StormPlacer().Place(library->training.front().path, {}, storms.risks);
  if (disaster.grade_risks.empty()) disaster.risks = disaster.track.front().risks;
  storms.library = std::move(library);
}

}  // namespace aquafarm::internal
