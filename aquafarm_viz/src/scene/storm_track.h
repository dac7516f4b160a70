// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Tracks, published forecasts and forecast errors of the disasters of a scenario, and the expected
/// courses of the disasters of a state; private to this package.

#include <aquafarm_msgs/DisasterState.h>
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aquafarm_viz {

inline constexpr double kHour_s = 3600.0;

/// Position, rings and wind of a disaster at one time.
struct TrackPoint {
  double step{};  ///< steps since the start of the episode; may be negative
  double x{};     ///< centre [cells]
  double y{};
  /// Radii of each ring to the NE, SE, SW and NW [cells], the innermost ring first.
  std::vector<std::array<double, 4>> radii{};
  std::vector<double> risks{};       ///< one per ring, worst first; empty: not given
  std::optional<double> wind_mps{};  ///< max sustained wind; nullopt: not given
};

/// Points of a track or forecast, steps ascending; empty if a disaster has no track.
using Track = std::vector<TrackPoint>;

/// A forecast that an authority has published.
struct PublishedForecast {
  double issued{};  ///< step of issue
  Track points;
};

/// The data of a scenario about the motion of its disasters.
struct StormTracks {
  std::vector<Track> tracks;                              ///< one per disaster
  std::vector<std::vector<PublishedForecast>> forecasts;  ///< one list per disaster
  std::vector<double> growths;  ///< growth of every radius [cells/step], one per disaster
  /// Min wind within each ring [kn], one list per disaster; an empty list: not given.
  std::vector<std::vector<std::int32_t>> ring_winds_kt;
  std::vector<std::string> kinds;   ///< one per disaster, spelled as in a scenario: "storm_surge"
  std::vector<std::string> names;   ///< one per disaster; empty: it has no name
  std::vector<double> error_cells;  ///< mean forecast error after 24, 48, … h; empty: not given
};

/// Reads the disasters of a scenario. Returns empty lists if the text cannot be read. The track of
/// a disaster is empty if the scenario does not contain it, for example because each episode draws
/// another storm.
/// @param scenario_yaml  FarmSpec.scenario_yaml
StormTracks ReadStormTracks(const std::string& scenario_yaml, double cell_size_m);

/// Returns the risks that a legend shows and their texts, the mildest first. These are the risks of
/// all rings at the start of the episode, and the texts contain the name of the wind, such as "gale
/// -5". If a ring has no wind, or if two names share a risk, the texts are only the risks. Without
/// rings, or with more than four risks, the risks are -5, -10, -15 and -20.
std::vector<std::pair<double, std::string>> NamedRisks(const aquafarm_msgs::FarmSpec& spec);

/// Returns the point of a track at a step. Between two points, position and rings are interpolated
/// as in the farm, and the wind linearly. Returns the first point if `step` is before it, and the
/// last point if `step` is after it; the result then has the step of that point.
/// @param track  at least one point
TrackPoint TrackAt(const Track& track, double step);

/// Returns the point of a track at which the centre is nearest to the middle of a farm, at or after
/// `from_step`; the earliest one if there are several.
/// @param track  at least one point
TrackPoint ClosestApproach(const aquafarm_msgs::FarmSpec& spec, const Track& track,
                           double from_step);

/// The past and the expected motion of a disaster.
struct Course {
  enum class Kind {
    kRecorded,  ///< the track of the scenario
    /// The newest forecast of an authority. After its last point, the course continues as in the
    /// farm (aquafarm/farm/forecast.h).
    kPublished,
    kExtrapolated  ///< present speed and heading; the rings grow by radius_growth, never shrink
  };
  Kind kind{Kind::kExtrapolated};
  Track ahead;  ///< from the present step on; at least two points
  Track past;   ///< up to the present step; may be empty
  /// Last step of the course that is known. Of a published forecast, this is the step of its last
  /// point, or the end of the disaster if that is earlier; `ahead` may continue after it. For other
  /// kinds, this is the step of the last point of `ahead`.
  double known_until{};
  std::vector<double> errors;  ///< mean forecast error at each point of `ahead` [cells], or empty
  std::vector<std::int32_t> ring_winds_kt{};  ///< min wind within each ring [kn]; empty: not given
  /// Name of the storm; empty if it has none, if the course is extrapolated, or if the disaster has
  /// another kind than in the scenario.
  std::string name{};
};

/// Returns the course of a disaster. It is extrapolated if the state is an observation of a ship,
/// if the disaster has no track, or if its centre is at least one cell away from the point of its
/// track at this step.
/// @param index  index in FarmState.disasters
Course CourseOf(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                std::size_t index, const StormTracks& tracks);

/// Computes the courses of the disasters of a state. Caches the tracks of the last scenario.
class CourseReader {
 public:
  /// @return one course per disaster
  std::vector<Course> Read(const aquafarm_msgs::FarmSpec& spec,
                           const aquafarm_msgs::FarmState& state);

 private:
  std::string scenario_yaml_;  // the text from which `tracks_` was read
  double cell_size_m_{};
  StormTracks tracks_;
};

/// Returns the mean forecast error at a lead time [cells]. It is interpolated linearly between 0 at
/// lead time 0 and the errors after 24, 48, … hours. Beyond the last error it is extrapolated from
/// the last two of these points.
/// @param errors  mean errors after 24, 48, … hours [cells], at least one
double MeanForecastError(const std::vector<double>& errors, double lead_h);

}  // namespace aquafarm_viz
