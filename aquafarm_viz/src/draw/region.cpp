// SPDX-License-Identifier: BSD-3-Clause
#include "draw/region.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "aquafarm_viz/scene/rings.h"
#include "draw/nautical.h"
#include "draw/symbols.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DisasterState;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

constexpr double kSmallestSide = 84.0;  // [design units]
constexpr double kTick_h = 6.0;         // between two marks on a track

bool IsOutside(const FarmSpec& spec, const DisasterState& disaster) {
  return IsDrawn(disaster) &&
         (disaster.x < -0.5F || disaster.y < -0.5F || disaster.x > float(spec.width) - 0.5F ||
          disaster.y > float(spec.height) - 0.5F);
}

// Distance from the farm's middle to the edge of the inset: a round number of metres.
double Reach(double farthest_m) {
  double reach = 1000.0;
  while (true) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (factor * reach >= farthest_m || reach > 1e7) return factor * reach;
    }
    reach *= 10.0;
  }
}

// Maps cells to the pixels of the inset.
struct Inset {
  cv::Mat image;
  cv::Point2d middle;  // of the farm [cells]
  double px_per_cell{};

  cv::Point2d At(double x, double y) const {
    return {image.cols / 2.0 + (x - middle.x) * px_per_cell,
            image.rows / 2.0 - (y - middle.y) * px_per_cell};
  }
};

void DrawRings(Inset& inset, const DisasterState& disaster) {
  constexpr int kCorners = 96;
  constexpr int kShift = 4;  // bits of sub-pixel precision
  for (std::size_t ring = disaster.radii.size(); ring-- > 0;) {
    const std::array<double, 4> radii = RingQuadrants(disaster, ring);
    std::vector<cv::Point> outline;
    for (int i = 0; i < kCorners; ++i) {
      const double bearing = 2.0 * CV_PI * i / kCorners;
      const double radius = radii[std::size_t(i * 4 / kCorners)];
      const cv::Point2d at = inset.At(disaster.x + radius * std::sin(bearing),
                                      disaster.y + radius * std::cos(bearing));
      const auto fixed = [](double pixel) {
        return cvRound(std::clamp(pixel, -1e5, 1e5) * (1 << kShift));
      };
      outline.emplace_back(fixed(at.x), fixed(at.y));
    }
    cv::polylines(inset.image, outline, /*isClosed=*/true,
                  Bgr(SeverityColor(Severity(disaster.risks[ring]))), 1, cv::LINE_AA, kShift);
  }
}

// The part behind the present step is faint; the part ahead is bright, with a mark every six hours.
void DrawTrack(Inset& inset, const FarmSpec& spec, const std::vector<TrackPoint>& track, double now,
               const Layout& layout) {
  const double tick = kTick_h * 3600.0 / std::max(1.0, spec.step_duration_s);
  for (std::size_t i = 1; i < track.size(); ++i) {
    const bool past = track[i].step <= now;
    DrawLine(inset.image, inset.At(track[i - 1].x, track[i - 1].y),
             inset.At(track[i].x, track[i].y), Bgr(past ? kFaint : kPaper), layout.Px(1));
  }
  for (double step = now + tick; step <= track.back().step; step += tick) {
    const TrackPoint at = TrackAt(track, step);
    FillCircle(inset.image, inset.At(at.x, at.y), 1.8 * layout.unit, Bgr(kPaper));
  }
}

bool Follows(const std::vector<TrackPoint>& track, const DisasterState& disaster, double step) {
  if (track.empty()) return false;
  const TrackPoint at = TrackAt(track, step);
  return std::hypot(at.x - double(disaster.x), at.y - double(disaster.y)) < 1.0;
}

// The heading above the inset and two lines below it.
struct Words {
  std::string heading{"REGION"};
  std::array<std::string, 2> lines;
};

// Says when a storm is nearest.
Words ApproachWords(const FarmSpec& spec, const FarmState& state,
                    const std::vector<TrackPoint>& track) {
  const auto now = static_cast<double>(state.step);
  const TrackPoint nearest = ClosestApproach(spec, track, now);
  const std::string where = DistanceText(MetresFromFarm(spec, nearest.x, nearest.y)) + " " +
                            PointFromFarm(spec, nearest.x, nearest.y);
  const double ahead_s = (nearest.step - now) * spec.step_duration_s;
  if (ahead_s <= 0.0) return {"MOVING AWAY", {"centre " + where, ""}};
  Words words{"NEAREST POINT", {where + " in " + HoursText(ahead_s), ""}};
  if (spec.has_start_time) {
    const auto time = static_cast<std::time_t>(state.world_time.sec + ahead_s);
    words.lines[1] = TimeText(time, "%d %b %H:%M UTC");
  }
  return words;
}

}  // namespace

std::vector<std::vector<TrackPoint>> ReadTracks(const std::string& scenario_yaml) {
  std::vector<std::vector<TrackPoint>> tracks;
  try {
    const YAML::Node disasters = YAML::Load(scenario_yaml)["disasters"];
    for (const YAML::Node& disaster : disasters) {
      tracks.emplace_back();
      for (const YAML::Node& point : disaster["track"]) {
        tracks.back().push_back(
            {point["step"].as<double>(), point["x"].as<double>(), point["y"].as<double>()});
      }
    }
  } catch (const YAML::Exception&) {
    tracks.clear();
  }
  return tracks;
}

