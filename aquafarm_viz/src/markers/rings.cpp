// SPDX-License-Identifier: BSD-3-Clause
#include "markers/rings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/base/palette.h"
#include "aquafarm_viz/scene/rings.h"
#include "markers/maker.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DisasterState;
using aquafarm_msgs::FarmSpec;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;
using Points = std::vector<geometry_msgs::Point>;

constexpr double kLinesAcross = 18.0;  // number of lines along the longer side of a farm

// The borders of the farm relative to the centre of a disaster [m].
struct Frame {
  double west, south, east, north;
};

Frame FrameAround(const Maker& maker, const FarmSpec& spec, const DisasterState& disaster) {
  const double cell_m = maker.cell_m();
  return {(-0.5 - double(disaster.x)) * cell_m, (-0.5 - double(disaster.y)) * cell_m,
          (spec.width - 0.5 - double(disaster.x)) * cell_m,
          (spec.height - 0.5 - double(disaster.y)) * cell_m};
}

// Returns the part of a convex polygon on which `inside` is not negative. `inside` must be linear.
template <typename Inside>
Points Cut(const Points& polygon, Inside inside) {
  Points kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& a = polygon[i];
    const auto& b = polygon[(i + 1) % polygon.size()];
    const double from = inside(a);
    const double to = inside(b);
    if (from >= 0.0) kept.push_back(a);
    if ((from >= 0.0) == (to >= 0.0)) continue;
    const double share = from / (from - to);
    kept.push_back(Point(a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)));
  }
  return kept;
}

// Replaces triangles with their parts on the farm.
void ClipTriangles(Points& points, const Frame& farm) {
  Points clipped;
  clipped.reserve(points.size());
  for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
    Points part{points[i], points[i + 1], points[i + 2]};
    part = Cut(part, [&farm](const auto& at) { return at.x - farm.west; });
    part = Cut(part, [&farm](const auto& at) { return farm.east - at.x; });
    part = Cut(part, [&farm](const auto& at) { return at.y - farm.south; });
    part = Cut(part, [&farm](const auto& at) { return farm.north - at.y; });
    for (std::size_t j = 2; j < part.size(); ++j) {
      clipped.insert(clipped.end(), {part[0], part[j - 1], part[j]});
    }
  }
  points = std::move(clipped);
}

QuadrantRadii RingMetres(const Maker& maker, const DisasterState& disaster, std::size_t ring) {
  QuadrantRadii radii = RingQuadrants(disaster, ring);
  for (double& radius : radii) radius *= maker.cell_m();
  return radii;
}

// Returns the band between the next smaller ring and this one, so that the colours of rings do not
// overlap.
Marker RingBand(const Maker& maker, const DisasterState& disaster, int ring) {
  const auto i = static_cast<std::size_t>(ring);
  Marker band = maker.Make("ring", disaster.id * kMaxRings + ring, Marker::TRIANGLE_LIST,
                           kRingLayer, disaster.x, disaster.y);
  const double severity = Severity(disaster.risks[i]);
  band.color = Color(SeverityColor(severity), 0.10 + 0.18 * severity);
  AddBand(band, ring == 0 ? QuadrantRadii{} : RingMetres(maker, disaster, i - 1),
          RingMetres(maker, disaster, i));
  return band;
}

// Returns the edge of a ring as a narrow band, because the lines of rviz partly vanish in the
// top-down view.
Marker RingEdge(const Maker& maker, const DisasterState& disaster, int ring) {
  const auto i = static_cast<std::size_t>(ring);
  Marker edge = maker.Make("ring_edge", disaster.id * kMaxRings + ring, Marker::TRIANGLE_LIST,
                           kRockLayer, disaster.x, disaster.y);
  edge.color = Color(SeverityColor(Severity(disaster.risks[i])));
  const QuadrantRadii outer = RingMetres(maker, disaster, i);
  QuadrantRadii inner = outer;
  for (double& radius : inner) radius = std::max(0.0, radius - 0.12 * maker.thing_m());
  AddBand(edge, inner, outer);
  return edge;
}

