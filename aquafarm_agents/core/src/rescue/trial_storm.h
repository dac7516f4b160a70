// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Simulated storms, and the bulletins that forecast them. A trial compares a plan with its outcome
/// in the true storm.
///
///   recorded track ── moved, with radii ──> the true storm
///   true storm ── + published errors by lead time ──> the bulletin, with points 12 to 24 h apart
///
/// Trials and the ensemble use the same spreads (forecast_errors.h). Trials draw their errors with
/// code and random numbers that the ensemble (storm_member.h) does not use.

#include <cstdint>
#include <vector>

#include "aquafarm/agents/rescue/forecast_errors.h"
#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/tracks/track.h"

namespace aquafarm::agents {

/// Options of the trials.
struct TrialOptions {
  std::uint64_t seed{1};
  ForecastErrors errors;  ///< errors of the bulletins
  /// A track is moved by up to this distance to the north or south, and to the east or west.
  double moved_km{600.0};
  /// A time is drawn that is between min_lead_h and max_lead_h before the closest approach of the
  /// unmoved track [h]. The trial starts with the last fix that is not after this time, but never
  /// with one of the last two fixes.
  double min_lead_h{4.0};
  double max_lead_h{24.0};
  double report_share{0.5};  ///< probability that the bulletins of a trial report radii
  /// true: the true radii are those of EstimateRadius multiplied by a random factor. The standard
  /// deviation of its logarithm is the product of RadiusEstimate::log_sigma (at 34 kt),
  /// errors.scale and errors.size_factor. false: the true radii are those of EstimateRadius.
  bool draws_size{true};
  double bulletin_h{6.0};  ///< time between two bulletins [h]
  /// false: the true winds are those of the recorded track, and the winds of the bulletin differ
  /// from them by errors. A bulletin of weak winds is then more often too low than too high,
  /// because the tracks of the archive have gales near the ranch. true: from the start of the trial
  /// to the end of the first bulletin, the true winds are those of this bulletin plus independent
  /// errors.
  bool winds_about_bulletin{};
};

/// Returns the time between two bulletins [s].
std::int64_t BulletinPeriod(const TrialOptions& options);

/// A true storm and its bulletins.
struct TrialStorm {
  StormTrack truth;
  StormTrack known;  ///< first bulletin: reports until `start`, and a forecast issued at `start`
  std::int64_t start{};  ///< start of the trial, UTC [s since 1970]
  std::size_t track{};   ///< index of the recorded track; storms of the same track are similar
  /// Later bulletins, TrialOptions::bulletin_h apart, until the storm ends. Each has its own
  /// errors. They report radii if `known` does.
  std::vector<StormTrack> later;
  double lead_h{};      ///< time from `start` to the closest approach of `truth` [h]
  double nearest_km{};  ///< distance of the closest approach of `truth` [km]
  /// Seed of the plan's ensemble. If all trials had the same seed, the sampling error of the same
  /// members would occur in all of them and look like a bias of the chances.
  std::uint64_t seed{};
};

/// Draws trial `index`. The result depends only on the arguments.
/// @param tracks at least one, each with at least three fixes
/// @param place middle of the ranch
TrialStorm DrawTrial(const std::vector<StormTrack>& tracks, GeoPoint place,
                     const TrialOptions& options, std::uint64_t index);

/// Returns a trial of a recorded storm that is not moved. It starts with the last fix that is at
/// least `lead_h` before the closest approach, or with the first fix if there is no such fix. The
/// last two fixes are never the start.
/// @param index selects the random errors of the bulletins
TrialStorm RecordedTrial(const StormTrack& track, GeoPoint place, const TrialOptions& options,
                         double lead_h, std::uint64_t index);

/// Returns time (UTC [s since 1970]) and distance [km] of a track's closest approach to a place.
/// The time has a resolution of 10 minutes.
std::pair<std::int64_t, double> NearestTime(const StormTrack& track, GeoPoint place);

}  // namespace aquafarm::agents
