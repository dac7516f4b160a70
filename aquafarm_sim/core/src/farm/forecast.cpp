// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/forecast.h"

#include <algorithm>

#include "aquafarm/base/check.h"

namespace aquafarm {
namespace {

const std::vector<Waypoint>& TrackOf(const Farm& farm, std::int32_t disaster) {
  return *farm.tracks()[static_cast<std::size_t>(disaster)];
}

// Returns the last forecast of a list that was issued at or before a step; nullptr if there is
// none.
const IssuedForecast* LastIssued(const std::vector<IssuedForecast>& list, float step) {
  if (list.empty()) return nullptr;  // the common case
  const auto next =
      std::upper_bound(list.begin(), list.end(), step,
                       [](float at, const IssuedForecast& forecast) { return at < forecast.step; });
  return next == list.begin() ? nullptr : &*(next - 1);
}

// Returns the index of the first point after a step, or the number of points if there is none.
template <typename Points>
std::size_t After(float step, const Points& points) {
  const auto next = std::upper_bound(points.begin(), points.end(), step,
                                     [](float at, const auto& point) { return at < point.step; });
  return static_cast<std::size_t>(next - points.begin());
}

// Returns the true state at a step. Before the first waypoint, it is the state of the first
// waypoint. After the last waypoint, it is the state of the last one.
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

// Returns the position at which a forecast of step `issued` starts. With a track, it is the
// position on the true track. Without a track, it is the current position if `issued` is the
// current step, else the position in the last bulletin, because earlier positions are not stored.
std::array<float, 2> PositionAt(const Farm& farm, std::int32_t disaster, std::int32_t issued) {
  const std::vector<Waypoint>& track = TrackOf(farm, disaster);
  if (track.empty()) {
    const Disaster& present = farm.disasters()[static_cast<std::size_t>(disaster)];
    if (issued == farm.step()) return {present.x, present.y};
    const Bulletin& bulletin = farm.BulletinOf(static_cast<std::size_t>(disaster));
    return {bulletin.x, bulletin.y};
  }
  const auto step = static_cast<float>(issued);
  const std::size_t next = After(step, track);
  const Waypoint& from = track[next == 0 ? 0 : next - 1];
  if (next == 0 || next == track.size()) return {from.x, from.y};
  const Waypoint& to = track[next];
  const float part = (step - from.step) / (to.step - from.step);
  return {from.x + (to.x - from.x) * part, from.y + (to.y - from.y) * part};
}

// Returns the displacement per step that is known at step `issued`. With a track, it is that of the
// true track. Without a track, it is the current one if `issued` is the current step. For an
// earlier step, it has the heading of the last bulletin and the current speed.
std::array<float, 2> MotionAt(const Farm& farm, std::int32_t disaster, std::int32_t issued) {
  const std::vector<Waypoint>& track = TrackOf(farm, disaster);
  if (track.empty()) {
    const Disaster& present = farm.disasters()[static_cast<std::size_t>(disaster)];
    if (issued == farm.step()) return {present.dx, present.dy};
    const Bulletin& bulletin = farm.BulletinOf(static_cast<std::size_t>(disaster));
    const std::array<float, 2> heading = HeadingVector(bulletin.heading_deg);
    return {present.speed * heading[0], present.speed * heading[1]};
  }
  const std::size_t next = After(static_cast<float>(issued), track);
  if (next == 0 || next == track.size()) return {0.0F, 0.0F};
  const Waypoint& from = track[next - 1];
  const Waypoint& to = track[next];
  return {(to.x - from.x) / (to.step - from.step), (to.y - from.y) / (to.step - from.step)};
}

// Returns a waypoint with `by` cells added to every radius, as GrowRings does.
Waypoint Grown(Waypoint point, float by) {
  for (float& radius : point.radii) radius = std::max(0.0F, radius + by);
  for (QuadrantRadii& radii : point.quadrants) {
    for (float& radius : radii) radius = radius > 0.0F ? std::max(0.0F, radius + by) : 0.0F;
  }
  return point;
}

// The forecast of one disaster that applies at step `issued`. It starts at the position of
// PositionAt. Its later positions are those of the newest forecast of an authority. Without such a
// forecast, they are those of the true track, displaced by the forecast error.
class Forecast {
 public:
  Forecast(const Farm& farm, std::int32_t disaster, std::int32_t issued)
      : farm_(farm),
        disaster_(disaster),
        track_(TrackOf(farm, disaster)),
        newest_(NewestForecast(farm, disaster, issued)),
        issued_(static_cast<float>(issued)),
        first_(IndexAfter(issued_)) {
    const std::array<float, 2> now = PositionAt(farm, disaster, issued);
    now_ = {issued_, now[0], now[1]};
    motion_ = MotionAt(farm, disaster, issued);
    if (newest_ == nullptr) error_ = ForecastErrorVector(farm.seed(), farm.episode(), disaster);
  }

