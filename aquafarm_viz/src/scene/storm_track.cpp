// SPDX-License-Identifier: BSD-3-Clause
#include "scene/storm_track.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <opencv2/core/types.hpp>

#include "aquafarm/scenario/limits.h"
#include "aquafarm/tracks/wind_name.h"
#include "aquafarm_viz/base/disaster_kinds.h"
#include "aquafarm_viz/base/text.h"
#include "aquafarm_viz/scene/rings.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DisasterState;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

constexpr double kErrorLead_h = 24.0;           // hours between two entries of forecast_error_km
constexpr double kSameCells = 1.0;              // a disaster nearer to its track follows it [cells]
constexpr int kHorizon = 10000;                 // max length of a course [steps]
constexpr std::size_t kMaxErrorPoints = 4096U;  // max points of a course with errors

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
  if (const YAML::Node wind = node["wind_mps"]) point.wind_mps = wind.as<double>();
  return point;
}

Track ReadTrack(const YAML::Node& points) {
  Track track;
  for (const YAML::Node& point : points) track.push_back(ReadPoint(point));
  return track;
}

// Interpolates the lists of two points. If their lengths differ, returns the list of the first
// point, or that of the second point if the first list is empty.
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

// Adds rings and risks to the points of a course that lack them. The added values are those of the
// true track at the same step.
void AddRings(Track& course, const Track& truth) {
  for (TrackPoint& point : course) {
    const TrackPoint true_storm = TrackAt(truth, point.step);
    if (point.radii.empty()) {
      point.radii = true_storm.radii;
      point.risks = true_storm.risks;
    }
    if (point.risks.empty()) point.risks = true_storm.risks;
    // Without a risk, a ring would count as harmless.
    point.risks.resize(std::max(point.risks.size(), point.radii.size()),
                       double(aquafarm::kWorstRisk));
  }
}

const PublishedForecast* Newest(const std::vector<PublishedForecast>& forecasts, double now) {
  const PublishedForecast* newest = nullptr;
  for (const PublishedForecast& one : forecasts) {
    if (one.issued <= now && !one.points.empty() && one.points.back().step > now) newest = &one;
  }
  return newest;
}

// Moves a point along the present motion of a disaster.
TrackPoint Moved(TrackPoint point, const DisasterState& disaster, double steps) {
  const double bearing = disaster.heading_deg % 360 * M_PI / 180.0;
  point.step += steps;
  point.x += steps * double(disaster.speed) * std::sin(bearing);
  point.y += steps * double(disaster.speed) * std::cos(bearing);
  return point;
}

Course Extrapolated(const DisasterState& disaster, const TrackPoint& present, double growth) {
  constexpr double kSteps = 60.0;  // farther ahead, the present motion predicts little
  const double steps = std::min(kSteps, double(std::max(disaster.steps_left, 1)));
  Course course{Course::Kind::kExtrapolated,
                {present, Moved(present, disaster, steps)},
                {},
                present.step + steps,
                {}};
  for (auto& ring : course.ahead.back().radii) {
    for (double& radius : ring) {
      // A quadrant of radius 0 does not grow, as in the farm.
      if (radius > 0.0 || disaster.quadrants.empty()) radius += steps * std::max(0.0, growth);
    }
  }
  return course;
}

