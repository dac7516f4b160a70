// SPDX-License-Identifier: BSD-3-Clause
#include "draw/course.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "draw/free_space.h"
#include "draw/symbols.h"
#include "scene/nautical.h"

namespace aquafarm_viz {
namespace {

constexpr double kFar_px = 1.0e5;  // lines to points farther away are not drawn
constexpr double kMinMark = 24.0;  // min mean distance of two marks [design units]

bool IsNear(cv::Point2d at) { return std::abs(at.x) < kFar_px && std::abs(at.y) < kFar_px; }

// Clips a line to a picture. Returns false if no part of it is inside, or if an end is farther away
// than kFar_px.
bool Clip(const cv::Mat& image, cv::Point2d& from, cv::Point2d& to) {
  if (!IsNear(from) || !IsNear(to)) return false;
  cv::Point a(from);
  cv::Point b(to);
  const cv::Rect frame(-1, -1, image.cols + 2, image.rows + 2);
  if (!cv::clipLine(frame, a, b)) return false;
  if (a != cv::Point(from)) from = a;
  if (b != cv::Point(to)) to = b;
  return true;
}

void DrawPast(cv::Mat& image, const Track& past, const ToPixel& to_pixel, const Layout& layout) {
  for (std::size_t i = 1; i < past.size(); ++i) {
    cv::Point2d from = to_pixel(past[i - 1].x, past[i - 1].y);
    cv::Point2d to = to_pixel(past[i].x, past[i].y);
    if (!Clip(image, from, to)) continue;
    DrawLine(image, from, to, Bgr(layout.style->faint), layout.Px(1.6));
  }
}

void DrawDashes(cv::Mat& image, const Track& ahead, const ToPixel& to_pixel, const Layout& layout) {
  const double dash = 5.0 * layout.unit;
  for (std::size_t i = 1; i < ahead.size(); ++i) {
    cv::Point2d from = to_pixel(ahead[i - 1].x, ahead[i - 1].y);
    cv::Point2d to = to_pixel(ahead[i].x, ahead[i].y);
    if (!Clip(image, from, to)) continue;
    const double length = cv::norm(to - from);
    const auto at = [&](double px) { return from + (to - from) * (px / length); };
    for (double px = 0.0; px < length; px += 2.0 * dash) {
      const double end = std::min(length, px + dash);
      DrawLine(image, at(px), at(end), Bgr(layout.style->halo), layout.Px(3));
      DrawLine(image, at(px), at(end), Bgr(layout.style->label), layout.Px(1.6));
    }
  }
}

// Tints the area of the mean forecast error around the course ahead.
void DrawCone(cv::Mat& image, const Course& course, const ToPixel& to_pixel, const Layout& layout) {
  if (course.errors.empty()) return;
  constexpr int kSamples = 12;  // circles between two points
  const double px_per_cell = cv::norm(to_pixel(1.0, 0.0) - to_pixel(0.0, 0.0));
  cv::Mat1b inside(image.size(), std::uint8_t{0});
  for (std::size_t i = 1; i < course.ahead.size(); ++i) {
    const TrackPoint& a = course.ahead[i - 1];
    const TrackPoint& b = course.ahead[i];
    for (int sample = 0; sample <= kSamples; ++sample) {
      const double share = double(sample) / kSamples;
      const cv::Point2d at = to_pixel(a.x + share * (b.x - a.x), a.y + share * (b.y - a.y));
      const double radius =
          px_per_cell * (course.errors[i - 1] + share * (course.errors[i] - course.errors[i - 1]));
      if (!IsNear(at) || radius > kFar_px / 10.0) continue;
      cv::circle(inside, cv::Point(at), cvRound(radius), 255, cv::FILLED);
    }
  }
  cv::Mat tinted;
  cv::addWeighted(image, 0.78, cv::Mat(image.size(), CV_8UC3, Bgr(layout.style->label)), 0.22, 0.0,
                  tinted);
  tinted.copyTo(image, inside);
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(inside, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  cv::drawContours(image, outlines, -1, Bgr(layout.style->label), 1, cv::LINE_AA);
}

// Returns the time between two marks [h]: the shortest of some round times at which marks are at
// least kMinMark apart on average; 24 if there is none.
double MarkHours(const aquafarm_msgs::FarmSpec& spec, const Track& ahead, const ToPixel& to_pixel,
                 const Layout& layout) {
  double length = 0.0;
  for (std::size_t i = 1; i < ahead.size(); ++i) {
    length += cv::norm(to_pixel(ahead[i].x, ahead[i].y) - to_pixel(ahead[i - 1].x, ahead[i - 1].y));
  }
  const double hours =
      (ahead.back().step - ahead.front().step) * std::max(1.0, spec.step_duration_s) / 3600.0;
  if (!(length > 0.0) || !(hours > 0.0) || !std::isfinite(length)) return 24.0;
  for (const double each : {0.5, 1.0, 2.0, 3.0, 6.0, 12.0}) {
    if (length / hours * each >= kMinMark * layout.unit) return each;
  }
  return 24.0;
}

}  // namespace

std::vector<CourseMark> DrawCourse(cv::Mat& image, const aquafarm_msgs::FarmSpec& spec,
                                   const Course& course, const ToPixel& to_pixel,
                                   const Layout& layout) {
  constexpr std::size_t kMaxMarks = 64;
  std::vector<CourseMark> marks;
  if (course.kind == Course::Kind::kExtrapolated || course.ahead.size() < 2) return marks;
  DrawCone(image, course, to_pixel, layout);
  DrawPast(image, course.past, to_pixel, layout);
  DrawDashes(image, course.ahead, to_pixel, layout);
  const double hours = MarkHours(spec, course.ahead, to_pixel, layout);
  const double steps = hours * 3600.0 / std::max(1.0, spec.step_duration_s);
  const double now = course.ahead.front().step;
  const int rim = layout.Px(6);  // marks in this rim would be cut off at the edge
  const cv::Rect inside(rim, rim, image.cols - 2 * rim, image.rows - 2 * rim);
  for (std::size_t i = 1; i <= kMaxMarks && now + double(i) * steps <= course.ahead.back().step;
       ++i) {
    const TrackPoint point = TrackAt(course.ahead, now + double(i) * steps);
    const cv::Point2d at = to_pixel(point.x, point.y);
    if (!IsNear(at) || !inside.contains(cv::Point(at))) continue;
    FillCircle(image, at, 4.2 * layout.unit, Bgr(layout.style->halo));
    FillCircle(image, at, 3.0 * layout.unit, Bgr(layout.style->label));
    const double lead = double(i) * hours;
    const std::string text = "+" + Number(lead, lead == std::floor(lead) ? 0 : 1) + " h";
    const std::string wind = WindText(point);
    marks.push_back({at, text, wind.empty() ? "" : text + " " + wind});
  }
  return marks;
}

void BlockMarks(const std::vector<CourseMark>& marks, FreeSpace& space, const Layout& layout) {
  const int half = layout.Px(4);
  for (const CourseMark& mark : marks) {
    space.Block({cvRound(mark.at.x) - half, cvRound(mark.at.y) - half, 2 * half, 2 * half});
  }
}

namespace {

// Draws a line from a mark to its label if the label is not next to it.
void DrawMarkLeader(cv::Mat& image, cv::Point2d mark, cv::Rect label, const Layout& layout) {
  const cv::Point2d to = NearestIn(label, mark);
  if (cv::norm(to - mark) < 8.0 * layout.unit) return;
  DrawLine(image, mark, to, Bgr(layout.style->label), layout.Px(1));
}

}  // namespace

void LabelMarks(cv::Mat& image, const std::vector<CourseMark>& marks, FreeSpace& space,
                const Layout& layout, const Fonts& fonts) {
  BlockMarks(marks, space, layout);
  // Places a label to the right or left of its mark, because the course may continue above and
  // below.
  const auto take_near = [&](FreeSpace& from, const CourseMark& mark, const std::string& text) {
    const cv::Size size(fonts.small.Width(text), fonts.small.cap_height());
    const cv::Point2d aside(size.width / 2.0 + 9.0 * layout.unit, 0.0);
    auto place = from.Take(size, mark.at + aside, 6.0 * layout.unit);
    if (!place) place = from.Take(size, mark.at - aside, 6.0 * layout.unit);
    return place;
  };
  FreeSpace trial = space;  // the longer text is used only if it fits at every mark
  const bool are_long = std::all_of(marks.begin(), marks.end(), [&](const CourseMark& mark) {
    return !mark.longer.empty() && take_near(trial, mark, mark.longer);
  });
  for (const CourseMark& mark : marks) {
    const std::string& text = are_long ? mark.longer : mark.text;
    auto place = take_near(space, mark, text);
    if (!place) {
      const cv::Size size(fonts.small.Width(text), fonts.small.cap_height());
      place = space.Take(size, mark.at, 36.0 * layout.unit + size.width / 2.0);
      if (place) DrawMarkLeader(image, mark.at, *place, layout);
    }
    if (place) DrawLabel(image, fonts.small, text, place->tl(), layout);
  }
}

}  // namespace aquafarm_viz
