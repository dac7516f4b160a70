// SPDX-License-Identifier: BSD-3-Clause
#include "scene/storm_track.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core/types.hpp>

#include "aquafarm_viz/scene/rings.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DisasterState;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

constexpr double kHour_s = 3600.0;
constexpr double kErrorLead_h = 24.0;           // between two entries of forecast_error_km
constexpr double kSameCells = 1.0;              // a disaster this near its track follows it
constexpr int kHorizon = 10000;                 // [steps]
constexpr std::size_t kMaxErrorPoints = 4096U;  // of a course with errors

TrackPoint ReadPoint(const YAML::Node& node) {
  TrackPoint point{
      node["step"].as<double>(), node["x"].as<double>(), node["y"].as<double>(), {}, {}};
  for (const YAML::Node& ring : node["quadrants"]) {
    point.radii.push_back(ring.as<std::array<double, 4>>());
  }
  for (const YAML::Node& radius : node["radii"]) {
    const auto r = radius.as<double>();
    point.radii.push_back({r, r, r, r});
  }
  for (const YAML::Node& risk : node["risks"]) point.risks.push_back(risk.as<double>());
  return point;
}

Track ReadTrack(const YAML::Node& points) {
  Track track;
  for (const YAML::Node& point : points) track.push_back(ReadPoint(point));
  return track;
}

// Interpolates two rings. Rings that one of the points does not have keep those of the other.
template <typename T, typename Mix>
std::vector<T> Between(const std::vector<T>& from, const std::vector<T>& to, Mix mix) {
  if (from.size() != to.size()) return from.empty() ? to : from;
  std::vector<T> mixed;
  for (std::size_t i = 0; i < from.size(); ++i) mixed.push_back(mix(from[i], to[i]));
  return mixed;
}

TrackPoint Present(const DisasterState& disaster, double step) {
  TrackPoint point{step, double(disaster.x), double(disaster.y), {}, {}};
  for (std::size_t ring = 0; ring < disaster.radii.size(); ++ring) {
    point.radii.push_back(RingQuadrants(disaster, ring));
    point.risks.push_back(ring < disaster.risks.size() ? double(disaster.risks[ring]) : 0.0);
  }
  return point;
}

// The rings of a forecast without rings are those of the true storm at that time.
void AddRings(Track& course, const Track& truth, const TrackPoint& present) {
  for (TrackPoint& point : course) {
    if (point.radii.empty()) {
      point.radii = truth.empty() ? present.radii : TrackAt(truth, point.step).radii;
    }
    if (point.risks.empty()) point.risks = present.risks;
  }
}

const PublishedForecast* Newest(const std::vector<PublishedForecast>& forecasts, double now) {
  const PublishedForecast* newest = nullptr;
  for (const PublishedForecast& one : forecasts) {
    if (one.issued <= now && !one.points.empty() && one.points.back().step > now) newest = &one;
  }
  return newest;
}

Course Extrapolated(const DisasterState& disaster, const TrackPoint& present) {
  constexpr double kSteps = 60.0;  // farther ahead a present course means little
  Course course{Course::Kind::kExtrapolated, {present, present}, {}, {}};
  TrackPoint& end = course.ahead.back();
  const double steps = std::min(kSteps, double(std::max(disaster.steps_left, 1)));
  const double bearing = disaster.heading_deg % 360 * M_PI / 180.0;
  end.step += steps;
  end.x += steps * double(disaster.speed) * std::sin(bearing);
  end.y += steps * double(disaster.speed) * std::cos(bearing);
  return course;
}

std::vector<double> ErrorsOf(const Track& ahead, const FarmSpec& spec,
                             const std::vector<double>& error_cells) {
  std::vector<double> errors;
  if (error_cells.empty() || ahead.size() > kMaxErrorPoints) return errors;
  for (const TrackPoint& point : ahead) {
    const double lead_h = (point.step - ahead.front().step) * spec.step_duration_s / kHour_s;
    errors.push_back(MeanForecastError(error_cells, lead_h));
  }
  return errors;
}

}  // namespace

