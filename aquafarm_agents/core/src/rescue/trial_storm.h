// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Simulated storms with the bulletins that announce them, to compare a plan with what happens.
///
///   recorded track ── moved, with radii ──> the true storm
///   true storm ── + published errors by lead time ──> the bulletin, with points 12 to 24 h apart
///
/// The draws and the code of the errors are others than those of the ensemble (storm_member.h).

#include <cstdint>
#include <vector>

#include "aquafarm/agents/rescue/forecast_errors.h"
#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/tracks/track.h"

namespace aquafarm::agents {

/// What a trial draws; the defaults are those of docs/plan.md.
struct TrialOptions {
  std::uint64_t seed{1};
  ForecastErrors errors;   ///< of the bulletins
  double moved_km{600.0};  ///< a track is moved by up to this far north or south, east or west
  double min_lead_h{4.0};  ///< of the closest approach of the track before it is moved
  double max_lead_h{24.0};
  double report_share{0.5};  ///< share of the bulletins that report radii
  /// Radii are drawn about EstimateRadius with its spread times errors.scale; else they are exact.
  bool draws_size{true};
  double bulletin_h{6.0};  ///< time between two bulletins
  /// True winds after the start are those of the bulletin with an error that does not depend on
  /// them. Else they are the track's, and the bulletin's are these with an error: then a bulletin
  /// of weak winds is more often too low than too high, because the tracks of the archive have
  /// gales near the ranch.
  bool winds_about_bulletin{};
};

/// Returns the time between two bulletins [s].
std::int64_t BulletinPeriod(const TrialOptions& options);

/// A true storm, and what is known of it at a time.
struct TrialStorm {
  StormTrack truth;
  StormTrack known;  ///< recorded until `start`, with one forecast that is issued then
  std::int64_t start{};
  std::size_t track{};  ///< index of the recorded track; storms of one track resemble each other
  /// Bulletins that follow, TrialOptions::bulletin_h apart, until the storm ends. Their errors are
  /// drawn again; they report radii if `known` does.
  std::vector<StormTrack> later;
  double lead_h{};      ///< from start to the closest approach of `truth`
  double nearest_km{};  ///< of `truth`
  /// Of the plan's ensemble. With one seed for all trials, all of them would share the sampling
  /// error of the same members, which would look like a bias of the chances.
  std::uint64_t seed{};
};

/// Draws trial `index`: a pure function of tracks, place, options and index.
/// @param tracks with at least three fixes each @param place middle of the ranch
TrialStorm DrawTrial(const std::vector<StormTrack>& tracks, GeoPoint place,
                     const TrialOptions& options, std::uint64_t index);

/// Returns the trial of a recorded storm that is not moved, about `lead_h` before its closest
/// approach; at its first fix if that is later. @param index of the drawn bulletin
TrialStorm RecordedTrial(const StormTrack& track, GeoPoint place, const TrialOptions& options,
                         double lead_h, std::uint64_t index);

/// Returns the time and the distance [km] of a track's closest approach, in steps of 10 minutes.
std::pair<std::int64_t, double> NearestTime(const StormTrack& track, GeoPoint place);

}  // namespace aquafarm::agents
