// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/forecast.h"

#include <algorithm>

#include "aquafarm/check.h"

namespace aquafarm {
namespace {

const std::vector<Waypoint>& TrackOf(const Farm& farm, std::int32_t disaster) {
  return *farm.tracks()[static_cast<std::size_t>(disaster)];
}

// One issued forecast: the truth where it is past, displaced where it is to come.
class Forecast {
 public:
  Forecast(const Farm& farm, std::int32_t disaster, std::int32_t issued)
      : scenario_(farm.scenario()),
        track_(TrackOf(farm, disaster)),
        issued_(static_cast<float>(issued)),
        error_(ForecastErrorVector(farm.seed(), farm.episode(), disaster)) {}

  /// The first waypoint after a step, or the end.
  std::vector<Waypoint>::const_iterator After(float step) const {
    return std::upper_bound(track_.begin(), track_.end(), step,
                            [](float at, const Waypoint& point) { return at < point.step; });
  }
  std::array<float, 2> Displaced(const Waypoint& point) const {
    const float error = MeanForecastError(scenario_, std::max(point.step - issued_, 0.0F));
    return {point.x + error * error_[0], point.y + error * error_[1]};
  }
  std::array<float, 2> Truth() const {
    const auto next = After(issued_);
    if (next == track_.begin()) return {next->x, next->y};
    const Waypoint& from = *(next - 1);
    if (next == track_.end()) return {from.x, from.y};
    const float part = (issued_ - from.step) / (next->step - from.step);
    return {from.x + (next->x - from.x) * part, from.y + (next->y - from.y) * part};
  }
  std::array<float, 2> At(float step) const {
    const auto next = After(step);
    const bool known_start = next == track_.begin() || (next - 1)->step <= issued_;
    const std::array<float, 2> from = known_start ? Truth() : Displaced(*(next - 1));
    if (next == track_.end()) return from;
    const std::array<float, 2> to = Displaced(*next);
    const float start = known_start ? issued_ : (next - 1)->step;
    const float part = (step - start) / (next->step - start);
    return {from[0] + (to[0] - from[0]) * part, from[1] + (to[1] - from[1]) * part};
  }

 private:
  const Scenario& scenario_;
  const std::vector<Waypoint>& track_;
  float issued_;
  std::array<float, 2> error_;
};

// The sum of four draws of [0, 1), less its mean: near to normal, and the same bits everywhere.
float NearlyNormal(const std::array<std::uint32_t, 4>& draws) {
  return ToUnit(draws[0]) + ToUnit(draws[1]) + ToUnit(draws[2]) + ToUnit(draws[3]) - 2.0F;
}

}  // namespace

float MeanForecastError(const Scenario& scenario, float lead) {
  const std::vector<float>& error_km = scenario.view.forecast_error_km;
  AQUAFARM_CHECK_EQ(error_km.size(), 3U);
  const double days = static_cast<double>(lead) * scenario.step_duration_s / 86400.0;
  const std::size_t leg = days < 1.0 ? 0 : days < 2.0 ? 1 : 2;
  const double from = leg == 0 ? 0.0 : static_cast<double>(error_km[leg - 1]);
  const double km =
      from + (static_cast<double>(error_km[leg]) - from) * (days - static_cast<double>(leg));
  return static_cast<float>(km * 1000.0 / scenario.cell_size_m);
}

std::array<float, 2> ForecastErrorVector(std::uint64_t seed, std::uint64_t episode,
                                         std::int32_t disaster) {
  // 1 / mean length of two such sums; measured by a test.
  constexpr float kScale = 1.3697F;
  const StreamKey key{seed, episode, Purpose::kForecast, static_cast<std::uint32_t>(disaster)};
  return {kScale * NearlyNormal(Draw(key, 0)), kScale * NearlyNormal(Draw(key, 1))};
}

bool HasForecast(const Farm& farm, std::int32_t disaster) {
  return !farm.scenario().view.forecast_error_km.empty() && !TrackOf(farm, disaster).empty();
}

std::array<float, 2> ForecastAt(const Farm& farm, std::int32_t disaster, std::int32_t issued,
                                std::int32_t step) {
  return Forecast(farm, disaster, issued).At(static_cast<float>(step));
}

std::vector<Waypoint> ForecastTrack(const Farm& farm, std::int32_t disaster, std::int32_t issued) {
  const Forecast forecast(farm, disaster, issued);
  const std::vector<Waypoint>& truth = TrackOf(farm, disaster);
  const Disaster now = [&] {
    Disaster there = farm.disasters()[static_cast<std::size_t>(disaster)];
    there.waypoint = 0;
    FollowTrack(there, truth, issued);
    return there;
  }();
  const auto rings = static_cast<std::size_t>(now.rings);
  Waypoint first{static_cast<float>(issued), now.x, now.y, now.grade, {}, {}, {}};
  for (std::size_t k = 0; k < rings; ++k) {
    first.radii.push_back(now.radius[k]);
    first.risks.push_back(now.risk[k]);
    if (!now.by_quadrant) continue;
    first.quadrants.push_back(
        {now.quadrant[0][k], now.quadrant[1][k], now.quadrant[2][k], now.quadrant[3][k]});
  }
  std::vector<Waypoint> track{std::move(first)};
  for (auto point = forecast.After(static_cast<float>(issued)); point != truth.end(); ++point) {
    track.push_back(*point);
    const std::array<float, 2> place = forecast.Displaced(*point);
    track.back().x = place[0];
    track.back().y = place[1];
  }
  return track;
}

}  // namespace aquafarm