TrackPoint TrackAt(const std::vector<TrackPoint>& track, double step) {
  const auto after =
      std::find_if(track.begin(), track.end(), [&](const TrackPoint& p) { return p.step >= step; });
  if (after == track.begin()) return track.front();
  if (after == track.end()) return track.back();
  const TrackPoint& before = *(after - 1);
  const double share = (step - before.step) / (after->step - before.step);
  return {step, before.x + share * (after->x - before.x), before.y + share * (after->y - before.y)};
}

TrackPoint ClosestApproach(const FarmSpec& spec, const std::vector<TrackPoint>& track,
                           double from_step) {
  TrackPoint best = TrackAt(track, from_step);
  best.step = from_step;
  double least = MetresFromFarm(spec, best.x, best.y);
  for (double step = from_step; step <= track.back().step; step += 1.0) {
    const TrackPoint at = TrackAt(track, step);
    const double metres = MetresFromFarm(spec, at.x, at.y);
    if (metres < least) {
      least = metres;
      best = {step, at.x, at.y};
    }
  }
  return best;
}

void DrawRegion(cv::Mat& image, cv::Rect room, const FarmSpec& spec, const FarmState& state,
                const std::vector<std::vector<TrackPoint>>& tracks, const Layout& layout,
                const Fonts& fonts) {
  const int row_px = layout.Px(15);
  const int side = std::min(room.width, room.height - 3 * row_px - layout.Px(4));
  if (side < layout.Px(kSmallestSide)) return;
  double farthest_m = 0.0;
  for (const auto& disaster : state.disasters) {
    if (!IsOutside(spec, disaster)) continue;
    farthest_m = std::max(farthest_m, MetresFromFarm(spec, disaster.x, disaster.y));
  }
  // The map itself shows what is nearer.
  if (!(farthest_m > spec.cell_size_m * std::hypot(spec.width, spec.height))) return;
  const double reach_m = Reach(1.12 * farthest_m);
  const cv::Rect place = cv::Rect(room.x + (room.width - side) / 2, room.y + row_px, side, side) &
                         cv::Rect({0, 0}, image.size());
  Inset inset{image(place),
              {(spec.width - 1) / 2.0, (spec.height - 1) / 2.0},
              side / 2.0 / reach_m * spec.cell_size_m};
  inset.image.setTo(Bgr(Mix(kSeaDeep, kPanel, 0.45)));
  const cv::Point2d middle(side / 2.0, side / 2.0);
  StrokeCircle(inset.image, middle, side / 4.0, Bgr(Mix(kSeaShallow, kPanel, 0.5)), 1);
  const std::string half = DistanceText(reach_m / 2.0);
  fonts.small.Draw(inset.image, half,
                   {cvRound(middle.x) - fonts.small.Width(half) / 2,
                    cvRound(middle.y - side / 4.0) - layout.Px(3)},
                   Bgr(kFaint));
  Words words;
  for (std::size_t i = 0; i < state.disasters.size(); ++i) {
    const DisasterState& disaster = state.disasters[i];
    if (!IsDrawn(disaster)) continue;
    DrawRings(inset, disaster);
    const bool is_recorded = state.observer < 0 && i < tracks.size() &&
                             Follows(tracks[i], disaster, static_cast<double>(state.step));
    if (is_recorded) {
      DrawTrack(inset, spec, tracks[i], static_cast<double>(state.step), layout);
      if (words.lines[0].empty()) words = ApproachWords(spec, state, tracks[i]);
    } else if (words.lines[0].empty() && IsOutside(spec, disaster)) {
      words.lines[0] = "centre " + DistanceText(MetresFromFarm(spec, disaster.x, disaster.y)) +
                       " " + PointFromFarm(spec, disaster.x, disaster.y);
    }
    FillCircle(inset.image, inset.At(disaster.x, disaster.y), 4.0 * layout.unit, Bgr(kInk));
    FillCircle(inset.image, inset.At(disaster.x, disaster.y), 3.0 * layout.unit,
               Bgr(GradeColor(disaster.grade)));
  }
  const double wide = std::max(4.0 * layout.unit, spec.width * inset.px_per_cell);
  const double tall = std::max(4.0 * layout.unit, spec.height * inset.px_per_cell);
  cv::rectangle(inset.image,
                cv::Rect(cvRound(middle.x - wide / 2.0), cvRound(middle.y - tall / 2.0),
                         cvRound(wide), cvRound(tall)),
                Bgr(kPaper), 1);
  cv::rectangle(image, place, Bgr(kRule), 1);
  fonts.bold.Draw(image, words.heading, {room.x, room.y + fonts.small.cap_height()}, Bgr(kFaint));
  int y = place.y + place.height + layout.Px(3) + fonts.small.cap_height();
  for (const std::string& line : words.lines) {
    fonts.small.Draw(image, fonts.small.Fit(line, room.width), {room.x, y}, Bgr(kWords));
    y += row_px;
  }
}

}  // namespace aquafarm_viz
