// SPDX-License-Identifier: BSD-3-Clause
#include "rescue/trial_storm.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "aquafarm/base/angle.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/rng.h"
#include "aquafarm/tracks/fine_rings.h"
#include "aquafarm/tracks/wind_radii.h"
#include "base/constants.h"

namespace aquafarm::agents {
namespace {

constexpr double kKmPerDegree = 111.195;
constexpr std::array<std::int32_t, 8> kLeads_h{12, 24, 36, 48, 60, 72, 96, 120};
constexpr std::array<std::int32_t, 3> kWinds_kt{34, 50, 64};
constexpr double kWeakest_mps = 8.0;  // assumed wind of a fix if it is unknown or "below 10 m/s"

double HoursBetween(std::int64_t from, std::int64_t to) {
  return static_cast<double>(to - from) / static_cast<double>(kHour_s);
}

// Returns the great-circle distance [km].
double Distance(GeoPoint a, GeoPoint b) {
  const double lat_a = a.latitude * kRadiansPerDegree;
  const double lat_b = b.latitude * kRadiansPerDegree;
  const double half_lat = std::sin((lat_b - lat_a) / 2.0);
  const double half_lon = std::sin((b.longitude - a.longitude) * kRadiansPerDegree / 2.0);
  const double part = half_lat * half_lat + std::cos(lat_a) * std::cos(lat_b) * half_lon * half_lon;
  return 2.0 * kKmPerDegree / kRadiansPerDegree * std::asin(std::sqrt(std::min(1.0, part)));
}

void Move(GeoPoint& place, double east_km, double north_km) {
  place.latitude += north_km / kKmPerDegree;
  place.longitude += east_km / (kKmPerDegree * std::cos(place.latitude * kRadiansPerDegree));
}

// Returns a standard normal number by the polar method (Marsaglia and Bray 1964).
double Normal(RandomStream& rng) {
  for (;;) {
    const double u = 2.0 * static_cast<double>(rng.Unit()) - 1.0;
    const double v = 2.0 * static_cast<double>(rng.Unit()) - 1.0;
    const double s = u * u + v * v;
    if (s > 0.0 && s < 1.0) return u * std::sqrt(-2.0 * std::log(s) / s);
  }
}

double WindOf(const StormFix& fix) { return fix.wind_mps.value_or(kWeakest_mps); }

// Returns position and wind of a track at a time, linear between fixes.
StormFix At(const StormTrack& track, std::int64_t time) {
  std::size_t next = 0;
  while (next < track.fixes.size() && track.fixes[next].time <= time) ++next;
  if (next == 0) return track.fixes.front();
  if (next == track.fixes.size()) return track.fixes.back();
  const StormFix& from = track.fixes[next - 1];
  const StormFix& to = track.fixes[next];
  const double part =
      static_cast<double>(time - from.time) / static_cast<double>(to.time - from.time);
  StormFix fix = from;
  fix.time = time;
  fix.position.latitude += part * (to.position.latitude - from.position.latitude);
  fix.position.longitude += part * (to.position.longitude - from.position.longitude);
  fix.wind_mps = WindOf(from) + part * (WindOf(to) - WindOf(from));
  return fix;
}

// Draws the logarithm of a storm's size at each fix, in units of the spread of recorded radii. The
// logarithm is a stationary random process.
std::vector<double> DrawSizes(const TrialOptions& options, RandomStream& rng,
                              const StormTrack& track) {
  std::vector<double> sizes;
  double unit = Normal(rng);
  for (std::size_t i = 0; i < track.fixes.size(); ++i) {
    if (i > 0) {
      const double hours = HoursBetween(track.fixes[i - 1].time, track.fixes[i].time);
      const double kept = std::exp(-hours / options.errors.size_memory_h);
      unit = kept * unit + std::sqrt(1.0 - kept * kept) * Normal(rng);
    }
    sizes.push_back(unit);
  }
  return sizes;
}

// Sets the grade and the radii of each fix of a true storm by its wind and size.
void SetRadii(const TrialOptions& options, const std::vector<double>& sizes, StormTrack& track) {
  for (std::size_t i = 0; i < track.fixes.size(); ++i) {
    StormFix& fix = track.fixes[i];
    fix.grade = GradeOfWind(*fix.wind_mps);
    fix.rings.clear();
    const double spread =
        options.draws_size ? options.errors.scale * options.errors.size_factor : 0.0;
    for (const std::int32_t wind_kt : kWinds_kt) {
      const RadiusEstimate estimate =
          EstimateRadius(wind_kt, *fix.wind_mps, fix.position.latitude, fix.averaging_min);
      const RadiusEstimate widest =
          EstimateRadius(kWinds_kt[0], *fix.wind_mps, fix.position.latitude, fix.averaging_min);
      WindRing ring;
      ring.wind_kt = wind_kt;
      ring.radius_km.fill(estimate.median_km * std::exp(spread * widest.log_sigma * sizes[i]));
      fix.rings.push_back(ring);
    }
  }
}

// Errors of a bulletin. Errors at nearby lead times are correlated.
class BulletinErrors {
 public:
  BulletinErrors(const ForecastErrors& errors, RandomStream& rng)
      : errors_(errors), rng_(rng), unit_{Normal(rng), Normal(rng), Normal(rng)} {}

