// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Tracks, published forecasts and forecast errors of the disasters of a scenario, and the
/// positions on them; private to this package.

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

/// A disaster at one time.
struct TrackPoint {
  double step{};  ///< steps since the start of the episode; may be negative
  double x{};     ///< centre [cells]
  double y{};
  std::vector<std::array<double, 4>> radii{};  ///< to the NE, SE, SW, NW [cells], one per ring
  std::vector<double> risks{};                 ///< one per ring, worst first; empty: not given
  std::optional<double> wind_mps{};            ///< max sustained wind; nullopt: not given
};

/// The track of one disaster; empty if it has none.
using Track = std::vector<TrackPoint>;  // steps ascending

/// A published forecast.
struct PublishedForecast {
  double issued{};  ///< step of issue
  Track points;
};

/// The disasters of a scenario as far as their motion is given.
struct StormTracks {
  std::vector<Track> tracks;                              ///< one per disaster
  std::vector<std::vector<PublishedForecast>> forecasts;  ///< one list per disaster
  std::vector<double> growths;  ///< of every radius [cells/step], one per disaster
  /// Wind within each ring [kn], one list per disaster; empty: not given.
  std::vector<std::vector<std::int32_t>> ring_winds_kt;
  std::vector<std::string> kinds;   ///< one per disaster, as in a scenario: "storm_surge"
  std::vector<std::string> names;   ///< one per disaster; empty: it has no name
  std::vector<double> error_cells;  ///< mean error after 24, 48, … hours; empty: not given
};

/// Reads a canonical scenario. The tracks are empty if the text cannot be read, and for a disaster
/// that draws another storm in each episode.
StormTracks ReadStormTracks(const std::string& scenario_yaml, double cell_size_m);

/// Returns risks for a key, the mildest first, and their words: those of the disasters' rings with
/// their winds, such as "gale -5", if all are given, else four from "-5" to "-20".
std::vector<std::pair<double, std::string>> NamedRisks(const aquafarm_msgs::FarmSpec& spec);

/// Returns a track's position and rings at a step; at a step outside the track those of the nearest
/// end. Between two points all is interpolated, as in the farm.
/// @param track  at least one point
TrackPoint TrackAt(const Track& track, double step);

/// Returns the point of a track that is nearest to the middle of a farm, at or after a step.
/// @param track  at least one point
TrackPoint ClosestApproach(const aquafarm_msgs::FarmSpec& spec, const Track& track,
                           double from_step);

/// The future of a disaster in a picture.
struct Course {
  enum class Kind {
    kRecorded,     ///< the storm follows its track
    kPublished,    ///< newest forecast of an authority; after its last point as in the farm
    kExtrapolated  ///< present speed and heading; the rings grow by radius_growth, never shrink
  };
  Kind kind{Kind::kExtrapolated};
  Track ahead;                 ///< from the present step on; at least one point
  Track past;                  ///< up to the present step; may be empty
  double known_until{};        ///< step until which it is recorded, published or extrapolated
  std::vector<double> errors;  ///< mean forecast error at each point of `ahead` [cells], or empty
  std::vector<std::int32_t> ring_winds_kt{};  ///< wind within each ring [kn]; empty: not given
  std::string name{};  ///< of the storm; empty: it has none, or this need not be its course
};

/// Returns the course of disaster `index`. An observation contains no track, so its course is
/// extrapolated, and so is that of a disaster that is not where its track has it.
Course CourseOf(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                std::size_t index, const StormTracks& tracks);

/// Returns the courses of the disasters of a state, and reads a scenario's text once.
class CourseReader {
 public:
  /// @return one course per disaster
  std::vector<Course> Read(const aquafarm_msgs::FarmSpec& spec,
                           const aquafarm_msgs::FarmState& state);

 private:
  std::string scenario_yaml_;  // of the tracks
  double cell_size_m_{};
  StormTracks tracks_;
};

/// Returns the mean forecast error at a lead time [cells]: 0 at lead 0, linear between the errors
/// after 24, 48, … hours, and beyond along the last two. `errors` must not be empty.
double MeanForecastError(const std::vector<double>& errors, double lead_h);

}  // namespace aquafarm_viz
