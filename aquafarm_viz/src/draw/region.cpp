// SPDX-License-Identifier: BSD-3-Clause
#include "draw/region.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/base/disaster_kinds.h"
#include "aquafarm_viz/draw/canvas.h"
#include "aquafarm_viz/scene/rings.h"
#include "draw/course.h"
#include "draw/free_space.h"
#include "draw/symbols.h"
#include "scene/nautical.h"
#include "scene/outlook_text.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DisasterState;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

// Min height of the inset [design units], if a course is known and if none is.
constexpr double kSmallestSide = 58.0;
constexpr double kSmallestWithoutCourse = 90.0;

bool IsOutside(const FarmSpec& spec, const DisasterState& disaster) {
  return IsDrawn(disaster) && !IsCentreInFarm(spec, disaster);
}

// Maps cells to the pixels of the inset.
struct Inset {
  cv::Mat image;
  cv::Point2d middle;  // middle of the part of the region that is shown [cells]
  double px_per_cell{};

  cv::Point2d At(double x, double y) const {
    return {image.cols / 2.0 + (x - middle.x) * px_per_cell,
            image.rows / 2.0 - (y - middle.y) * px_per_cell};
  }
};

using Outline = std::vector<cv::Point2d>;  // [pixels]

// Fills the land of the region and draws its coasts.
void DrawLand(Inset& inset, const FarmSpec& spec, const std::vector<CoastRing>& coast,
              const Style& style) {
  constexpr double kSmallest_m = 300e3;  // coasts are not exact enough for less
  const cv::Point2d size(inset.image.cols / inset.px_per_cell,
                         inset.image.rows / inset.px_per_cell);
  if (size.x * spec.cell_size_m < kSmallest_m) return;
  const cv::Rect2d shown(inset.middle - 0.5 * size, inset.middle + 0.5 * size);
  std::vector<std::vector<cv::Point>> rings;
  for (const CoastRing& ring : coast) {
    if ((ring.box & shown).empty()) continue;
    auto& fixed = rings.emplace_back();
    for (const cv::Point2d& corner : ring.corners) {
      const cv::Point at = Fixed(inset.At(corner.x, corner.y));
      if (fixed.empty() || at != fixed.back()) fixed.push_back(at);
    }
  }
  if (rings.empty()) return;
  cv::fillPoly(inset.image, rings, Bgr(Mix(style.land, style.panel, 0.55)), cv::LINE_8,
               kSubPixelBits);
  cv::polylines(inset.image, rings, /*isClosed=*/true, Bgr(Mix(style.sand, style.panel, 0.35)), 1,
                cv::LINE_AA, kSubPixelBits);
}

// Draws the rings of a disaster and adds their outlines to a list.
void DrawRings(Inset& inset, const DisasterState& disaster, const Style& style,
               std::vector<Outline>& outlines) {
  constexpr int kCorners = 96;
  for (std::size_t ring = disaster.radii.size(); ring-- > 0;) {
    const std::array<double, 4> radii = RingQuadrants(disaster, ring);
    Outline outline;
    std::vector<cv::Point> fixed;
    for (int i = 0; i < kCorners; ++i) {
      const double bearing = 2.0 * CV_PI * i / kCorners;
      const double radius = radii[std::size_t(i * 4 / kCorners)];
      outline.push_back(inset.At(disaster.x + radius * std::sin(bearing),
                                 disaster.y + radius * std::cos(bearing)));
      fixed.push_back(Fixed(outline.back()));
    }
    cv::polylines(inset.image, fixed, /*isClosed=*/true,
                  Bgr(style.Risk(Severity(disaster.risks[ring]))), 1, cv::LINE_AA, kSubPixelBits);
    outlines.push_back(std::move(outline));
  }
}

// The disaster that RegionText describes.
struct Subject {
  std::size_t disaster{};
  double danger{};      // steps until a ring covers a part of the farm; infinite: never
  TrackPoint nearest;   // point of the course that is nearest to the middle of the farm
  double nearest_m{};   // distance of `nearest` from the middle of the farm
  bool comes_nearer{};  // true: `nearest` is later than the present point
};