StormTracks ReadStormTracks(const std::string& scenario_yaml, double cell_size_m) {
  StormTracks storms;
  try {
    const YAML::Node scenario = YAML::Load(scenario_yaml);
    for (const YAML::Node& disaster : scenario["disasters"]) {
      storms.tracks.push_back(ReadTrack(disaster["track"]));
      std::vector<double> risks;
      for (const YAML::Node& risk : disaster["risks"]) risks.push_back(risk.as<double>());
      for (TrackPoint& point : storms.tracks.back()) {
        if (point.risks.empty()) point.risks = risks;
      }
      storms.forecasts.emplace_back();
      for (const YAML::Node& forecast : disaster["forecasts"]) {
        storms.forecasts.back().push_back(
            {forecast["step"].as<double>(), ReadTrack(forecast["points"])});
      }
    }
    if (const YAML::Node view = scenario["view"]) {
      for (const YAML::Node& km : view["forecast_error_km"]) {
        storms.error_cells.push_back(km.as<double>() * 1000.0 / cell_size_m);
      }
    }
  } catch (const YAML::Exception&) {
    return {};
  }
  return storms;
}

TrackPoint TrackAt(const Track& track, double step) {
  const auto after =
      std::find_if(track.begin(), track.end(), [&](const TrackPoint& p) { return p.step >= step; });
  if (after == track.begin()) return track.front();
  if (after == track.end()) return track.back();
  const TrackPoint& before = *(after - 1);
  const double share = (step - before.step) / (after->step - before.step);
  const auto mix = [share](double a, double b) { return a + share * (b - a); };
  return {step, mix(before.x, after->x), mix(before.y, after->y),
          Between(before.radii, after->radii,
                  [&](const auto& a, const auto& b) {
                    std::array<double, 4> radii{};
                    for (std::size_t q = 0; q < 4; ++q) radii[q] = mix(a[q], b[q]);
                    return radii;
                  }),
          Between(before.risks, after->risks, mix)};
}

TrackPoint ClosestApproach(const FarmSpec& spec, const Track& track, double from_step) {
  const cv::Point2d middle((spec.width - 1) / 2.0, (spec.height - 1) / 2.0);
  const auto away = [&middle](const TrackPoint& at) {
    return std::hypot(at.x - middle.x, at.y - middle.y);
  };
  TrackPoint best = TrackAt(track, from_step);
  best.step = from_step;
  TrackPoint from = best;
  for (const TrackPoint& to : track) {
    if (to.step <= from_step) continue;
    const cv::Point2d leg(to.x - from.x, to.y - from.y);
    const cv::Point2d towards = middle - cv::Point2d(from.x, from.y);
    const double length = leg.dot(leg);
    const double share = length > 0.0 ? std::clamp(towards.dot(leg) / length, 0.0, 1.0) : 0.0;
    const TrackPoint at = TrackAt({from, to}, from.step + share * (to.step - from.step));
    if (away(at) < away(best)) best = at;
    from = to;
  }
  return best;
}

Course CourseOf(const FarmSpec& spec, const FarmState& state, std::size_t index,
                const StormTracks& tracks) {
  const DisasterState& disaster = state.disasters.at(index);
  const auto now = static_cast<double>(state.step);
  const TrackPoint present = Present(disaster, now);
  if (state.observer >= 0 || index >= tracks.tracks.size() || tracks.tracks[index].empty()) {
    return Extrapolated(disaster, present);
  }
  const Track& truth = tracks.tracks[index];
  const TrackPoint expected = TrackAt(truth, now);
  if (std::hypot(expected.x - present.x, expected.y - present.y) >= kSameCells) {
    return Extrapolated(disaster, present);
  }
  const PublishedForecast* forecast = Newest(tracks.forecasts[index], now);
  Course course{
      forecast != nullptr ? Course::Kind::kPublished : Course::Kind::kRecorded, {present}, {}, {}};
  const double end = now + std::clamp(disaster.steps_left, 1, kHorizon);
  for (const TrackPoint& point : forecast != nullptr ? forecast->points : truth) {
    if (point.step > now && point.step < end) course.ahead.push_back(point);
  }
  const Track& source = forecast != nullptr ? forecast->points : truth;
  if (end > course.ahead.back().step) course.ahead.push_back(TrackAt(source, end));
  course.ahead.back().step = std::max(course.ahead.back().step, now);
  for (const TrackPoint& point : truth) {
    if (point.step < now) course.past.push_back(point);
  }
  if (!course.past.empty()) course.past.push_back(present);
  AddRings(course.ahead, truth, present);
  if (forecast == nullptr) course.errors = ErrorsOf(course.ahead, spec, tracks.error_cells);
  return course;
}

double MeanForecastError(const std::vector<double>& errors, double lead_h) {
  const double at = std::max(0.0, lead_h / kErrorLead_h);
  const auto next = std::min(static_cast<std::size_t>(at), errors.size() - 1);
  const double from = next == 0 ? 0.0 : errors[next - 1];
  return from + (at - double(next)) * (errors[next] - from);
}

}  // namespace aquafarm_viz
