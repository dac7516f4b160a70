// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "aquafarm/agents/base/text.h"
#include "aquafarm/base/check.h"
#include "aquafarm/storms/to_disaster.h"
#include "aquafarm/tracks/fine_rings.h"
#include "aquafarm/tracks/reader.h"
#include "base/constants.h"
#include "rescue/case_parts.h"

namespace aquafarm::agents {
namespace {

std::string NameOf(const StormTrack& track) { return track.name.empty() ? track.id : track.name; }

StormTrack TrackOf(const RescueRequest& request, const std::string& path, RescueCase& rescue) {
  const StormFile file = LoadStormFile(path);
  for (const std::string& warning : file.warnings) {
    rescue.warnings.push_back({"file_repaired", "note", warning, ""});
  }
  if (request.storm_name.empty()) {
    if (file.tracks.size() == 1) return file.tracks[0];
    std::vector<std::string> names;
    constexpr std::size_t kMaxNamed = 60;
    for (const StormTrack& track : file.tracks) {
      if (names.size() < kMaxNamed) {
        names.push_back(track.id + (track.name.empty() ? "" : " " + track.name));
      }
    }
    const std::size_t more = file.tracks.size() - names.size();
    if (more > 0) names.push_back(std::to_string(more) + " more");
    throw InputError(path + ": got " + std::to_string(file.tracks.size()) +
                     " storms, expected --storm-name with one of: " + Join(names));
  }
  try {
    return FindTrack(file, request.storm_name);
  } catch (const InputError& error) {
    throw InputError("--storm-name: " + path + ": " + error.what());
  }
}

// Returns the agency of the positions. If the file does not state it, returns that of the
// forecasts.
std::string AgencyOf(const StormTrack& track) {
  if (track.agency != "bulletin" && track.agency != "weather service") return track.agency;
  for (const StormForecast& forecast : track.forecasts) {
    if (!forecast.agency.empty()) return forecast.agency;
  }
  return track.agency;
}

// Removes the fixes after the start of the plan and the forecasts issued after it. Throws
// InputError if no fix is left.
StormTrack KnownAt(StormTrack track, std::int64_t start, const std::string& path) {
  auto& fixes = track.fixes;
  if (fixes.empty() || fixes.front().time > start) {
    throw InputError(path + ": got " + NameOf(track) + " from " +
                     (fixes.empty() ? "no time" : FormatUtc(fixes.front().time)) +
                     " on, expected a storm whose first report is not after " + FormatUtc(start) +
                     "; give a later --at");
  }
  fixes.erase(std::remove_if(fixes.begin(), fixes.end(),
                             [start](const StormFix& fix) { return fix.time > start; }),
              fixes.end());
  auto& forecasts = track.forecasts;
  forecasts.erase(std::remove_if(forecasts.begin(), forecasts.end(),
                                 [start](const StormForecast& one) { return one.issued > start; }),
                  forecasts.end());
  return track;
}

StormTrack FromBulletin(const RescueRequest& request, RescueCase& rescue) {
  StormTrack track = TrackOf(request, request.bulletin, rescue);
  AQUAFARM_CHECK_LT(std::size_t{0}, track.fixes.size());
  const std::int64_t last = track.fixes.back().time;
  const bool is_current = request.now && *request.now >= last &&
                          *request.now - last < static_cast<std::int64_t>(kOldBulletin_h) * kHour_s;
  rescue.start = request.at.value_or(is_current ? *request.now : last);
  const std::string agency = AgencyOf(track);
  track = KnownAt(std::move(track), rescue.start, request.bulletin);
  const StormTrack whole = WithForecast(track, NoForecast::kPersist);
  const StormKnowledge knowledge = KnowledgeOf(track, whole);
  StormRecord& storm = rescue.storm;
  storm.recorded_until = knowledge.recorded_until;
  storm.agency = knowledge.agency.empty() ? agency : knowledge.agency;
  storm.is_persistence = knowledge.issued == 0;
  storm.issued = storm.is_persistence ? knowledge.recorded_until : knowledge.issued;
  storm.known_until = knowledge.known_until;
  const std::int64_t present = request.at || !request.now ? rescue.start : *request.now;
  storm.age_h = static_cast<double>(present - knowledge.recorded_until) / kHour_s;
  return whole;
}

StormTrack FromRecord(const RescueRequest& request, RescueCase& rescue) {
  if (!request.at) {
    throw InputError("at: got nothing, expected the time at which the plan begins, for --storm");
  }
  StormTrack track = TrackOf(request, request.storm, rescue);
  rescue.start = *request.at;
  if (track.fixes.front().time > rescue.start || track.fixes.back().time <= rescue.start) {
    throw InputError(request.storm + ": got " + NameOf(track) + " from " +
                     FormatUtc(track.fixes.front().time) + " to " +
                     FormatUtc(track.fixes.back().time) + ", expected a track that includes " +
                     FormatUtc(rescue.start) + "; give another --at");
  }
  StormRecord& storm = rescue.storm;
  storm.is_hindcast = true;
  storm.agency = AgencyOf(track);
  for (StormFix& fix : track.fixes) {
    if (fix.time <= rescue.start) storm.recorded_until = fix.time;
    fix.forecast = fix.time > rescue.start;
  }
  storm.issued = rescue.start;
  storm.known_until = track.fixes.back().time;
  return track;
}

void WarnOfStorm(RescueCase& rescue) {
  const StormRecord& storm = rescue.storm;
  auto& warnings = rescue.warnings;
  if (storm.is_hindcast) {
    warnings.push_back({"hindcast", "warning",
                        "The forecast is the storm as it was recorded later, with errors added.",
                        "Use this plan to study a past storm; for a decision give a bulletin."});
  }
  if (storm.is_persistence) {
    warnings.push_back({"no_forecast", "warning",
                        "The bulletin has no forecast: the storm is assumed to keep its motion, "
                        "wind and size for 24 hours after " +
                            FormatUtc(storm.recorded_until) + ".",
                        "Give a bulletin with forecast points."});
  }
  if (storm.age_h >= kOldBulletin_h) {
    const bool in_days = storm.age_h >= 72.0;
    warnings.push_back(
        {"bulletin_old", "stop",
         "The bulletin is " + Short(in_days ? storm.age_h / 24.0 : storm.age_h, 0) +
             (in_days ? " days" : " hours") + " old: its last report is of " +
             FormatUtc(storm.recorded_until) + ".",
         "Get a newer bulletin before any ship leaves. For a past storm give --storm and --at."});
  }
  if (storm.rings.silent > 0) {
    warnings.push_back({"radii_unknown", "warning",
                        "Neither wind nor radii are known at " +
                            std::to_string(storm.rings.silent) +
                            " points of the storm: it has no rings there.",
                        "Give a bulletin with winds or radii."});
  }
  if (storm.rings.estimated > 0) {
    warnings.push_back({"radii_estimated", "note",
                        "Radii are estimated from the wind at " +
                            std::to_string(storm.rings.estimated) + " points of the storm.",
                        ""});
  }
  if (storm.held > 0) {
    warnings.push_back(
        {"wind_unknown_between", "warning",
         "Stretches of the storm's track in which the wind cannot be interpolated: " +
             std::to_string(storm.held) + ". There the plan takes the larger radii of both ends.",
         "Give a bulletin with a wind at each point."});
  }
  if (storm.passage.over_at_end) {
    warnings.push_back({"known_until", "warning",
                        "The storm is still over the ranch at " + FormatUtc(*storm.known_until) +
                            ", the end of the forecast: what follows is unknown, not calm.",
                        "Plan again with the next bulletin."});
  }
}

}  // namespace

void ReadStorm(const RescueRequest& request, RescueCase& rescue) {
  const std::string& path = request.bulletin.empty() ? request.storm : request.bulletin;
  if (path.empty() || (!request.bulletin.empty() && !request.storm.empty())) {
    throw InputError("storm: got " + std::string(path.empty() ? "none" : "--bulletin and --storm") +
                     ", expected one of --bulletin FILE and --storm FILE --at TIME");
  }
  const StormTrack track =
      request.bulletin.empty() ? FromRecord(request, rescue) : FromBulletin(request, rescue);
  rescue.storm.file = path;
  UseStorm(track, request, rescue);
  WarnOfStorm(rescue);
}

void UseStorm(const StormTrack& track, const RescueRequest& request, RescueCase& rescue) {
  StormRecord& storm = rescue.storm;
  storm.name = NameOf(track);
  storm.rings = ToRings(track, RingReduction::kQuadrants);
  const double memory_h = request.errors.size_memory_h;
  const std::optional<std::int64_t> report = CarrySize(track, memory_h, storm.rings);
  rescue.forecast.size_report_h = report ? static_cast<double>(*report - *storm.issued) / kHour_s
                                         : -std::numeric_limits<double>::infinity();
  auto [fine, held] =
      ToFineRings(track, RingReduction::kQuadrants, rescue.start, storm.rings.wind_kt, memory_h);
  storm.held = held;
  if (*storm.known_until <= rescue.start) {
    throw InputError(storm.file + ": got a storm known until " + FormatUtc(*storm.known_until) +
                     ", expected one that is known after " + FormatUtc(rescue.start) +
                     ", the start of the plan; get a newer bulletin");
  }
  constexpr double kMaxHours = 96.0;
  constexpr double kMaxSteps = 600.0;
  constexpr double kMinStep_s = 120.0;
  const Scenario& scenario = *rescue.scenario;
  const double known_s =
      std::min(static_cast<double>(*storm.known_until - rescue.start), kMaxHours * kHour_s);
  EnsembleOptions& options = rescue.ensemble;
  options.width = scenario.width;
  options.height = scenario.height;
  options.cell_size_km = scenario.cell_size_m / 1000.0;
  options.step_s = std::max({kMinStep_s, std::ceil(known_s / kMaxSteps)});
  options.steps = static_cast<std::int32_t>(known_s / options.step_s) + 1;
  options.members = request.members;
  options.seed = request.seed;
  options.errors = request.errors;
  CentralForecast& forecast = rescue.forecast;
  forecast.path = ToPath(fine, rescue.frame, scenario.cell_size_m, options.step_s, rescue.start);
  forecast.lead_h.clear();
  for (const StormPoint& point : forecast.path.points) {
    const double time_s = point.step * options.step_s + static_cast<double>(rescue.start);
    forecast.lead_h.push_back((time_s - static_cast<double>(*storm.issued)) / kHour_s);
  }
  forecast.risks = DefaultGradeRisks();
  for (const DisasterSpec& disaster : scenario.disasters) {
    if (!disaster.grade_risks.empty()) forecast.risks = disaster.grade_risks;
  }
  auto& points = fine.waypoints;
  const std::optional<StormWaypoint> now = fine.At(rescue.start);
  points.erase(std::remove_if(points.begin(), points.end(),
                              [&](const StormWaypoint& at) { return at.time <= rescue.start; }),
               points.end());
  if (now) points.insert(points.begin(), *now);
  const double half_km =
      std::hypot(scenario.width, scenario.height) / 2.0 * scenario.cell_size_m / 1000.0;
  const GeoPoint middle =
      rescue.frame.ToGeo((scenario.width - 1) / 2.0, (scenario.height - 1) / 2.0);
  storm.passage = ClosestApproach(fine, middle, half_km);
}

}  // namespace aquafarm::agents