// The lines of a kind's pattern, as in pictures.
struct Pattern {
  std::vector<std::pair<double, double>> directions;  // east, north; of length 1
  double wave{};                                      // amplitude of waves [line spacings]
  bool is_dotted{};
};

Pattern PatternOf(std::uint8_t kind) {
  const double half = std::sqrt(0.5);
  switch (kind) {
    case DisasterState::STORM_SURGE:
      return {{{1.0, 0.0}}};
    case DisasterState::WAVE:
      return {{{1.0, 0.0}}, 0.18};
    case DisasterState::RED_TIDE:
      return {{{1.0, 0.0}}, 0.0, true};
    case DisasterState::OIL_SPILL:
      return {{{half, half}, {half, -half}}};
    case DisasterState::CHEMICAL_SPILL:
      return {{{0.0, 1.0}}};
    default:
      return {{{half, half}}};
  }
}

// Draws the pattern of a disaster on the part of the farm that its rings cover.
class PatternPainter {
 public:
  PatternPainter(const Maker& maker, const FarmSpec& spec, const DisasterState& disaster)
      : farm_(FrameAround(maker, spec, disaster)),
        period_(std::max(spec.width, spec.height) * maker.cell_m() / kLinesAcross),
        marker_(maker.Make("ring_pattern", disaster.id, Marker::TRIANGLE_LIST, kRingLayer,
                           disaster.x, disaster.y)) {
    marker_.pose.position.z += 0.5 * maker.layer_m();  // above the bands
    marker_.color = Color(kPaper);  // rviz multiplies its alpha with that of each corner
    for (std::size_t i = 0; i < disaster.radii.size(); ++i) {
      rings_.push_back(RingMetres(maker, disaster, i));
      const double severity = Severity(disaster.risks[i]);
      colors_.push_back(Color(SeverityColor(severity), 0.55));
      half_widths_.push_back(period_ * (0.011 + 0.014 * severity));
    }
  }

  Marker Draw(const Pattern& pattern) {
    for (const auto& [east, north] : pattern.directions) DrawLines(pattern, east, north);
    return marker_;
  }

 private:
  static constexpr int kSamples = 16;  // samples of a line per period
  static constexpr int kNone = -1;

  // Returns the innermost ring over a point [m]; kNone if there is none or the point is off the
  // farm.
  int RingAt(double x, double y) const {
    if (x < farm_.west || x > farm_.east || y < farm_.south || y > farm_.north) return kNone;
    const std::size_t quadrant = y >= 0.0 ? (x >= 0.0 ? 0U : 3U) : (x >= 0.0 ? 1U : 2U);
    for (std::size_t i = 0; i < rings_.size(); ++i) {
      if (std::hypot(x, y) <= rings_[i][quadrant]) return static_cast<int>(i);
    }
    return kNone;
  }

  void AddStroke(geometry_msgs::Point from, geometry_msgs::Point to, int ring) {
    const auto i = static_cast<std::size_t>(ring);
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    if (!(length > 0.0)) return;
    const double aside_x = -(to.y - from.y) / length * half_widths_[i];
    const double aside_y = (to.x - from.x) / length * half_widths_[i];
    const auto a = Point(from.x + aside_x, from.y + aside_y);
    const auto b = Point(to.x + aside_x, to.y + aside_y);
    const auto c = Point(to.x - aside_x, to.y - aside_y);
    const auto d = Point(from.x - aside_x, from.y - aside_y);
    marker_.points.insert(marker_.points.end(), {a, c, b, a, d, c});  // anticlockwise
    marker_.colors.insert(marker_.colors.end(), 6, colors_[i]);
  }