  std::array<float, 2> At(float step) const {
    const std::size_t next = std::max(IndexAfter(step), first_);
    const Place from = next == first_ ? now_ : Point(next - 1);
    if (next < (newest_ != nullptr ? newest_->points.size() : track_.size())) {
      return On(from, Point(next), step);
    }
    if (newest_ == nullptr) return {from.x, from.y};
    const float until = std::min(step, EndAfter(from.step));
    if (next >= 2) return On(Point(next - 2), from, until);
    const float beyond = until - from.step;  // only one point: no last leg to extrapolate
    return {from.x + beyond * motion_[0], from.y + beyond * motion_[1]};
  }

  // Returns the forecast as a track, with the rings of StateAt.
  std::vector<Waypoint> AsTrack() const {
    std::vector<Waypoint> track;
    for (const float step : Steps()) {
      track.push_back(StateAt(step));
      const std::array<float, 2> place = At(step);
      track.back().step = step;
      track.back().x = place[0];
      track.back().y = place[1];
    }
    return track;
  }

 private:
  struct Place {
    float step{};
    float x{};
    float y{};
  };

  bool HasOwnRings() const { return newest_ != nullptr && !newest_->points[0].radii.empty(); }
  bool FollowsTrueRings() const { return !HasOwnRings() && !track_.empty(); }
  const Disaster& Present() const { return farm_.disasters()[static_cast<std::size_t>(disaster_)]; }
  // Returns the step until which a forecast is extrapolated beyond its last point. This is the last
  // step of the true track or, without a track, the step at which the disaster ends, but at least
  // `last`.
  // @param last step of the last point
  float EndAfter(float last) const {
    const float end =
        track_.empty() ? static_cast<float>(farm_.step()) + static_cast<float>(Present().steps_left)
                       : track_.back().step;
    return std::max(end, last);
  }

  // Returns the steps of the waypoints of AsTrack in ascending order. They are the step of issue,
  // and the steps of the later waypoints of the true track if the rings of the track apply. For a
  // forecast of an authority, the steps of its later points and the result of EndAfter are added.
  std::vector<float> Steps() const {
    std::vector<float> steps{issued_};
    for (std::size_t i = After(issued_, track_); FollowsTrueRings() && i < track_.size(); ++i) {
      steps.push_back(track_[i].step);
    }
    for (std::size_t i = first_; newest_ != nullptr && i < newest_->points.size(); ++i) {
      steps.push_back(newest_->points[i].step);
    }
    if (newest_ != nullptr) steps.push_back(EndAfter(newest_->points.back().step));
    std::sort(steps.begin(), steps.end());
    steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
    return steps;
  }

  // Returns grade and rings at one of Steps(). After the step of issue they are those of the
  // forecast, if it has rings. In other cases they follow from the true disaster.
  Waypoint StateAt(float step) const {
    if (FollowsTrueRings()) return TruthAt(track_, step);
    const float growth = track_.empty() ? Present().radius_growth : 0.0F;
    if (step > issued_ && HasOwnRings()) {
      const Waypoint& last = newest_->points[IndexAfter(step) - 1];
      // The rings of the last point grow by radius_growth per step. They do not shrink if it is
      // negative.
      return Grown(last, std::max(0.0F, growth) * (step - last.step));
    }
    if (!track_.empty()) return TruthAt(track_, issued_);
    return Grown(RingsOf(Present()), growth * (step - static_cast<float>(farm_.step())));
  }

