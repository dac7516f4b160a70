// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>

#include "aquafarm_viz/scene/rings.h"
#include "draw/symbols.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DisasterState;
using aquafarm_msgs::FarmState;

bool IsDrawn(const DisasterState& disaster) { return disaster.known && disaster.steps_left > 0; }

// A shade is a byte: 0 no risk, kFaintest at a risk of -5, 255 at -20. Values between 0 and
// kFaintest are partly covered pixels of the outermost edge.
constexpr double kFaintest = 55.0;
constexpr double kShareFaintest = 0.38;
constexpr double kShareWorst = 0.68;

double Shade(double risk) { return kFaintest + (255.0 - kFaintest) * Severity(risk); }

// Premultiplied colour of a shade and the fraction of the background that it keeps, both times 256.
struct ShadeEntry {
  std::array<std::uint16_t, 3> paint;
  std::uint16_t rest;
};

const std::array<ShadeEntry, 256>& ShadeTable() {
  static const std::array<ShadeEntry, 256> kTable = [] {
    std::array<ShadeEntry, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
      const double severity = std::max(0.0, (double(i) - kFaintest) / (255.0 - kFaintest));
      const double share = double(i) < kFaintest
                               ? kShareFaintest * double(i) / kFaintest
                               : kShareFaintest + (kShareWorst - kShareFaintest) * severity;
      const cv::Scalar color = Bgr(SeverityColor(severity));
      for (std::size_t c = 0; c < 3; ++c) {
        table[i].paint[c] = static_cast<std::uint16_t>(cvRound(color[int(c)] * share * 256.0));
      }
      table[i].rest = static_cast<std::uint16_t>(cvRound((1.0 - share) * 256.0));
    }
    return table;
  }();
  return kTable;
}

// The rings of a disaster in pixels of the map.
struct Rings {
  cv::Point2d centre;
  std::vector<std::array<float, 4>> radii_px;  // NE, SE, SW, NW
  std::vector<float> shade_steps;              // shade of a ring minus that of the next outer ring
};

float Largest(const std::array<float, 4>& radii) {
  return *std::max_element(radii.begin(), radii.end());
}

Rings InPixels(const DisasterState& disaster, const Layout& layout) {
  Rings rings{layout.view.ToPixel(disaster.x, disaster.y), {}, {}};
  for (std::size_t i = 0; i < disaster.radii.size(); ++i) {
    std::array<float, 4> radii_px{};
    const auto cells = RingQuadrants(disaster, i);
    for (std::size_t q = 0; q < cells.size(); ++q) {
      radii_px[q] = static_cast<float>(cells[q] * layout.view.cell_px());
    }
    rings.radii_px.push_back(radii_px);
    const double outer = i + 1 < disaster.risks.size() ? Shade(disaster.risks[i + 1]) : 0.0;
    rings.shade_steps.push_back(static_cast<float>(Shade(disaster.risks[i]) - outer));
  }
  return rings;
}

// Adds one disaster to a row: updates the worst shade and the coverage by ring edges of each pixel.
void ShadeRow(const Rings& rings, int row, std::vector<float>& shades, std::vector<float>& edges,
              std::vector<float>& scratch) {
  const auto north = static_cast<float>(row - rings.centre.y);
  const auto east = static_cast<float>(rings.centre.x);
  const float reach = rings.radii_px.empty() ? 0.0F : Largest(rings.radii_px.back()) + 1.0F;
  if (std::abs(north) > reach) return;
  const float half = std::sqrt(reach * reach - north * north);
  const auto columns = static_cast<int>(shades.size());
  const int from =
      std::clamp(static_cast<int>(std::floor(std::clamp(east - half, -1e6F, 1e6F))), 0, columns);
  const int to = std::clamp(static_cast<int>(std::ceil(std::clamp(east + half, -1e6F, 1e6F))) + 1,
                            from, columns);
  float* shade = scratch.data();
  std::fill(shade + from, shade + to, 0.0F);
  for (std::size_t ring = 0; ring < rings.radii_px.size(); ++ring) {
    const std::array<float, 4>& radii = rings.radii_px[ring];
    const bool is_north = north < 0.0F;  // row indices increase downwards
    const float to_east = radii[is_north ? 0 : 1];
    const float to_west = radii[is_north ? 3 : 2];
    const float step = rings.shade_steps[ring];
    float* edge = edges.data();
    for (int column = from; column < to; ++column) {
      const float dx = static_cast<float>(column) - east;
      const float inside = (dx >= 0.0F ? to_east : to_west) - std::sqrt(dx * dx + north * north);
      shade[column] += step * std::min(std::max(inside + 0.5F, 0.0F), 1.0F);
      edge[column] = std::max(edge[column], 1.25F - std::abs(inside - 0.75F));
    }
  }
  for (int column = from; column < to; ++column) {
    shades[std::size_t(column)] = std::max(shades[std::size_t(column)], shade[column]);
  }
}