  // Advances to a later lead time.
  void GoTo(double lead_h) {
    const double kept = std::exp(-(lead_h - lead_h_) / errors_.correlation_h);
    for (double& one : unit_) {
      if (kept < 1.0) one = kept * one + std::sqrt(1.0 - kept * kept) * Normal(rng_);
    }
    lead_h_ = lead_h;
  }
  // Adds the errors of the bulletin to a true fix. The errors to the east and to the north are
  // independent and have equal standard deviations. The errors along and across the track then have
  // the same properties.
  void Apply(StormFix& fix) const {
    const ForecastSpread spread = SpreadAt(errors_, lead_h_);
    Move(fix.position, unit_[0] * spread.position_km, unit_[1] * spread.position_km);
    ApplyWind(fix);
  }
  void ApplyWind(StormFix& fix) const {
    const ForecastSpread spread = SpreadAt(errors_, lead_h_);
    fix.wind_mps = std::max(0.0, WindOf(fix) + unit_[2] * spread.wind_mps);
    fix.grade = GradeOfWind(*fix.wind_mps);
  }

 private:
  const ForecastErrors& errors_;
  RandomStream& rng_;
  std::array<double, 3> unit_;
  double lead_h_{};
};

// Makes the bulletin of a true storm.
StormTrack KnownOf(const StormTrack& truth, std::int64_t start, const TrialOptions& options,
                   RandomStream& rng) {
  StormTrack known = truth;
  known.fixes.clear();
  BulletinErrors errors(options.errors, rng);
  const bool is_reported = static_cast<double>(rng.Unit()) < options.report_share;
  const double report =
      std::exp(options.errors.scale * options.errors.size_report_error * Normal(rng));
  for (StormFix fix : truth.fixes) {
    if (fix.time > start) break;
    errors.Apply(fix);
    for (WindRing& ring : fix.rings) {
      for (double& radius_km : ring.radius_km) radius_km *= report;
    }
    if (!is_reported) fix.rings.clear();
    known.fixes.push_back(std::move(fix));
  }
  StormForecast forecast;
  forecast.agency = "simulated";
  forecast.issued = start;
  for (const std::int32_t lead_h : kLeads_h) {
    const std::int64_t time = start + lead_h * kHour_s;
    if (time > truth.fixes.back().time) break;
    StormFix fix = At(truth, time);
    errors.GoTo(lead_h);
    errors.Apply(fix);
    fix.rings.clear();
    fix.forecast = true;
    forecast.fixes.push_back(std::move(fix));
  }
  if (!forecast.fixes.empty()) known.forecasts.push_back(std::move(forecast));
  return known;
}

// Sets the true winds after the start of the trial, until the end of the bulletin: the winds of the
// bulletin plus drawn errors.
void DrawWinds(const StormTrack& known, const TrialOptions& options, RandomStream rng,
               StormTrack& truth) {
  StormTrack bulletin;
  bulletin.fixes = {known.fixes.back()};
  for (const StormForecast& forecast : known.forecasts) {
    bulletin.fixes.insert(bulletin.fixes.end(), forecast.fixes.begin(), forecast.fixes.end());
  }
  BulletinErrors errors(options.errors, rng);
  for (StormFix& fix : truth.fixes) {
    if (fix.time <= bulletin.fixes.front().time) continue;
    if (fix.time > bulletin.fixes.back().time) break;
    fix.wind_mps = At(bulletin, fix.time).wind_mps;
    errors.GoTo(HoursBetween(bulletin.fixes.front().time, fix.time));
    errors.ApplyWind(fix);
  }
}

TrialStorm MakeTrial(StormTrack truth, std::int64_t at, const TrialOptions& options, GeoPoint place,
                     RandomStream& rng) {
  TrialStorm trial;
  // Starts with the last fix that is not after `at`, but never with one of the last two fixes.
  trial.start = truth.fixes.front().time;
  for (std::size_t i = 0; i + 2 < truth.fixes.size(); ++i) {
    if (truth.fixes[i].time <= at) trial.start = truth.fixes[i].time;
  }
  for (StormFix& fix : truth.fixes) {
    fix.wind_mps = WindOf(fix);
    fix.wind_below_mps.reset();
  }
  truth = FineTrack(truth, truth.fixes.front().time);
  const std::vector<double> sizes = DrawSizes(options, rng, truth);
  SetRadii(options, sizes, truth);
  trial.known = KnownOf(truth, trial.start, options, rng);
  const auto [nearest, km] = NearestTime(truth, place);
  trial.lead_h = HoursBetween(trial.start, nearest);
  trial.nearest_km = km;
  trial.seed = std::uint64_t{rng.Below(1U << 31)} << 31 | rng.Below(1U << 31);
  if (options.winds_about_bulletin) {
    DrawWinds(trial.known, options, RandomStream({options.seed, trial.seed, RngStream::kStorm, 9}),
              truth);
    SetRadii(options, sizes, truth);
  }
  TrialOptions again = options;
  again.report_share = trial.known.fixes.back().rings.empty() ? 0.0 : 1.0;
  for (std::int64_t time = trial.start + BulletinPeriod(options); time < truth.fixes.back().time;
       time += BulletinPeriod(options)) {
    trial.later.push_back(KnownOf(truth, time, again, rng));
  }
  trial.truth = std::move(truth);
  return trial;
}

}  // namespace

std::int64_t BulletinPeriod(const TrialOptions& options) {
  return std::max(std::int64_t{1}, static_cast<std::int64_t>(options.bulletin_h * double{kHour_s}));
}

std::pair<std::int64_t, double> NearestTime(const StormTrack& track, GeoPoint place) {
  std::pair<std::int64_t, double> nearest{track.fixes.front().time, 1e9};
  for (std::int64_t time = track.fixes.front().time; time <= track.fixes.back().time; time += 600) {
    const double km = Distance(At(track, time).position, place);
    if (km < nearest.second) nearest = {time, km};
  }
  return nearest;
}

TrialStorm DrawTrial(const std::vector<StormTrack>& tracks, GeoPoint place,
                     const TrialOptions& options, std::uint64_t index) {
  AQUAFARM_CHECK_LT(std::size_t{0}, tracks.size());
  RandomStream rng({options.seed, index, RngStream::kStorm, 7});
  const std::size_t index_of_track = rng.Below(static_cast<std::uint32_t>(tracks.size()));
  StormTrack truth = tracks[index_of_track];
  const auto [nearest, km] = NearestTime(truth, place);
  const auto uniform = [&rng](double low, double high) {
    return low + (high - low) * static_cast<double>(rng.Unit());
  };
  const double lead_h = uniform(options.min_lead_h, options.max_lead_h);
  const double east_km = uniform(-options.moved_km, options.moved_km);
  const double north_km = uniform(-options.moved_km, options.moved_km);
  for (StormFix& fix : truth.fixes) Move(fix.position, east_km, north_km);
  const auto at = nearest - static_cast<std::int64_t>(lead_h * static_cast<double>(kHour_s));
  TrialStorm trial = MakeTrial(std::move(truth), at, options, place, rng);
  trial.track = index_of_track;
  return trial;
}

TrialStorm RecordedTrial(const StormTrack& track, GeoPoint place, const TrialOptions& options,
                         double lead_h, std::uint64_t index) {
  RandomStream rng({options.seed, index, RngStream::kStorm, 8});
  const auto [nearest, km] = NearestTime(track, place);
  const auto at = nearest - static_cast<std::int64_t>(lead_h * static_cast<double>(kHour_s));
  return MakeTrial(track, at, options, place, rng);
}

}  // namespace aquafarm::agents