  static std::array<float, 2> On(Place from, Place to, float step) {
    const float part = (step - from.step) / (to.step - from.step);
    return {from.x + (to.x - from.x) * part, from.y + (to.y - from.y) * part};
  }
  std::size_t IndexAfter(float step) const {
    return newest_ != nullptr ? After(step, newest_->points) : After(step, track_);
  }
  Place Point(std::size_t i) const {
    if (newest_ != nullptr)
      return {newest_->points[i].step, newest_->points[i].x, newest_->points[i].y};
    const Waypoint& point = track_[i];
    const float error = MeanForecastError(farm_.scenario(), point.step - issued_);
    return {point.step, point.x + error * error_[0], point.y + error * error_[1]};
  }

  const Farm& farm_;
  std::int32_t disaster_;
  const std::vector<Waypoint>& track_;
  const IssuedForecast* newest_;  // null: the displaced true track applies
  float issued_;
  std::size_t first_;  // index of the first point after the step of issue
  Place now_;
  std::array<float, 2> motion_{};  // known at the step of issue [cells/step]
  std::array<float, 2> error_{};
};

// Returns the sum of four numbers that are uniform in [0, 1), minus the mean of that sum. It is
// approximately normal and bit-identical on every machine.
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
  // 1 / mean length of a vector whose two components are NearlyNormal; verified by a test.
  constexpr float kScale = 1.3697F;
  const StreamKey key{seed, episode, RngStream::kForecast, static_cast<std::uint32_t>(disaster)};
  return {kScale * NearlyNormal(Draw(key, 0)), kScale * NearlyNormal(Draw(key, 1))};
}

const IssuedForecast* NewestForecast(const Farm& farm, std::int32_t disaster, std::int32_t issued) {
  const std::vector<DisasterSpec>& specs = farm.scenario().disasters;
  const auto id = static_cast<std::size_t>(disaster);
  const auto step = static_cast<float>(issued);
  const auto in_force = [step](const IssuedForecast* one) {
    return one != nullptr && one->points.back().step > step ? one : nullptr;
  };
  const IssuedForecast* newest = nullptr;
  if (id < specs.size() && farm.tracks()[id].get() == &specs[id].track) {
    newest = in_force(LastIssued(specs[id].forecasts, step));
  }
  if (const Forecasts& forecasts = farm.forecasts()[id]; forecasts != nullptr) {
    const IssuedForecast* last = in_force(LastIssued(*forecasts, step));
    if (last != nullptr && (newest == nullptr || last->step >= newest->step)) newest = last;
  }
  return newest;
}

Waypoint RingsOf(const ObservableDisaster& disaster) {
  Waypoint now{0.0F, disaster.x, disaster.y, disaster.grade};
  for (std::size_t k = 0; k < static_cast<std::size_t>(disaster.rings); ++k) {
    now.radii.push_back(disaster.radius[k]);
    now.risks.push_back(disaster.risk[k]);
    if (!disaster.by_quadrant) continue;
    now.quadrants.push_back({disaster.quadrant[0][k], disaster.quadrant[1][k],
                             disaster.quadrant[2][k], disaster.quadrant[3][k]});
  }
  return now;
}

bool HasForecastOfTrack(const Farm& farm, std::int32_t disaster, std::int32_t issued) {
  if (NewestForecast(farm, disaster, issued) != nullptr) return true;
  return !TrackOf(farm, disaster).empty() && !farm.scenario().view.forecast_error_km.empty();
}

std::array<float, 2> ForecastAt(const Farm& farm, std::int32_t disaster, std::int32_t issued,
                                std::int32_t step) {
  return Forecast(farm, disaster, issued).At(static_cast<float>(step));
}

std::vector<Waypoint> ForecastTrack(const Farm& farm, std::int32_t disaster, std::int32_t issued) {
  return Forecast(farm, disaster, issued).AsTrack();
}

}  // namespace aquafarm
