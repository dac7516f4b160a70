// SPDX-License-Identifier: BSD-3-Clause
// Completes a track after reading: checks the order of time and jumps, and computes the motion.
#include <GeographicLib/Geodesic.hpp>
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "base/time.h"
#include "tracks/track_text.h"

namespace aquafarm::internal {
namespace {

// Returns the indices of the longest ascending subsequence of fix times (patience sorting).
std::vector<std::size_t> LongestAscending(const std::vector<StormFix>& fixes) {
  constexpr std::size_t kNoIndex = static_cast<std::size_t>(-1);
  // ends[k] is the index of the earliest fix that ends an ascending subsequence of length k + 1.
  std::vector<std::size_t> ends;
  std::vector<std::size_t> before(fixes.size(), kNoIndex);
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const auto at = std::lower_bound(
        ends.begin(), ends.end(), fixes[i].time,
        [&fixes](std::size_t end, std::int64_t time) { return fixes[end].time < time; });
    if (at != ends.begin()) before[i] = *(at - 1);
    if (at == ends.end()) {
      ends.push_back(i);
    } else {
      *at = i;
    }
  }
  std::vector<std::size_t> run;
  for (std::size_t i = ends.empty() ? kNoIndex : ends.back(); i != kNoIndex; i = before[i]) {
    run.push_back(i);
  }
  std::reverse(run.begin(), run.end());
  return run;
}

// Drops the fixes whose times break the order of the others.
// @throws InputError if these are at least half of the fixes
void KeepAscending(std::vector<StormFix>& fixes, LeftOut& left_out, ParseContext& place) {
  const std::vector<std::size_t> run = LongestAscending(fixes);
  if (run.size() == fixes.size()) return;
  const auto broken =
      std::adjacent_find(fixes.begin(), fixes.end(),
                         [](const StormFix& a, const StormFix& b) { return b.time <= a.time; });
  const std::string order =
      ", expected a time after that of the point before, " + FormatTime(broken->time);
  const auto at_line = [&place](std::int32_t line) {
    if (line > 0) place.line = line;  // points in JSON have no line; the storm's line remains
  };
  if (run.size() * 2 <= fixes.size()) {
    at_line((broken + 1)->line);
    place.Fail("time: got " + FormatTime((broken + 1)->time) + order);
  }
  std::vector<StormFix> kept;
  std::size_t next = 0;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (next < run.size() && run[next] == i) {
      kept.push_back(std::move(fixes[i]));
      ++next;
      continue;
    }
    ++left_out.count;
    at_line(fixes[i].line);
    place.WarnOnce("order", "time: got " + FormatTime(fixes[i].time) +
                                ", expected a time in the order of the other points" +
                                "; the point is left out");
  }
  fixes = std::move(kept);
}

// Warns about speeds above 150 km/h. Allows for the rounding of both positions to a tenth of a
// degree, which changes their distance by up to 16 km.
void WarnOfJumps(const std::vector<StormFix>& fixes, const std::string& storm,
                 ParseContext& place) {
  constexpr double kMax_kmh = 150.0;
  constexpr double kRounding_km = 16.0;
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    const GeoPoint& from = fixes[i - 1].position;
    const GeoPoint& to = fixes[i].position;
    double distance_m = 0.0;
    GeographicLib::Geodesic::WGS84().Inverse(from.latitude, from.longitude, to.latitude,
                                             to.longitude, distance_m);
    const double hours = static_cast<double>(fixes[i].time - fixes[i - 1].time) / 3600.0;
    if (distance_m / 1000.0 - kRounding_km <= kMax_kmh * hours) continue;
    if (fixes[i].line > 0) place.line = fixes[i].line;
    place.WarnOnce("jump of " + storm,
                   "points: got " + std::to_string(std::lround(distance_m / 1000.0 / hours)) +
                       " km/h from " + FormatTime(fixes[i - 1].time) + " to " +
                       FormatTime(fixes[i].time) +
                       ", expected at most 150; check the positions of both times");
  }
}

// Drops fixes that are more than 30 days from the others, if they are fewer than half. A wrong
// month or year causes such a gap.
void KeepTogether(std::vector<StormFix>& fixes, LeftOut& left_out, ParseContext& place) {
  constexpr std::int64_t kLongestGap_s = 30 * 86400;
  std::size_t best = 0;
  std::size_t best_end = 0;
  for (std::size_t from = 0, i = 1; i <= fixes.size(); ++i) {
    if (i < fixes.size() && fixes[i].time - fixes[i - 1].time <= kLongestGap_s) continue;
    if (i - from > best_end - best) {
      best = from;
      best_end = i;
    }
    from = i;
  }
  if (best_end - best == fixes.size() || (best_end - best) * 2 <= fixes.size()) return;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (i >= best && i < best_end) continue;
    ++left_out.count;
    if (fixes[i].line > 0) place.line = fixes[i].line;
    place.WarnOnce("apart", "time: got " + FormatTime(fixes[i].time) +
                                ", expected at most 30 days from the other points; the point is "
                                "left out");
  }
  fixes = {fixes.begin() + static_cast<std::ptrdiff_t>(best),
           fixes.begin() + static_cast<std::ptrdiff_t>(best_end)};
}

}  // namespace

void FinishTrack(StormTrack& track, LeftOut left_out, ParseContext& place) {
  if (track.fixes.size() < left_out.count) throw InputError(left_out.first);
  if (track.fixes.empty()) place.Fail("points: got none, expected at least one");
  const std::int32_t line = place.line;  // restored at the end, for the reader
  KeepAscending(track.fixes, left_out, place);
  KeepTogether(track.fixes, left_out, place);
  constexpr std::int64_t kDay_s = 86400;
  const std::int64_t days = (track.fixes.back().time - track.fixes.front().time) / kDay_s;
  if (days > 366) {
    place.Fail("points: got " + std::to_string(days) + " days of one storm, expected at most 366");
  }
  WarnOfJumps(track.fixes, track.id, place);
  ComputeMotion(track.fixes);
  const auto unusable = [&place](StormForecast& forecast) {
    try {
      LeftOut unused;
      KeepAscending(forecast.fixes, unused, place);
      return forecast.fixes.back().time <= forecast.issued;
    } catch (const InputError&) {
      place.WarnOnce("forecast",
                     "forecast of " + FormatTime(forecast.issued) +
                         ": its points are not in order of time; the forecast is left out");
      return true;
    }
  };
  track.forecasts.erase(std::remove_if(track.forecasts.begin(), track.forecasts.end(), unusable),
                        track.forecasts.end());
  for (StormForecast& forecast : track.forecasts) {
    WarnOfJumps(forecast.fixes, track.id, place);
    ComputeMotion(forecast.fixes);
  }
  place.line = line;
}

}  // namespace aquafarm::internal