// Continues a forecast after its last point until the true track ends, as the farm does
// (aquafarm/farm/forecast.h): with the motion between the last two points of the forecast, or with
// the present motion of the disaster if the forecast has only one point.
void Continue(Track& ahead, const Track& forecast, const DisasterState& disaster, double until) {
  const TrackPoint& last = forecast.back();
  const double steps = until - last.step;
  if (!(steps > 0.0)) return;
  if (forecast.size() == 1) return ahead.push_back(Moved(last, disaster, steps));
  const TrackPoint& before = forecast[forecast.size() - 2];
  const double share = steps / (last.step - before.step);
  ahead.push_back({until, last.x + share * (last.x - before.x),
                   last.y + share * (last.y - before.y), last.radii, last.risks});
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
        for (TrackPoint& point : storms.forecasts.back().back().points) {
          if (point.risks.empty() && !point.radii.empty()) point.risks = risks;
        }
      }
      storms.growths.push_back(disaster["radius_growth"].as<double>(0.0));
      storms.kinds.push_back(disaster["kind"].as<std::string>(""));
      storms.names.push_back(disaster["name"].as<std::string>(""));
      storms.ring_winds_kt.emplace_back();
      for (const YAML::Node& wind : disaster["ring_winds_kt"]) {
        storms.ring_winds_kt.back().push_back(wind.as<std::int32_t>());
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

namespace {

// Returns the name of a wind. Hurricane force also has its wind, "hurricane force (64 kt)", because
// lists of devices contain the wind instead of the name.
std::string LegendName(std::int32_t wind_kt) {
  return wind_kt < aquafarm::kHurricaneForce_kt ? aquafarm::WindName(wind_kt)
                                                : aquafarm::RingName(wind_kt);
}

}  // namespace

std::vector<std::pair<double, std::string>> NamedRisks(const FarmSpec& spec) {
  constexpr std::size_t kMaxNames = 4;
  const auto winds = ReadStormTracks(spec.scenario_yaml, spec.cell_size_m).ring_winds_kt;
  std::map<double, std::string, std::greater<>> names;  // by risk, the mildest first
  bool is_named = winds.size() == spec.disasters.size();
  for (std::size_t i = 0; i < spec.disasters.size(); ++i) {
    const auto& risks = spec.disasters[i].risks;
    is_named = is_named && winds[i].size() == risks.size();
    for (std::size_t ring = 0; ring < risks.size(); ++ring) {
      const double risk = std::round(double(risks[ring]));
      const std::string wind = is_named ? LegendName(winds[i][ring]) + " " : "";
      const std::string name = wind + Number(risk, 0);
      is_named = names.emplace(risk, name).first->second == name && is_named;
    }
  }
  if (names.empty() || names.size() > kMaxNames) {
    names = {{-5.0, ""}, {-10.0, ""}, {-15.0, ""}, {-20.0, ""}};
    is_named = false;
  }
  for (auto& [risk, name] : names) {
    if (!is_named) name = Number(risk, 0);
  }
  return {names.begin(), names.end()};
}

TrackPoint TrackAt(const Track& track, double step) {
  const auto after =
      std::find_if(track.begin(), track.end(), [&](const TrackPoint& p) { return p.step >= step; });
  if (after == track.begin()) return track.front();
  if (after == track.end()) return track.back();
  const TrackPoint& before = *(after - 1);
  const double share = (step - before.step) / (after->step - before.step);
  const auto mix = [share](double a, double b) { return a + share * (b - a); };
  return {step,
          mix(before.x, after->x),
          mix(before.y, after->y),
          Between(before.radii, after->radii,
                  [&](const auto& a, const auto& b) {
                    std::array<double, 4> radii{};
                    for (std::size_t q = 0; q < 4; ++q) radii[q] = mix(a[q], b[q]);
                    return radii;
                  }),
          Between(before.risks, after->risks, mix),
          before.wind_mps && after->wind_mps
              ? std::optional<double>(mix(*before.wind_mps, *after->wind_mps))
              : std::nullopt};
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
  TrackPoint present = Present(disaster, now);
  const double growth = index < tracks.growths.size() ? tracks.growths[index] : 0.0;
  if (state.observer >= 0 || index >= tracks.tracks.size() || tracks.tracks[index].empty()) {
    return Extrapolated(disaster, present, growth);
  }
  const Track& truth = tracks.tracks[index];
  const TrackPoint expected = TrackAt(truth, now);
  if (std::hypot(expected.x - present.x, expected.y - present.y) >= kSameCells) {
    return Extrapolated(disaster, present, growth);
  }
  const PublishedForecast* forecast = Newest(tracks.forecasts[index], now);
  const Track& source = forecast != nullptr ? forecast->points : truth;
  const double end = now + std::clamp(disaster.steps_left, 1, kHorizon);
  present.wind_mps = expected.wind_mps;
  Course course{forecast != nullptr ? Course::Kind::kPublished : Course::Kind::kRecorded,
                {present},
                {},
                forecast != nullptr ? std::min(end, source.back().step) : end,
                {}};
  std::string kind = DisasterName(disaster.kind);
  std::replace(kind.begin(), kind.end(), ' ', '_');
  if (kind == tracks.kinds[index]) course.name = tracks.names[index];
  // A bulletin may have replaced the rings, in which case their number may differ.
  const std::vector<std::int32_t>& winds = tracks.ring_winds_kt[index];
  if (winds.size() == present.radii.size()) course.ring_winds_kt = winds;
  for (const TrackPoint& point : source) {
    if (point.step > now) course.ahead.push_back(point);
  }
  if (forecast != nullptr) Continue(course.ahead, source, disaster, truth.back().step);
  const TrackPoint last = TrackAt(course.ahead, end);
  while (course.ahead.size() > 1 && course.ahead.back().step >= end) course.ahead.pop_back();
  course.ahead.push_back(last);
  course.ahead.back().step = end;
  for (const TrackPoint& point : truth) {
    if (point.step < now) course.past.push_back(point);
  }
  if (!course.past.empty()) course.past.push_back(present);
  AddRings(course.ahead, truth);
  if (forecast == nullptr) course.errors = ErrorsOf(course.ahead, spec, tracks.error_cells);
  return course;
}

std::vector<Course> CourseReader::Read(const FarmSpec& spec, const FarmState& state) {
  if (scenario_yaml_ != spec.scenario_yaml || cell_size_m_ != spec.cell_size_m) {
    scenario_yaml_ = spec.scenario_yaml;
    cell_size_m_ = spec.cell_size_m;
    tracks_ = ReadStormTracks(spec.scenario_yaml, spec.cell_size_m);
  }
  std::vector<Course> courses;
  for (std::size_t i = 0; i < state.disasters.size(); ++i) {
    courses.push_back(CourseOf(spec, state, i, tracks_));
  }
  return courses;
}

double MeanForecastError(const std::vector<double>& errors, double lead_h) {
  const double at = std::max(0.0, lead_h / kErrorLead_h);
  const auto next = std::min(static_cast<std::size_t>(at), errors.size() - 1);
  const double from = next == 0 ? 0.0 : errors[next - 1];
  return from + (at - double(next)) * (errors[next] - from);
}

}  // namespace aquafarm_viz