void PaintRow(std::uint8_t* pixel, const std::vector<float>& shades,
              const std::vector<float>& edges) {
  const auto& table = ShadeTable();
  for (std::size_t column = 0; column < shades.size(); ++column, pixel += 3) {
    const float edge = edges[column];
    const auto shade = static_cast<std::size_t>(std::min(std::max(shades[column], 0.0F), 255.0F));
    if (shade == 0 && edge <= 0.0F) continue;
    const ShadeEntry& entry = table[shade];
    for (std::size_t c = 0; c < 3; ++c) {
      pixel[c] = static_cast<std::uint8_t>((pixel[c] * entry.rest + entry.paint[c]) >> 8);
    }
    if (edge <= 0.0F) continue;
    const double severity = (double(shade) - kFaintest) / (255.0 - kFaintest);
    const cv::Scalar line = Bgr(SeverityColor(severity));
    const double share = 0.85 * std::min(edge, 1.0F);
    for (int c = 0; c < 3; ++c) {
      pixel[c] = static_cast<std::uint8_t>(pixel[c] + (line[c] - pixel[c]) * share);
    }
  }
}

void DrawArrow(cv::Mat& map, cv::Point2d from, double bearing_deg, double length_px,
               const Layout& layout) {
  const float length = static_cast<float>(length_px / layout.unit);
  const float neck = length - 11.0F;
  const std::vector<cv::Point2f> outline{{-2.2F, 0.0F},  {2.2F, 0.0F},  {2.2F, neck}, {7.0F, neck},
                                         {0.0F, length}, {-7.0F, neck}, {-2.2F, neck}};
  const Pose2 placing{from, layout.unit, bearing_deg};
  StrokeShape(map, outline, placing, Bgr(kInk), layout.Px(2.5));
  FillShape(map, outline, placing, Bgr(kPaper));
}

void DrawTyphoonEye(cv::Mat& map, cv::Point2d at, double radius_px, const cv::Scalar& color) {
  // One arm of the chart symbol, counter-clockwise as in the northern hemisphere.
  static const std::vector<cv::Point2f> kArm = [] {
    constexpr int kCorners = 14;
    std::vector<cv::Point2f> points;
    for (int i = 0; i <= kCorners; ++i) {
      const double turn = double(i) / kCorners;
      const double angle = 2.6 * turn;
      const double radius = 2.1 - 1.2 * turn;
      points.emplace_back(float(radius * std::cos(angle)), float(radius * std::sin(angle)));
    }
    for (int i = kCorners; i >= 0; --i) {
      const double turn = double(i) / kCorners;
      const double angle = 2.6 * turn + 0.12;
      const double radius = 2.0 - 1.5 * std::sqrt(turn);
      points.emplace_back(float(radius * std::cos(angle)), float(radius * std::sin(angle)));
    }
    return points;
  }();
  for (const double bearing : {45.0, 225.0}) {
    StrokeShape(map, kArm, {at, radius_px, bearing}, Bgr(kInk), 3);
  }
  for (const double bearing : {45.0, 225.0}) FillShape(map, kArm, {at, radius_px, bearing}, color);
}

void DrawCentre(cv::Mat& map, const DisasterState& disaster, const Layout& layout,
                const Fonts& fonts) {
  const cv::Point2d at = layout.view.ToPixel(disaster.x, disaster.y);
  const double radius = 8.0 * layout.unit;
  if (disaster.speed > 0.0F) {
    const double length =
        std::clamp(2.2 * layout.view.cell_px(), 40.0 * layout.unit, 60.0 * layout.unit);
    DrawArrow(map, at, disaster.heading_deg, length, layout);
  }
  const cv::Scalar color = Bgr(GradeColor(disaster.grade));
  const bool typhoon = disaster.kind == DisasterState::TYPHOON;
  if (typhoon) DrawTyphoonEye(map, at, radius * 0.85, color);
  FillCircle(map, at, radius + 1.5 * layout.unit, Bgr(kInk));
  FillCircle(map, at, radius, color);
  if (typhoon) {
    FillCircle(map, at, radius * 0.4, Bgr(kPaper));
    return;
  }
  std::string letter = DisasterName(disaster.kind).substr(0, 1);
  letter[0] = static_cast<char>(letter[0] - 'a' + 'A');
  fonts.bold.Draw(map, letter,
                  {cvRound(at.x + 0.5 - fonts.bold.Width(letter) / 2.0),
                   cvRound(at.y + 0.5 + fonts.bold.cap_height() / 2.0)},
                  Bgr(kPaper));
}

