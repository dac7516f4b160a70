// SPDX-License-Identifier: BSD-3-Clause
#include "draw/paths.h"

#include <algorithm>
#include <cmath>

#include "draw/symbols.h"

namespace aquafarm_viz {

using aquafarm_msgs::FarmState;

namespace {

constexpr double kBetweenHeads = 50.0;  // min distance between arrowheads [design units]

// Returns the colour of a part of a ship's path. If there is only one ship, its path is green,
// because no risk is green. If there are several ships, each path has the colour of its ship, mixed
// with the colour of labels. Older parts have a colour that is closer to that of the sea. Paths of
// several ships fade less, so that their colours stay different.
// @param age  0: now, 1: the oldest part
Rgb PathColor(const FarmState& state, std::int32_t ship, double age, const Style& style) {
  if (state.ships.size() == 1) return Mix(style.good, style.sea_south, 0.4 * age);
  return Mix(Mix(style.label, ShipColor(ship), 0.6), style.sea_south, 0.25 * age);
}

// Draws one move of a path: a line or, on a dashed path, a shorter line as one dash.
// @param casing  added to the width on each side [design units]
void DrawMoved(cv::Mat& map, cv::Point2d from, cv::Point2d to, bool is_dashed,
               const cv::Scalar& color, const Layout& layout, double casing = 0.0) {
  const cv::Point2d gap = (is_dashed ? 0.22 : 0.0) * (to - from);
  DrawLine(map, from + gap, to - gap, color, layout.Px((is_dashed ? 1.8 : 3.2) + 2.0 * casing));
}

// Returns the unit vector to the right of a direction on the map; {0, 0} if `along` is {0, 0}.
cv::Point2d RightOf(cv::Point2d along) {
  const double length = cv::norm(along);
  return length > 0.0 ? cv::Point2d(-along.y, along.x) / length : cv::Point2d();
}

// Returns the corner of a path at the point `at`. The path runs `aside` pixels to the right of its
// points, and the corner is where the lines of two successive moves meet. After a sharp turn (more
// than about 100 degrees) they meet far away; the result is then the end of the line of `own`.
// @param own, other  RightOf the two moves that meet at the point
cv::Point2d Turn(cv::Point2d at, cv::Point2d own, cv::Point2d other, double aside) {
  const double cosine = own.dot(other);
  return cosine < -0.2 ? at + aside * own : at + (own + other) * (aside / (1.0 + cosine));
}

// Returns the distance of a ship's path from the centres of the cells [pixels], so that an outward
// and a return path on the same cells are both visible. If there are several ships, there are three
// distances, by id, so that two paths on the same cells are usually both visible.
double AsideOf(std::int32_t ship, bool are_several, const Layout& layout) {
  const double units = are_several ? 2.2 + 2.4 * (ship % 3) : 3.2;
  return std::min(units * layout.unit, 0.3 * layout.view.cell_px());
}

}  // namespace

std::size_t DrawnFrom(const FarmState& state, const ShipTrail& way) {
  if (state.ships.size() < 2 || state.terminated || state.truncated) return 0;
  for (std::size_t i = way.places.size(); i-- > 2;) {
    if (way.loaded[i - 1] && !way.loaded[i]) return i - 1;
  }
  return 0;
}

std::vector<Moved> MovesOf(const FarmState& state, std::int32_t ship, const ShipTrail& way,
                           const Layout& layout) {
  const double aside = AsideOf(ship, state.ships.size() > 1, layout);
  const std::size_t count = way.places.size();
  const std::size_t first = DrawnFrom(state, way) + 1;
  const auto point = [&](std::size_t i) {
    return layout.view.ToPixel(way.places[i].x, way.places[i].y);
  };
  std::vector<Moved> moves;
  for (std::size_t i = first; i < count; ++i) {
    if (Trail::IsGap(way.places[i - 1], way.places[i])) continue;
    const cv::Point2d own = RightOf(point(i) - point(i - 1));
    const bool has_before = i > first && !Trail::IsGap(way.places[i - 2], way.places[i - 1]);
    const bool has_after = i + 1 < count && !Trail::IsGap(way.places[i], way.places[i + 1]);
    const cv::Point2d before = has_before ? RightOf(point(i - 1) - point(i - 2)) : own;
    const cv::Point2d after = has_after ? RightOf(point(i + 1) - point(i)) : own;
    const cv::Point2d from = Turn(point(i - 1), own, before, aside);
    const double age = 1.0 - double(i - first + 1) / double(count - first + 1);
    const bool is_sharp = has_before && cv::norm(moves.back().to - from) > 0.5;
    if (is_sharp) moves.push_back({moves.back().to, from, false, age});  // around it
    moves.push_back({from, Turn(point(i), own, after, aside), !way.loaded[i], age});
  }
  return moves;
}

namespace {

// Draws an arrowhead between two points of a path, in the direction of the motion.
void DrawDirection(cv::Mat& map, cv::Point2d from, cv::Point2d to, const cv::Scalar& color,
                   const Layout& layout) {
  static const std::vector<cv::Point2f> kHead{{0.0F, 1.0F}, {-0.9F, -0.8F}, {0.9F, -0.8F}};
  const cv::Point2d way = to - from;
  const double bearing_deg = std::atan2(way.x, -way.y) * 180.0 / CV_PI;
  FillShape(map, kHead, {(from + to) / 2.0, double(layout.Px(5.5)), bearing_deg}, color);
}

}  // namespace

void DrawPathSample(cv::Mat& image, cv::Point2d from, cv::Point2d to, bool is_dashed,
                    const FarmState& state, const Layout& layout) {
  const Style& style = *layout.style;
  const cv::Scalar color =
      Bgr(state.ships.size() > 1 ? style.words : PathColor(state, 0, 0.3, style));
  const cv::Point2d middle = (from + to) * 0.5;
  DrawMoved(image, from, middle, is_dashed, color, layout);
  DrawMoved(image, middle, to, is_dashed, color, layout);
}

void DrawPaths(cv::Mat& map, const FarmState& state, const Trail& paths, const Layout& layout) {
  constexpr double kCasing = 1.2;  // added to the width of a path on each side [design units]
  const cv::Scalar casing = Bgr(Mix(layout.style->halo, layout.style->sea_south, 0.35));
  for (const auto& ship : state.ships) {
    const ShipTrail* way = ship.visible ? paths.Find(ship.id) : nullptr;
    if (way == nullptr) continue;
    const std::vector<Moved> moves = MovesOf(state, ship.id, *way, layout);
    // A casing below the path makes it visible on the colours of values and on other paths.
    for (const Moved& move : moves) {
      DrawMoved(map, move.from, move.to, move.is_dashed, casing, layout, kCasing);
    }
    double since_head_px = 0.0;
    for (const Moved& move : moves) {
      const cv::Scalar color = Bgr(PathColor(state, ship.id, move.age, *layout.style));
      DrawMoved(map, move.from, move.to, move.is_dashed, color, layout);
      since_head_px += cv::norm(move.to - move.from);
      if (since_head_px < kBetweenHeads * layout.unit) continue;
      DrawDirection(map, move.from, move.to, color, layout);
      since_head_px = 0.0;
    }
  }
}

}  // namespace aquafarm_viz