bool IsMoreUrgent(const Subject& a, const Subject& b) {
  if (a.danger != b.danger) return a.danger < b.danger;
  if (a.comes_nearer != b.comes_nearer) return a.comes_nearer;
  return a.nearest_m < b.nearest_m;
}

std::optional<Subject> MostUrgent(const FarmSpec& spec, const FarmState& state,
                                  const std::vector<Course>& courses) {
  std::optional<Subject> best;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    if (!IsDrawn(state.disasters[i])) continue;
    Subject one{i, StepsToFarm(spec, state.disasters[i], courses[i]),
                ClosestApproach(spec, courses[i].ahead, courses[i].ahead.front().step), 0.0, false};
    one.nearest_m = MetresFromFarm(spec, one.nearest.x, one.nearest.y);
    one.comes_nearer = one.nearest.step > courses[i].ahead.front().step;
    if (!best || IsMoreUrgent(one, *best)) best = one;
  }
  return best;
}

std::string PlaceText(const FarmSpec& spec, double x, double y) {
  return DistanceText(MetresFromFarm(spec, x, y)) + " " + PointFromFarm(spec, x, y);
}

// If the course is not known until the disaster ends, returns the time until which it is known. If
// it is, returns how the course is drawn; empty for an extrapolated course.
std::string SourceText(const FarmSpec& spec, const DisasterState& disaster, const Course& course) {
  const double known = course.known_until - course.ahead.front().step;
  if (known < disaster.steps_left) return "known until +" + AheadText(spec, known);
  if (course.kind == Course::Kind::kExtrapolated) return "";
  if (course.kind == Course::Kind::kPublished) return "dashed: forecast";
  return course.errors.empty() ? "dashed: course ahead" : "shaded: mean forecast error";
}

std::string Upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return std::toupper(letter); });
  return text;
}

// Returns the heading for the case that a ring reaches the farm in a later step. It contains the
// wind of the worst ring over the farm in that step: "NEAR GALE IN 2.0 h". If winds are not given,
// it is "REACHES THE RANCH IN 2.0 h". After the end of the known course, "IN ABOUT" replaces "IN".
std::string ReachesText(const FarmSpec& spec, const Course& course, double step) {
  const std::string wind = Upper(WindOverFarm(spec, course, TrackAt(course.ahead, step)));
  return (wind.empty() ? "REACHES THE RANCH" : wind) +
         (step > course.known_until ? " IN ABOUT " : " IN ") +
         AheadText(spec, step - course.ahead.front().step);
}

// Returns the words about a disaster whose course is not extrapolated: its closest approach and the
// rings that cover or reach the farm.
RegionWords CourseWords(const FarmSpec& spec, const FarmState& state, const Subject& subject,
                        const Course& course) {
  constexpr double kMoved_m = 1.0;
  const TrackPoint& now = course.ahead.front();
  const std::string centre = "centre " + PlaceText(spec, now.x, now.y);
  const double ahead_s = (subject.nearest.step - now.step) * spec.step_duration_s;
  const bool is_over = subject.danger == 0.0;
  const std::string over = Upper(OverFarmText(spec, course));
  if (ahead_s > 0.0) {
    const std::string nearest = "closest " + PlaceText(spec, subject.nearest.x, subject.nearest.y) +
                                " in " + HoursText(ahead_s);
    const auto then = static_cast<std::time_t>(state.world_time.sec + ahead_s);
    const std::string time =
        spec.has_start_time ? LocalTimeText(spec, then, "%d %b %H:%M ") + ZoneText(spec) : "";
    const std::string heading = is_over ? over
                                : std::isfinite(subject.danger)
                                    ? ReachesText(spec, course, now.step + subject.danger)
                                    : "COMES NEARER";
    if (subject.nearest.step > course.known_until) {
      return {heading, {nearest, SourceText(spec, state.disasters[subject.disaster], course)}};
    }
    return {heading, {nearest, time}};
  }
  if (is_over) return {over, {centre, ""}};
  if (std::isfinite(subject.danger)) {
    return {"REACHES THE RANCH", {"in " + AheadText(spec, subject.danger) + ", " + centre, ""}};
  }
  const TrackPoint& end = course.ahead.back();
  const bool leaves =
      MetresFromFarm(spec, end.x, end.y) > MetresFromFarm(spec, now.x, now.y) + kMoved_m;
  return {leaves ? "MOVING AWAY" : "STAYS", {centre, ""}};
}

}  // namespace