  void DrawLines(const Pattern& pattern, double east, double north) {
    // The range of the farm along and across the lines.
    std::array<double, 2> along{1e300, -1e300};
    std::array<double, 2> across{1e300, -1e300};
    for (const double x : {farm_.west, farm_.east}) {
      for (const double y : {farm_.south, farm_.north}) {
        const double t = x * east + y * north;
        const double s = y * east - x * north;
        along = {std::min(along[0], t), std::max(along[1], t)};
        across = {std::min(across[0], s), std::max(across[1], s)};
      }
    }
    // Lines start at the border of the farm, so that they do not move with the disaster.
    const double first = across[0] + 0.5 * period_;
    for (int line = 0; first + line * period_ < across[1]; ++line) {
      const double s = first + line * period_;
      const auto at = [&](double t) {
        const double up = s + pattern.wave * period_ * std::sin(CV_PI * (t - along[0]) / period_);
        return Point(t * east - up * north, t * north + up * east);
      };
      if (pattern.is_dotted) {
        DrawDots(at, along, line % 2 == 0 ? 0.5 : 1.0);
      } else {
        DrawLine(at, along, pattern.wave > 0.0);
      }
    }
  }

  template <typename At>
  void DrawDots(const At& at, const std::array<double, 2>& along, double shift) {
    for (double t = along[0] + shift * period_; t < along[1]; t += period_) {
      const auto middle = at(t);
      const int ring = RingAt(middle.x, middle.y);
      if (ring == kNone) continue;
      const double half = 1.8 * half_widths_[static_cast<std::size_t>(ring)];
      AddStroke(at(t - half), at(t + half), ring);
    }
  }

  // Draws a line in pieces, each of which is in one ring. The pieces of a curved line are short.
  template <typename At>
  void DrawLine(const At& at, const std::array<double, 2>& along, bool is_curved) {
    const double step = period_ / kSamples;
    auto start = at(along[0]);
    int ring = kNone;
    for (int i = 0; along[0] + i * step < along[1]; ++i) {
      const auto from = at(along[0] + i * step);
      const auto middle = at(along[0] + (i + 0.5) * step);
      const int now = RingAt(middle.x, middle.y);
      if (now == ring && !is_curved) continue;
      if (ring != kNone) AddStroke(start, from, ring);
      start = from;
      ring = now;
    }
    if (ring != kNone) AddStroke(start, at(along[1]), ring);
  }

  Frame farm_;
  double period_;  // distance between lines [m]
  Marker marker_;
  std::vector<QuadrantRadii> rings_;  // [m], the innermost first
  std::vector<std_msgs::ColorRGBA> colors_;
  std::vector<double> half_widths_;  // [m]
};

}  // namespace

void AddRings(MarkerArray& array, const Maker& maker, const FarmSpec& spec,
              const DisasterState& disaster, bool is_drawn) {
  const auto add = [&](Marker marker) {
    array.markers.push_back(marker.points.empty() ? maker.Delete(marker.ns.c_str(), marker.id)
                                                  : std::move(marker));
  };
  const Frame farm = FrameAround(maker, spec, disaster);
  for (int ring = 0; ring < kMaxRings; ++ring) {
    const auto i = static_cast<std::size_t>(ring);
    if (!is_drawn || i >= disaster.radii.size() || !(disaster.radii[i] > 0.0F)) {
      array.markers.push_back(maker.Delete("ring", disaster.id * kMaxRings + ring));
      array.markers.push_back(maker.Delete("ring_edge", disaster.id * kMaxRings + ring));
      continue;
    }
    for (Marker marker : {RingBand(maker, disaster, ring), RingEdge(maker, disaster, ring)}) {
      ClipTriangles(marker.points, farm);
      add(std::move(marker));
    }
  }
  if (!is_drawn) return array.markers.push_back(maker.Delete("ring_pattern", disaster.id));
  add(PatternPainter(maker, spec, disaster).Draw(PatternOf(disaster.kind)));
}

}  // namespace aquafarm_viz
