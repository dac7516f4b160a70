// SPDX-License-Identifier: BSD-3-Clause
// Draws the rings of disasters: an outline, a light tint, and a pattern for each kind of disaster.
// Water and land stay visible below.
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "aquafarm_viz/base/disaster_kinds.h"
#include "aquafarm_viz/scene/rings.h"
#include "draw/symbols.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DisasterState;
using aquafarm_msgs::FarmState;

// A shade encodes a risk as a byte: 0 means no risk, kFaintest a risk of -5, and 255 a risk of -20.
// Values between 0 and kFaintest belong to pixels that the outermost edge covers partly.
constexpr double kFaintest = 55.0;
constexpr double kTintFaintest = 0.10;  // share of the colour between pattern lines, risk -5
constexpr double kTintWorst = 0.24;     // share of the colour between pattern lines, risk -20
constexpr double kLineShare = 0.62;     // share of the colour on the lines of the pattern
constexpr double kEdgeShare = 0.95;     // share of the colour on the edges of rings
constexpr double kLandShare = 0.35;     // factor of tint and pattern over land

double Shade(double risk) { return kFaintest + (255.0 - kFaintest) * Severity(risk); }

double SeverityOf(std::size_t shade) {
  return std::max(0.0, (double(shade) - kFaintest) / (255.0 - kFaintest));
}

// How a shade is drawn: its colour, the tint between the lines of the pattern, and half the width
// of these lines [pixels].
struct ShadeEntry {
  cv::Scalar color;
  float tint{};
  float half_width{};
};

using ShadeTable = std::array<ShadeEntry, 256>;

// @param is_filled  false: neither tint nor pattern, only the edges of rings
ShadeTable MakeShadeTable(const Style& style, bool is_filled) {
  ShadeTable table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double severity = SeverityOf(i);
    const double cover = std::min(1.0, double(i) / kFaintest);
    table[i].color = Bgr(style.Risk(severity));
    if (!is_filled) continue;
    table[i].tint = static_cast<float>(style.ring_tint * cover *
                                       (kTintFaintest + (kTintWorst - kTintFaintest) * severity));
    table[i].half_width = static_cast<float>(cover * (0.35 + 1.15 * severity));
  }
  return table;
}

// Distance of each pixel of a tile to the nearest line of a kind's pattern [pixels].
class Pattern {
 public:
  Pattern(std::uint8_t kind, int period_px) : side_(2 * period_px) {
    distances_.reserve(std::size_t(side_) * std::size_t(side_));
    for (int y = 0; y < side_; ++y) {
      for (int x = 0; x < side_; ++x) {
        distances_.push_back(DistanceToPattern(kind, x, y, period_px));
      }
    }
  }
  const float* Row(int row) const {
    return distances_.data() + std::size_t(row % side_) * std::size_t(side_);
  }
  int side() const { return side_; }

 private:
  int side_;
  std::vector<float> distances_;
};

using Patterns = std::vector<std::optional<Pattern>>;  // by KindIndex; nullopt: kind is not drawn

std::size_t KindIndex(std::uint8_t kind) {
  return std::min<std::size_t>(kind, DisasterKindCount() - 1);
}

// The rings of a disaster in pixels of the map.
struct Rings {
  cv::Point2d centre;
  std::vector<std::array<float, 4>> radii_px;  // NE, SE, SW, NW
  std::vector<float> shade_steps;              // shade of a ring minus that of the next outer ring
  std::uint8_t kind{};
};

// What the disasters add to one row of the map.
struct RingRow {
  RingRow(std::size_t columns, std::uint8_t kind)
      : shades(columns), edges(columns), kinds(columns), scratch(columns), first_kind(kind) {}
  void Clear() {
    std::fill(shades.begin(), shades.end(), 0.0F);
    std::fill(edges.begin(), edges.end(), 0.0F);
    std::fill(kinds.begin(), kinds.end(), first_kind);
  }
  std::vector<float> shades;        // shade of the worst disaster at each pixel
  std::vector<float> edges;         // coverage by the edges of rings
  std::vector<std::uint8_t> kinds;  // kind of the worst disaster
  std::vector<float> scratch;       // shades of one disaster
  std::uint8_t first_kind;          // kind of a pixel that only an edge covers
};

float Largest(const std::array<float, 4>& radii) {
  return *std::max_element(radii.begin(), radii.end());
}