RegionWords RegionText(const FarmSpec& spec, const FarmState& state,
                       const std::vector<Course>& courses) {
  const std::optional<Subject> subject = MostUrgent(spec, state, courses);
  if (!subject) return {};
  const DisasterState& disaster = state.disasters[subject->disaster];
  const Course& course = courses[subject->disaster];
  const bool has_course = course.kind != Course::Kind::kExtrapolated;
  RegionWords words = has_course ? CourseWords(spec, state, *subject, course) : RegionWords{};
  words.is_urgent = subject->danger > 0.0 && std::isfinite(subject->danger);
  if (has_course) {
    std::string& last = words.lines[1];
    const std::string wind = WindText(subject->nearest);
    const bool is_later = subject->nearest.step > course.ahead.front().step;
    if (is_later && !wind.empty() && course.known_until >= subject->nearest.step) {
      last = last.empty() ? "wind " + wind + " then" : last + ", " + wind;
    } else if (last.empty()) {
      last = SourceText(spec, disaster, course);
    }
    return words;
  }
  // An extrapolated course can show that a ring will arrive, but not that no ring will.
  words.lines[0] =
      DisasterName(disaster.kind) + ", centre " + PlaceText(spec, disaster.x, disaster.y);
  words.lines[1] = subject->danger == 0.0 ? OverFarmText(spec, course)
                   : std::isfinite(subject->danger)
                       ? "reaches the ranch in about " + AheadText(spec, subject->danger)
                       : SourceText(spec, disaster, course);
  return words;
}

