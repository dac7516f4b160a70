// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/forecast.h"

#include <algorithm>

#include "aquafarm/base/check.h"

namespace aquafarm {
namespace {

const std::vector<Waypoint>& TrackOf(const Farm& farm, std::int32_t disaster) {
  return *farm.tracks()[static_cast<std::size_t>(disaster)];
}

// Returns the newest issued forecast of a disaster that still follows the scenario's track; nullptr
// if there is none or if it has expired.
const IssuedForecast* NewestSaid(const Farm& farm, std::int32_t disaster, std::int32_t issued) {
  const std::vector<DisasterSpec>& specs = farm.scenario().disasters;
  const auto id = static_cast<std::size_t>(disaster);
  if (id >= specs.size() || farm.tracks()[id].get() != &specs[id].track) return nullptr;
  const auto step = static_cast<float>(issued);
  const std::vector<IssuedForecast>& said = specs[id].forecasts;
  const auto next =
      std::upper_bound(said.begin(), said.end(), step,
                       [](float at, const IssuedForecast& forecast) { return at < forecast.step; });
  if (next == said.begin() || (next - 1)->points.back().step <= step) return nullptr;
  return &*(next - 1);
}

// Returns the index of the first point after a step, or the number of points.
template <typename Points>
std::size_t After(float step, const Points& points) {
  const auto next = std::upper_bound(points.begin(), points.end(), step,
                                     [](float at, const auto& point) { return at < point.step; });
  return static_cast<std::size_t>(next - points.begin());
}

// Returns the true state at a step. Before the first waypoint the disaster is at the first one,
// after the last waypoint at the last one.
Waypoint TruthAt(const std::vector<Waypoint>& track, float step) {
  const std::size_t next = After(step, track);
  Waypoint now = track[next == 0 ? 0 : next - 1];
  if (next > 0 && next < track.size()) {
    const Waypoint& to = track[next];
    const float part = (step - now.step) / (to.step - now.step);
    const auto move = [part](float& from, float end) { from += (end - from) * part; };
    move(now.x, to.x);
    move(now.y, to.y);
    for (std::size_t k = 0; k < now.radii.size(); ++k) {
      move(now.risks[k], to.risks[k]);
      move(now.radii[k], to.radii[k]);
      if (now.quadrants.empty()) continue;
      for (std::size_t q = 0; q < 4; ++q) move(now.quadrants[k][q], to.quadrants[k][q]);
      now.radii[k] = *std::max_element(now.quadrants[k].begin(), now.quadrants[k].end());
    }
  }
  now.step = step;
  return now;
}

// One forecast. Until the step of issue it equals the true track. After it, it is the issued
// forecast or, without one, the displaced true track.
class Forecast {
 public:
  Forecast(const Farm& farm, std::int32_t disaster, std::int32_t issued)
      : scenario_(farm.scenario()),
        track_(TrackOf(farm, disaster)),
        said_(NewestSaid(farm, disaster, issued)),
        issued_(static_cast<float>(issued)),
        first_(IndexAfter(issued_)) {
    if (said_ == nullptr) error_ = ForecastErrorVector(farm.seed(), farm.episode(), disaster);
  }

  /// Returns the steps from its issue on at which the forecast or the true track changes direction.
  std::vector<float> Steps() const {
    std::vector<float> steps{issued_};
    for (std::size_t i = After(issued_, track_); i < track_.size(); ++i) {
      steps.push_back(track_[i].step);
    }
    for (std::size_t i = first_; said_ != nullptr && i < said_->points.size(); ++i) {
      steps.push_back(said_->points[i].step);
    }
    std::sort(steps.begin(), steps.end());
    steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
    return steps;
  }
  std::array<float, 2> At(float step) const {
    const std::size_t next = std::max(IndexAfter(step), first_);
    const ForecastPoint from = next == first_ ? Now() : Point(next - 1);
    if (next < (said_ != nullptr ? said_->points.size() : track_.size())) {
      return On(from, Point(next), step);
    }
    if (said_ == nullptr || next < 2) return {from.x, from.y};
    return On(Point(next - 2), from, std::min(step, std::max(track_.back().step, from.step)));
  }

 private:
  static std::array<float, 2> On(ForecastPoint from, ForecastPoint to, float step) {
    const float part = (step - from.step) / (to.step - from.step);
    return {from.x + (to.x - from.x) * part, from.y + (to.y - from.y) * part};
  }
  std::size_t IndexAfter(float step) const {
    return said_ != nullptr ? After(step, said_->points) : After(step, track_);
  }
  ForecastPoint Now() const {
    const std::size_t next = After(issued_, track_);
    const Waypoint& from = track_[next == 0 ? 0 : next - 1];
    if (next == 0 || next == track_.size()) return {issued_, from.x, from.y};
    const Waypoint& to = track_[next];
    const float part = (issued_ - from.step) / (to.step - from.step);
    return {issued_, from.x + (to.x - from.x) * part, from.y + (to.y - from.y) * part};
  }
  ForecastPoint Point(std::size_t i) const {
    if (said_ != nullptr) return said_->points[i];
    const Waypoint& point = track_[i];
    const float error = MeanForecastError(scenario_, point.step - issued_);
    return {point.step, point.x + error * error_[0], point.y + error * error_[1]};
  }

  const Scenario& scenario_;
  const std::vector<Waypoint>& track_;
  const IssuedForecast* said_;  // null: uses the displaced true track
  float issued_;
  std::size_t first_;  // index of the first future point
  std::array<float, 2> error_{};
};

// Returns the sum of four draws from [0, 1) minus its mean. It is approximately normal and
// bit-identical on every machine.
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
  // 1 / mean length of a vector of two such sums; verified by a test.
  constexpr float kScale = 1.3697F;
  const StreamKey key{seed, episode, RngStream::kForecast, static_cast<std::uint32_t>(disaster)};
  return {kScale * NearlyNormal(Draw(key, 0)), kScale * NearlyNormal(Draw(key, 1))};
}

bool HasForecast(const Farm& farm, std::int32_t disaster, std::int32_t issued) {
  if (TrackOf(farm, disaster).empty()) return false;
  return !farm.scenario().view.forecast_error_km.empty() ||
         NewestSaid(farm, disaster, issued) != nullptr;
}

std::array<float, 2> ForecastAt(const Farm& farm, std::int32_t disaster, std::int32_t issued,
                                std::int32_t step) {
  return Forecast(farm, disaster, issued).At(static_cast<float>(step));
}

std::vector<Waypoint> ForecastTrack(const Farm& farm, std::int32_t disaster, std::int32_t issued) {
  const Forecast forecast(farm, disaster, issued);
  std::vector<Waypoint> track;
  for (const float step : forecast.Steps()) {
    track.push_back(TruthAt(TrackOf(farm, disaster), step));
    const std::array<float, 2> place = forecast.At(step);
    track.back().x = place[0];
    track.back().y = place[1];
  }
  return track;
}

}  // namespace aquafarm
