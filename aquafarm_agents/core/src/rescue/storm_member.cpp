// SPDX-License-Identifier: BSD-3-Clause
#include "rescue/storm_member.h"

#include <algorithm>
#include <cmath>

#include "aquafarm/base/angle.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/rng.h"
#include "aquafarm/tracks/track.h"
#include "aquafarm/tracks/wind_radii.h"

namespace aquafarm::agents {
namespace {

/// Draws the standard normal numbers of one member (Box and Muller 1958).
class Normals {
 public:
  Normals(std::uint64_t seed, std::int32_t member)
      : rng_({seed, static_cast<std::uint64_t>(member), RngStream::kForecast, 1}) {}
  double Next() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - static_cast<double>(rng_.Unit())));
    return radius * std::cos(2.0 * kPi * static_cast<double>(rng_.Unit()));
  }

 private:
  RandomStream rng_;
};

}  // namespace

MemberSampler::MemberSampler(const CentralForecast& forecast, const EnsembleOptions& options)
    : forecast_(forecast), options_(options), errors_(forecast.path.points.size()) {
  AQUAFARM_CHECK_EQ(forecast.lead_h.size(), errors_.size());
  for (const double lead : forecast.lead_h) spread_.push_back(SpreadAt(options.errors, lead));
  const std::int32_t widest_kt = forecast.path.wind_kt[forecast.path.rings - 1];
  double reported = 0.0;  // SizeSigma at the last report of radii; without one, at the first point
  for (std::size_t i = 0; i < forecast.lead_h.size(); ++i) {
    const StormPoint& point = forecast.path.points[i];
    size_sigma_.push_back(
        SizeSigma(widest_kt, point.wind_mps, point.latitude, point.averaging_min));
    if (i == 0 || forecast.lead_h[i] <= forecast.size_report_h) reported = size_sigma_.back();
  }
  for (const double lead : forecast.lead_h) {
    size_spread_.push_back(options.errors.scale / reported *
                           SizeSpreadAt(options.errors, reported, lead - forecast.size_report_h));
  }
}

// Draws the errors of a member. They are correlated along its track: in units of the standard
// deviation, each error is a fraction of the previous one plus a new random part.
void MemberSampler::DrawErrors(std::int32_t member) {
  Normals normals(options_.seed, member);
  double size = size_spread_[0] * normals.Next();
  std::array<double, 3> unit{normals.Next(), normals.Next(), normals.Next()};
  const std::vector<double>& leads = forecast_.lead_h;
  const auto square = [](double value) { return value * value; };
  for (std::size_t i = 0; i < errors_.size(); ++i) {
    const double lead = std::max(0.0, leads[i]);
    const double before = i > 0 ? std::max(0.0, leads[i - 1]) : lead;
    const double kept = std::exp(-(lead - before) / options_.errors.correlation_h);
    for (double& one : unit) {
      const double fresh = kept < 1.0 ? normals.Next() : 0.0;
      one = kept * one + std::sqrt(1.0 - kept * kept) * fresh;
    }
    errors_[i].along_km = unit[0] * spread_[i].position_km;
    errors_[i].across_km = unit[1] * spread_[i].position_km;
    errors_[i].wind_add_mps = unit[2] * spread_[i].wind_mps;
    if (i > 0) {
      const double remains = std::exp(-(lead - before) / options_.errors.size_memory_h);
      const double kept_spread = remains * size_spread_[i - 1];
      const double fresh = square(size_spread_[i]) - square(kept_spread);
      size = remains * size + std::sqrt(std::max(0.0, fresh)) * normals.Next();
    }
    errors_[i].size_factor = std::exp(size * size_sigma_[i]);
  }
}

void MemberSampler::Draw(std::int32_t member, std::vector<StormState>& states) {
  DrawErrors(member);
  placer_.Place(forecast_.path, errors_, forecast_.risks, waypoints_);
  states.resize(waypoints_.size());
  for (std::size_t i = 0; i < waypoints_.size(); ++i) {
    const Waypoint& from = waypoints_[i];
    StormState& state = states[i];
    state.x = from.x;
    state.y = from.y;
    for (std::size_t ring = 0; ring < from.radii.size(); ++ring) {
      state.risk[ring] = from.risks[ring];
      if (from.quadrants.empty()) {
        state.radius[ring].fill(from.radii[ring]);
      } else {
        state.radius[ring] = from.quadrants[ring];
      }
    }
  }
}

StormState Between(const StormState& from, const StormState& to, float part, std::size_t rings) {
  const auto mix = [part](float a, float b) { return a + (b - a) * part; };
  StormState state;
  state.x = mix(from.x, to.x);
  state.y = mix(from.y, to.y);
  for (std::size_t ring = 0; ring < rings; ++ring) {
    state.risk[ring] = mix(from.risk[ring], to.risk[ring]);
    for (std::size_t q = 0; q < 4; ++q) {
      state.radius[ring][q] = mix(from.radius[ring][q], to.radius[ring][q]);
    }
  }
  return state;
}

}  // namespace aquafarm::agents