namespace {

// Returns the part of the region that the inset shows [cells]. It contains the farm and the centres
// of all disasters, and their rings with a radius of less than half of `farthest_m`. For each
// course that is not extrapolated, it also contains the closest approach and the points at less
// than half of `farthest_m` from the middle of the farm.
// @param farthest_m  distance of the farthest centre from the middle of the farm [m]
cv::Rect2d ShownPart(const FarmSpec& spec, const FarmState& state,
                     const std::vector<Course>& courses, double farthest_m) {
  constexpr double kSmallRing = 0.5;  // max radius of a ring that is shown whole [farthest_m]
  cv::Rect2d part(-0.5, -0.5, spec.width, spec.height);
  const auto add = [&part](double x, double y) {
    const cv::Point2d from(std::min(part.x, x), std::min(part.y, y));
    const cv::Point2d to(std::max(part.br().x, x), std::max(part.br().y, y));
    part = {from, to};
  };
  for (std::size_t i = 0; i < courses.size(); ++i) {
    if (!IsDrawn(state.disasters[i])) continue;
    const Track& ahead = courses[i].ahead;
    add(state.disasters[i].x, state.disasters[i].y);
    for (std::size_t ring = 0; ring < state.disasters[i].radii.size(); ++ring) {
      const auto radii = RingQuadrants(state.disasters[i], ring);
      const double radius = *std::max_element(radii.begin(), radii.end());
      if (radius * spec.cell_size_m >= kSmallRing * farthest_m) continue;
      add(state.disasters[i].x - radius, state.disasters[i].y - radius);
      add(state.disasters[i].x + radius, state.disasters[i].y + radius);
    }
    if (courses[i].kind == Course::Kind::kExtrapolated) continue;
    const TrackPoint nearest = ClosestApproach(spec, ahead, ahead.front().step);
    add(nearest.x, nearest.y);
    for (const TrackPoint& point : ahead) {
      if (MetresFromFarm(spec, point.x, point.y) < 0.5 * farthest_m) add(point.x, point.y);
    }
  }
  return part;
}

Inset MakeInset(const cv::Mat& image, const cv::Rect2d& part) {
  constexpr double kMargin = 1.3;
  const double px_per_cell = std::min(image.cols / part.width, image.rows / part.height) / kMargin;
  return {image, (part.tl() + part.br()) * 0.5, px_per_cell};
}

// Draws a scale bar in the free space that is nearest to the lower left corner.
void DrawScale(Inset& inset, const FarmSpec& spec, FreeSpace& space, const Layout& layout,
               const Fonts& fonts) {
  const double length_m =
      RoundLength(0.3 * inset.image.cols / inset.px_per_cell * spec.cell_size_m);
  const int length = cvRound(length_m / spec.cell_size_m * inset.px_per_cell);
  const std::string text = DistanceText(length_m);
  const int margin = layout.Px(5);  // left and right
  const cv::Size size(std::max(length, fonts.small.Width(text)) + 2 * margin,
                      fonts.small.cap_height() + layout.Px(6));
  const cv::Point2d corner(size.width / 2.0,
                           inset.image.rows - size.height / 2.0 - 6.0 * layout.unit);
  const auto place = space.Take(size, corner, inset.image.cols);
  if (!place) return;
  const Rgb color = layout.style->words;
  const int left = place->x + margin;
  DrawLabel(inset.image, fonts.small, text, {left, place->y}, layout);
  const int y = place->br().y - layout.Px(2);
  cv::rectangle(inset.image, cv::Rect(left, y, length, layout.Px(2)), Bgr(color), cv::FILLED);
}

// Returns the outline of the farm in the inset.
cv::Rect FarmPlace(const Inset& inset, const FarmSpec& spec, const Layout& layout) {
  constexpr double kMinSide = 9.0;  // [design units]
  const double wide = std::max(kMinSide * layout.unit, spec.width * inset.px_per_cell);
  const double tall = std::max(kMinSide * layout.unit, spec.height * inset.px_per_cell);
  const cv::Point2d middle = inset.At((spec.width - 1) / 2.0, (spec.height - 1) / 2.0);
  return {cvRound(middle.x - wide / 2.0), cvRound(middle.y - tall / 2.0), cvRound(wide),
          cvRound(tall)};
}

// Draws the outline of the farm over the courses, and the word "ranch" in it or next to it.
void DrawFarm(Inset& inset, cv::Rect farm, FreeSpace& space, const Layout& layout,
              const Fonts& fonts) {
  const cv::Point2d middle = cv::Point2d(farm.tl() + farm.br()) * 0.5;
  cv::rectangle(inset.image, farm, Bgr(layout.style->halo), layout.Px(4.0));
  cv::rectangle(inset.image, farm, Bgr(layout.style->label), layout.Px(1.6));
  const cv::Point gap(layout.Px(6), layout.Px(3));  // between the farm and labels
  space.Block(cv::Rect(farm.tl() - gap, farm.br() + gap));
  const std::string word = "ranch";
  const cv::Size size(fonts.small.Width(word), fonts.small.cap_height());
  const cv::Point2d aside(size.width / 2.0 + farm.width / 2.0 + 7.0 * layout.unit, 0.0);
  const double farthest = 12.0 * layout.unit;
  if (farm.width > size.width + 12.0 * layout.unit && farm.height > 3.0 * size.height) {
    const cv::Point2d half(size.width / 2.0, size.height / 2.0);
    return DrawLabel(inset.image, fonts.small, word, middle - half, layout);
  }
  auto place = space.Take(size, middle + aside, farthest);
  if (!place) place = space.Take(size, middle - aside, farthest);
  if (place) DrawLabel(inset.image, fonts.small, word, place->tl(), layout);
}

// Draws an arrow along the present motion of a disaster whose course is extrapolated.
void DrawMotion(cv::Mat& image, cv::Point2d centre, int bearing_deg, FreeSpace& space,
                const Layout& layout) {
  const double length = 18.0 * layout.unit;
  const Pose2 placing{centre, 6.0 * layout.unit + length / 2.0, double(bearing_deg)};
  const cv::Point2d middle = Place({0.0, 1.0}, placing);
  DrawArrow(image, middle, bearing_deg, length, Bgr(layout.style->halo), layout.Px(4));
  DrawArrow(image, middle, bearing_deg, length, Bgr(layout.style->label), layout.Px(2));
  space.Block(Around(middle, length / 2.0));
}

void DrawInset(Inset inset, const FarmSpec& spec, const FarmState& state,
               const std::vector<Course>& courses, const std::vector<CoastRing>& coast,
               const Layout& layout, const Fonts& fonts) {
  const Style& style = *layout.style;
  inset.image.setTo(Bgr(Mix(style.sea_south, style.panel, 0.4)));
  DrawLand(inset, spec, coast, style);
  FreeSpace space(inset.image.size());
  std::vector<Outline> rings;
  std::vector<CourseMark> marks;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    const DisasterState& disaster = state.disasters[i];
    if (!IsDrawn(disaster)) continue;
    DrawRings(inset, disaster, style, rings);
    const auto here = DrawCourse(
        inset.image, spec, courses[i], [&](double x, double y) { return inset.At(x, y); }, layout);
    marks.insert(marks.end(), here.begin(), here.end());
    const cv::Point2d at = inset.At(disaster.x, disaster.y);
    if (courses[i].kind == Course::Kind::kExtrapolated && disaster.speed > 0.0F) {
      DrawMotion(inset.image, at, disaster.heading_deg, space, layout);
    }
    FillCircle(inset.image, at, 5.0 * layout.unit, Bgr(style.halo));
    FillCircle(inset.image, at, 4.0 * layout.unit, Bgr(GradeColor(disaster.grade)));
    for (std::size_t j = 1; j < courses[i].ahead.size(); ++j) {
      const TrackPoint& from = courses[i].ahead[j - 1];
      const TrackPoint& to = courses[i].ahead[j];
      space.BlockLine(inset.At(from.x, from.y), inset.At(to.x, to.y), layout.Px(4));
    }
    space.Block(
        {cvRound(at.x) - layout.Px(6), cvRound(at.y) - layout.Px(6), layout.Px(12), layout.Px(12)});
  }
  const cv::Rect farm = FarmPlace(inset, spec, layout);
  const bool is_dot = farm.width < layout.Px(18) && farm.height < layout.Px(18);
  marks.erase(
      std::remove_if(marks.begin(), marks.end(),
                     [&](const CourseMark& mark) { return is_dot && farm.contains(mark.at); }),
      marks.end());  // a small outline of the farm hides these
  BlockMarks(marks, space, layout);
  DrawFarm(inset, farm, space, layout, fonts);
  for (const Outline& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      space.BlockLine(ring[i], ring[(i + 1) % ring.size()], 2);
    }
  }
  LabelMarks(inset.image, marks, space, layout, fonts);
  DrawScale(inset, spec, space, layout, fonts);
}