Rings InPixels(const DisasterState& disaster, const Layout& layout) {
  Rings rings{layout.view.ToPixel(disaster.x, disaster.y), {}, {}, disaster.kind};
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

// Returns whether the edge of any ring may cross the map.
bool HasEdgeOn(const Rings& rings, cv::Size map) {
  const cv::Point2d centre = rings.centre;
  const cv::Point2d far(std::max(centre.x, map.width - centre.x),
                        std::max(centre.y, map.height - centre.y));
  const cv::Point2d near(centre.x - std::clamp(centre.x, 0.0, double(map.width)),
                         centre.y - std::clamp(centre.y, 0.0, double(map.height)));
  return std::any_of(rings.radii_px.begin(), rings.radii_px.end(), [&](const auto& radii) {
    const bool covers = cv::norm(far) <= double(*std::min_element(radii.begin(), radii.end()));
    return !covers && double(Largest(radii)) >= cv::norm(near);
  });
}

// Adds one disaster to a row: updates the worst shade of each pixel and its coverage by ring edges.
void ShadeRow(const Rings& rings, int row, RingRow& out) {
  const auto north = static_cast<float>(row - rings.centre.y);
  const auto east = static_cast<float>(rings.centre.x);
  const float reach = rings.radii_px.empty() ? 0.0F : Largest(rings.radii_px.back()) + 1.0F;
  if (std::abs(north) > reach) return;
  const float half = std::sqrt(reach * reach - north * north);
  const auto columns = static_cast<int>(out.shades.size());
  const int from =
      std::clamp(static_cast<int>(std::floor(std::clamp(east - half, -1e6F, 1e6F))), 0, columns);
  const int to = std::clamp(static_cast<int>(std::ceil(std::clamp(east + half, -1e6F, 1e6F))) + 1,
                            from, columns);
  float* shade = out.scratch.data();
  std::fill(shade + from, shade + to, 0.0F);
  for (std::size_t ring = 0; ring < rings.radii_px.size(); ++ring) {
    const std::array<float, 4>& radii = rings.radii_px[ring];
    const bool is_north = north < 0.0F;  // row indices increase downwards
    const float to_east = radii[is_north ? 0 : 1];
    const float to_west = radii[is_north ? 3 : 2];
    const float step = rings.shade_steps[ring];
    float* edge = out.edges.data();
    for (int column = from; column < to; ++column) {
      const float dx = static_cast<float>(column) - east;
      const float inside = (dx >= 0.0F ? to_east : to_west) - std::sqrt(dx * dx + north * north);
      shade[column] += step * std::min(std::max(inside + 0.5F, 0.0F), 1.0F);
      edge[column] = std::max(edge[column], 1.6F - std::abs(inside - 1.1F));
    }
  }
  for (int column = from; column < to; ++column) {
    const auto at = static_cast<std::size_t>(column);
    if (shade[column] <= out.shades[at]) continue;
    out.shades[at] = shade[column];
    out.kinds[at] = rings.kind;
  }
}

void PaintRow(std::uint8_t* pixel, const std::uint8_t* land, int row, const RingRow& from,
              const Patterns& patterns, const ShadeTable& table) {
  for (std::size_t column = 0; column < from.shades.size(); ++column, pixel += 3) {
    const float edge = from.edges[column];
    const auto shade =
        static_cast<std::size_t>(std::min(std::max(from.shades[column], 0.0F), 255.0F));
    if (shade == 0 && edge <= 0.0F) continue;
    const ShadeEntry& entry = table[shade];
    const Pattern& pattern = *patterns[KindIndex(from.kinds[column])];
    const float away = pattern.Row(row)[column % std::size_t(pattern.side())];
    const float line = std::clamp(entry.half_width + 0.5F - away, 0.0F, 1.0F) *
                       std::min(1.0F, 2.0F * entry.half_width);
    float share = entry.tint + (float(kLineShare) - entry.tint) * line;
    share *= 1.0F - float(1.0 - kLandShare) * float(land[column]) / 255.0F;
    share = std::max(share, float(kEdgeShare) * std::clamp(edge, 0.0F, 1.0F));
    for (int c = 0; c < 3; ++c) {
      pixel[c] = static_cast<std::uint8_t>(pixel[c] + (entry.color[c] - pixel[c]) * share);
    }
  }
}

}  // namespace

void DrawRiskSample(cv::Mat& image, cv::Rect box, std::uint8_t kind, double risk, bool is_filled,
                    const Layout& layout) {
  box &= cv::Rect({0, 0}, image.size());
  if (box.empty()) return;
  cv::rectangle(image, box, Bgr(layout.style->sea_south), cv::FILLED);
  Patterns patterns(DisasterKindCount());
  patterns[KindIndex(kind)].emplace(kind, std::max(4, layout.Px(6)));
  const ShadeTable table = MakeShadeTable(*layout.style, is_filled);
  const std::vector<std::uint8_t> land(std::size_t(box.width), 0);
  RingRow line(std::size_t(box.width), kind);
  line.Clear();
  std::fill(line.shades.begin(), line.shades.end(), static_cast<float>(Shade(risk)));
  const int edge = std::min(layout.Px(1.0), box.width / 2);  // width of the edge
  for (int row = 0; row < box.height; ++row) {
    const bool is_edge = row < edge || row >= box.height - edge;
    std::fill(line.edges.begin(), line.edges.end(), is_edge ? 1.0F : 0.0F);
    std::fill_n(line.edges.begin(), edge, 1.0F);
    std::fill_n(line.edges.rbegin(), edge, 1.0F);
    PaintRow(image.ptr(box.y + row) + 3 * box.x, land.data(), row, line, patterns, table);
  }
}

void ShadeDisasters(cv::Mat& map, const FarmState& state, const cv::Mat1b& land, bool is_filled,
                    const Layout& layout) {
  std::vector<Rings> all;
  for (const auto& disaster : state.disasters) {
    if (IsDrawn(disaster)) all.push_back(InPixels(disaster, layout));
  }
  if (all.empty()) return;
  Patterns patterns(DisasterKindCount());
  for (const Rings& rings : all) {
    auto& pattern = patterns[KindIndex(rings.kind)];
    if (pattern) continue;
    const bool has_edge = std::any_of(all.begin(), all.end(), [&](const Rings& other) {
      return other.kind == rings.kind && HasEdgeOn(other, map.size());
    });
    pattern.emplace(rings.kind, layout.Px(has_edge ? 13 : 30));  // wider if no edge is on the map
  }
  const ShadeTable table = MakeShadeTable(*layout.style, is_filled);
  RingRow line(static_cast<std::size_t>(map.cols), all.front().kind);
  for (int row = 0; row < map.rows; ++row) {
    line.Clear();
    for (const auto& rings : all) ShadeRow(rings, row, line);
    PaintRow(map.ptr(row), land.ptr(row), row, line, patterns, table);
  }
}

}  // namespace aquafarm_viz
