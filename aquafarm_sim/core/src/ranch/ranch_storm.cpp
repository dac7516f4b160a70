// SPDX-License-Identifier: BSD-3-Clause
#include "ranch/ranch_storm.h"

#include <algorithm>

#include "aquafarm/base/check.h"
#include "base/text.h"
#include "base/time.h"
#include "ranch/ranch_text.h"

namespace aquafarm::internal {
namespace {

std::string NameOfStorm(const StormTrack& track) {
  return track.name.empty() ? track.id : track.name;
}

const StormTrack& OfThatName(const std::string& option, const StormFile& file,
                             const StormTrack& track) {
  const auto letters = [](const std::string& name) {
    std::string bare = Upper(name);
    bare.erase(std::remove(bare.begin(), bare.end(), '-'), bare.end());
    return bare;
  };
  const StormTrack& first = file.tracks.front();
  const bool unnamed = first.name.empty() || track.name.empty();
  if (file.tracks.size() == 1 && (unnamed || letters(first.name) == letters(track.name))) {
    return first;
  }
  for (const StormTrack& other : file.tracks) {
    if (other.id == track.id && other.id != kUnknownStormId) return other;
  }
  try {
    return FindTrack(file, NameOfStorm(track));
  } catch (const InputError& error) {
    throw InputError(option + ": " + error.what());
  }
}

std::string Span(const std::array<std::int64_t, 2>& span) {
  return "from " + FormatTime(span[0]) + " to " + FormatTime(span[1]);
}

std::string NearestLine(const Passage& passage) {
  return Text("nearest: %.0f km at ", passage.nearest_km) + FormatTime(passage.nearest_time) +
         (passage.nearest_at_end     ? ", its last known position: it may come nearer after that"
          : passage.nearest_forecast ? ", by the forecast"
                                     : "");
}

std::string OverLine(const std::string& wind, const Passage& passage,
                     const StormKnowledge& knowledge) {
  constexpr double kShortest_h = 0.05;  // "%.1f" shows less as 0.0
  std::string line = wind + " over the ranch ";
  if (passage.widest_h >= kShortest_h) line += Text("for %.1f h, ", passage.widest_h);
  line += passage.first == passage.last ? "at " + FormatTime(passage.first)
                                        : Span({passage.first, passage.last});
  line += Text("; strongest ring %d kt", passage.worst_wind_kt);
  if (passage.first > knowledge.recorded_until) {
    line += "; all of it by the forecast";
  } else if (passage.last > knowledge.recorded_until) {
    line += "; by the forecast after " + FormatTime(knowledge.recorded_until);
  }
  if (passage.over_at_start) line += "; already over it at the first known time";
  if (passage.over_at_end) line += "; still over it at the last known time";
  return line;
}

std::string AwayLine(const std::string& wind, const StormRings& storm, const Passage& passage,
                     const StormKnowledge& knowledge) {
  const std::string known = "; the storm is " + Describe(knowledge);
  if (passage.unknown[0] != 0) {
    return wind + ": unknown whether they reach the ranch, as neither wind nor radii are known " +
           Span(passage.unknown) + " while the storm is within " + Format(kLargestGale_km) + " km" +
           known;
  }
  return wind + " do not reach the ranch " +
         Span({storm.waypoints.front().time, storm.waypoints.back().time}) + known;
}

}  // namespace

const StormTrack& SameStorm(const std::string& option, const StormFile& file,
                            const StormTrack& track) {
  const StormTrack& same = OfThatName(option, file, track);
  const std::int64_t first = same.fixes.front().time;
  const std::int64_t last = same.fixes.back().time;
  if (first <= track.fixes.back().time && last >= track.fixes.front().time) return same;
  throw InputError(option + ": got " + NameOfStorm(same) + " " + Span({first, last}) +
                   ", expected the storm " +
                   Span({track.fixes.front().time, track.fixes.back().time}));
}

StormTrack StormOf(const StormFile& file, const std::string& storm) {
  return storm.empty() && file.tracks.size() == 1 ? file.tracks[0] : FindTrack(file, storm);
}

PassageReport Report(const StormRings& storm, const Passage& passage,
                     const StormKnowledge& knowledge) {
  PassageReport report;
  const std::string wind = std::to_string(storm.wind_kt.back()) + " kt";
  const bool reaches = passage.worst_wind_kt > 0;
  if (knowledge.issued != 0) report.lines.push_back("storm: " + Describe(knowledge));
  report.lines.push_back(NearestLine(passage));
  report.lines.push_back(reaches ? OverLine(wind, passage, knowledge)
                                 : AwayLine(wind, storm, passage, knowledge));
  if (reaches && passage.unknown[0] != 0) {
    report.warnings.push_back("storm: neither wind nor radii are known " + Span(passage.unknown) +
                              " while the storm is within " + Format(kLargestGale_km) +
                              " km: it has no rings there; give --radii");
  }
  if (passage.over_at_end) {
    report.warnings.push_back("storm: " + wind + " are still over the ranch at " +
                              FormatTime(storm.waypoints.back().time) +
                              ", the last known time: what follows is unknown, not calm; give a "
                              "newer bulletin or one with a forecast");
  }
  if (!reaches && passage.nearest_km > kStormConcern_km) {
    report.warnings.push_back(
        "storm: its known track " +
        Span({storm.waypoints.front().time, storm.waypoints.back().time}) +
        Text(" comes no nearer than %.0f km to the ranch, expected within ", passage.nearest_km) +
        Format(kStormConcern_km) +
        " km; check --center, --track and --storm, or give a newer bulletin");
  }
  return report;
}

std::string CheckWinds(std::int32_t held) {
  if (held == 0) return "";
  return Text("storm: stretches of the track in which the wind cannot be interpolated: %d", held) +
         "; they have the larger radii of both ends; give a track with a wind at each point";
}

std::vector<StormForecast> ForecastsDuring(const std::vector<StormForecast>& forecasts,
                                           std::int64_t start, std::int64_t end,
                                           std::vector<std::string>& warnings) {
  std::vector<StormForecast> kept;
  for (StormForecast forecast : forecasts) {
    auto& fixes = forecast.fixes;
    fixes.erase(std::remove_if(fixes.begin(), fixes.end(),
                               [&](const StormFix& fix) { return fix.time <= forecast.issued; }),
                fixes.end());
    const bool second = !kept.empty() && kept.back().issued == forecast.issued;
    if (second || fixes.empty() || forecast.issued >= end) continue;
    if (forecast.issued <= start) kept.clear();
    kept.push_back(std::move(forecast));
  }
  const auto ends = [](const StormForecast& one) { return one.fixes.back().time; };
  if (!kept.empty() && ends(kept.front()) <= start) {
    warnings.push_back("forecasts: the forecast of " + FormatTime(kept.front().issued) +
                       " ends at " + FormatTime(ends(kept.front())) +
                       ", not after the start, and is ignored");
    kept.erase(kept.begin());
  }
  return kept;
}

std::string ArchiveLine(const std::vector<std::string>& files, const StormsSpec& storms) {
  std::string names;
  for (const std::string& file : files) names += (names.empty() ? "" : ", ") + FileName(file);
  const auto of = [](const std::vector<ArchivedStorm>& some, Range<std::int32_t> years) {
    return Text("%d storms of %d to %d", static_cast<int>(some.size()), years.min, years.max);
  };
  return "archive: " + names + ": " + of(storms.library->training, storms.years) +
         " for training, " + of(storms.library->evaluation, storms.evaluation_years) +
         " for evaluation only; credit their source";
}

std::string CheckStart(std::int64_t start, std::int64_t end, const StormRings& storm,
                       const Passage& passage) {
  if (end <= start) {
    throw InputError(
        "start: got " + FormatTime(start) + ", expected a time before " + FormatTime(end) +
        (end == storm.waypoints.back().time ? ", until when the storm is known"
         : passage.worst_wind_kt > 0 ? ", one to two hours after the storm has left the ranch"
                                     : ", 13 to 14 hours after the storm was nearest"));
  }
  const std::int64_t first = storm.waypoints.front().time;
  if (start >= first) return "";
  return "start: got " + FormatTime(start) + ", expected at least " + FormatTime(first) +
         ", the time of the storm's first known position; the storm stays there until then";
}

}  // namespace aquafarm::internal