// Draws the inset with a frame in a part of the image.
void DrawFramed(cv::Mat& image, cv::Rect part, double farthest_m, const FarmSpec& spec,
                const FarmState& state, const std::vector<Course>& courses,
                const std::vector<CoastRing>& coast, const Layout& layout, const Fonts& fonts) {
  part &= cv::Rect({0, 0}, image.size());
  const cv::Rect2d region = ShownPart(spec, state, courses, farthest_m);
  DrawInset(MakeInset(image(part), region), spec, state, courses, coast, layout, fonts);
  cv::rectangle(image, part, Bgr(layout.style->rule), 1);
}

// Draws the lines of RegionWords below each other.
// @param at  left end of the base line of the first line
void DrawLines(cv::Mat& image, const RegionWords& words, cv::Point at, int width,
               const Layout& layout, const Fonts& fonts) {
  for (const std::string& line : words.lines) {
    fonts.small.Draw(image, fonts.small.Fit(line, width), at, Bgr(layout.style->words));
    at.y += layout.Px(15);
  }
}

// Returns the distance of the farthest disaster outside the farm from the middle of the farm [m]; 0
// if there is none.
double FarthestOutside(const FarmSpec& spec, const FarmState& state) {
  double farthest_m = 0.0;
  for (const auto& disaster : state.disasters) {
    if (!IsOutside(spec, disaster)) continue;
    farthest_m = std::max(farthest_m, MetresFromFarm(spec, disaster.x, disaster.y));
  }
  return farthest_m;
}

}  // namespace