std::string Distance(double metres) {
  return metres >= 10000.0  ? Number(metres / 1000.0, 0) + " km"
         : metres >= 1000.0 ? Number(metres / 1000.0, 1) + " km"
                            : Number(metres, 0) + " m";
}

// Draws a pointer at the border towards a centre outside the map, with its heading and its distance
// from the centre of the farm.
void DrawBorderPointer(cv::Mat& map, const DisasterState& disaster, cv::Point2d centre,
                       double cell_size_m, const Layout& layout, const Fonts& fonts) {
  static const std::vector<cv::Point2f> kPointer{{0.0F, 1.0F}, {0.75F, -0.7F}, {-0.75F, -0.7F}};
  const double margin = std::min(13.0 * layout.unit, std::min(map.cols, map.rows) / 2.0);
  const cv::Point2d at(std::clamp(centre.x, margin, map.cols - margin),
                       std::clamp(centre.y, margin, map.rows - margin));
  const double bearing = std::atan2(centre.x - at.x, at.y - centre.y) * 180.0 / CV_PI;
  double top = at.y;
  double foot = at.y;
  if (disaster.speed > 0.0F) {  // next to the pointer, so that the whole arrow is on the map
    const double length = 40.0 * layout.unit;
    const double turn = disaster.heading_deg * CV_PI / 180.0;
    const cv::Point2d way(length * std::sin(turn), -length * std::cos(turn));
    const double room = std::min(2.0 * margin, std::min(map.cols, map.rows) / 2.0);
    const cv::Point2d head(std::clamp(at.x + way.x, room, map.cols - room),
                           std::clamp(at.y + way.y, room, map.rows - room));
    DrawArrow(map, head - way, disaster.heading_deg, length, layout);
    top = std::min({top, head.y, head.y - way.y});
    foot = std::max({foot, head.y, head.y - way.y});
  }
  const Pose2 placing{at, 9.0 * layout.unit, bearing};
  StrokeShape(map, kPointer, placing, Bgr(kPaper), layout.Px(3));
  FillShape(map, kPointer, placing, Bgr(GradeColor(disaster.grade)));
  const MapView& view = layout.view;
  const std::string text =
      DisasterName(disaster.kind) + " " +
      Distance(cell_size_m * std::hypot(disaster.x - (view.width() - 1) / 2.0,
                                        disaster.y - (view.height() - 1) / 2.0));
  const int width = fonts.bold.Width(text);
  const cv::Point words(std::clamp(cvRound(at.x) - width / 2, layout.Px(4),
                                   std::max(layout.Px(4), map.cols - width - layout.Px(4))),
                        at.y > map.rows / 2.0
                            ? cvRound(top) - layout.Px(15)
                            : cvRound(foot) + layout.Px(15) + fonts.bold.cap_height());
  fonts.bold.Draw(map, text, words + cv::Point(1, 1), Bgr(kInk));
  fonts.bold.Draw(map, text, words, Bgr(kPaper));
}

}  // namespace

void ShadeDisasters(cv::Mat& map, const FarmState& state, const Layout& layout) {
  std::vector<Rings> all;
  for (const auto& disaster : state.disasters) {
    if (IsDrawn(disaster)) all.push_back(InPixels(disaster, layout));
  }
  if (all.empty()) return;
  const auto columns = static_cast<std::size_t>(map.cols);
  std::vector<float> shades(columns);
  std::vector<float> edges(columns);
  std::vector<float> scratch(columns);
  for (int row = 0; row < map.rows; ++row) {
    std::fill(shades.begin(), shades.end(), 0.0F);
    std::fill(edges.begin(), edges.end(), 0.0F);
    for (const auto& rings : all) ShadeRow(rings, row, shades, edges, scratch);
    PaintRow(map.ptr(row), shades, edges);
  }
}

void DrawDisasterSigns(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec, const FarmState& state,
                       const Layout& layout, const Fonts& fonts) {
  for (const auto& disaster : state.disasters) {
    if (!IsDrawn(disaster)) continue;
    const cv::Point2d centre = layout.view.ToPixel(disaster.x, disaster.y);
    const bool inside =
        centre.x >= 0.0 && centre.y >= 0.0 && centre.x < map.cols && centre.y < map.rows;
    if (inside) {
      DrawCentre(map, disaster, layout, fonts);
    } else {
      DrawBorderPointer(map, disaster, centre, spec.cell_size_m, layout, fonts);
    }
  }
}

}  // namespace aquafarm_viz