bool HasRegion(const FarmSpec& spec, const FarmState& state) {
  return FarthestOutside(spec, state) > 0.0;
}

void DrawWideRegion(cv::Mat& image, const FarmSpec& spec, const FarmState& state,
                    const std::vector<Course>& courses, const std::vector<CoastRing>& coast,
                    const Layout& layout, const Fonts& fonts) {
  const double farthest_m = FarthestOutside(spec, state);
  if (!(farthest_m > 0.0)) return;
  const int width = image.cols * 9 / 20;
  DrawFramed(image, {0, 0, width, image.rows}, farthest_m, spec, state, courses, coast, layout,
             fonts);
  const RegionWords words = RegionText(spec, state, courses);
  const int left = width + layout.Px(8);
  const int words_px = image.cols - left - layout.Px(4);
  const int base = layout.Px(8) + fonts.small.cap_height();
  fonts.bold.Draw(image, fonts.bold.Fit(words.heading, words_px), {left, base},
                  Bgr(layout.style->words));
  DrawLines(image, words, {left, base + layout.Px(18)}, words_px, layout, fonts);
}

void DrawRegion(cv::Mat& image, cv::Rect room, const FarmSpec& spec, const FarmState& state,
                const std::vector<Course>& courses, const std::vector<CoastRing>& coast,
                const Layout& layout, const Fonts& fonts) {
  const int row_px = layout.Px(15);
  if (room.height < 3 * row_px) return;
  const double farthest_m = FarthestOutside(spec, state);
  const RegionWords words = RegionText(spec, state, courses);
  const bool has_course = words.heading != RegionWords().heading;
  // If there is no space for both the lines and the inset, the lines are left out, unless they
  // describe a course that is not extrapolated, or the arrival of a ring.
  const int smallest = layout.Px(has_course ? kSmallestSide : kSmallestWithoutCourse);
  const int for_inset = room.height - row_px - layout.Px(4);
  const bool has_lines = has_course || words.is_urgent || for_inset - 2 * row_px >= smallest;
  // The inset is lower if the course is extrapolated, because it then contains little.
  const int max_side = has_course ? room.width : room.width * 2 / 3;
  const int side = std::min(max_side, for_inset - (has_lines ? 2 * row_px : 0));
  // The inset is needed only for centres outside the farm.
  const bool is_drawn = farthest_m > 0.0 && side >= smallest;
  if (!is_drawn && !has_course) return;
  fonts.bold.Draw(image, fonts.bold.Fit(words.heading, room.width),
                  {room.x, room.y + fonts.small.cap_height()},
                  Bgr(has_course ? layout.style->words : layout.style->faint));
  int y = room.y + row_px;
  if (is_drawn) {
    // The inset is as wide as `room`, so that labels have space next to the course.
    DrawFramed(image, {room.x, y, room.width, side}, farthest_m, spec, state, courses, coast,
               layout, fonts);
    y += side;
  }
  if (!has_lines) return;
  y += layout.Px(3) + fonts.small.cap_height();
  DrawLines(image, words, {room.x, y}, room.width, layout, fonts);
}

}  // namespace aquafarm_viz
