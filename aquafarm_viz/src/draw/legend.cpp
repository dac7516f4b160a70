// SPDX-License-Identifier: BSD-3-Clause
#include "draw/legend.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>

#include "aquafarm/tracks/wind_name.h"
#include "draw/paths.h"
#include "draw/symbols.h"
#include "scene/nautical.h"
#include "scene/outlook_text.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

// Sizes in design units.
constexpr double kFoot = 45.0;         // height of the north arrow and the scale bar
constexpr double kHeading = 18.0;      // height of the heading
constexpr double kKeyRow = 16.0;       // height of a row of the keys
constexpr double kKeyScale = 24.0;     // height of the scale of risks with its texts
constexpr double kLowKeyScale = 20.0;  // the same below the map
constexpr double kSign = 84.0;         // min width of a sign with its text below the map
constexpr double kMaxRisks = 260.0;    // max width of the key of risks without names below the map
constexpr double kScale = 205.0;       // width of the north arrow and the scale bar below the map

constexpr std::size_t kMaxColors = 4;  // max number of risks in the key
constexpr double kMildRisk = -5.0;     // risk of the sample for Sign::kAtRisk

bool HasNames(const RiskKey& key) { return !key.empty() && key.front().wind_kt > 0; }

bool IsBelowMap(const Layout& layout) { return !layout.key.empty(); }

// Returns the height of the key of risks [pixels]. Rings with names have a row each in the panel,
// and a common row below the map.
int KeyPx(const RiskKey* key, const Layout& layout) {
  if (key == nullptr) return 0;
  if (key->empty()) return layout.Px(IsBelowMap(layout) ? kLowKeyScale : kKeyScale);
  const bool has_rows = HasNames(*key) && !IsBelowMap(layout);
  return (has_rows ? static_cast<int>(key->size()) : 1) * layout.Px(kKeyRow);
}

// Returns the width of the north arrow and the scale bar below the map [pixels].
int ScalePx(const Layout& layout) {
  return std::min(layout.Px(kScale), cvRound(0.36 * layout.key.width));
}

// The places of the signs in the key.
struct SignGrid {
  int columns{};
  std::vector<cv::Point> cells;  // column and row of each sign

  int rows() const { return cells.empty() ? 0 : cells.back().y + 1; }
};

// Returns a grid with a number of columns. A sign that does not fit into the rest of a row begins
// the next row.
SignGrid GridOf(const std::vector<Sign>& signs, int columns) {
  SignGrid grid{columns, {}};
  cv::Point next;
  for (const Sign sign : signs) {
    if (next.x + SignSpan(sign) > columns) next = {0, next.y + 1};
    grid.cells.push_back(next);
    next.x += SignSpan(sign);
  }
  return grid;
}

// Returns the grid in the panel, or that below the map, which has at most three rows.
SignGrid MakeSignGrid(const std::vector<Sign>& signs, const Layout& layout) {
  if (!IsBelowMap(layout)) return GridOf(signs, layout.panel.width >= layout.Px(245.0) ? 3 : 2);
  constexpr int kMaxRows = 3;
  int columns = std::max(2, (layout.key.width - ScalePx(layout)) / layout.Px(kSign));
  while (GridOf(signs, columns).rows() > kMaxRows) ++columns;
  return GridOf(signs, columns);
}

// Draws a scale bar with a round length of at most `room_px` pixels.
void DrawScaleBar(cv::Mat& image, cv::Point left, int room_px, double cell_size_m,
                  const Layout& layout, const Fonts& fonts) {
  const double px_per_m = layout.view.cell_px() / cell_size_m;
  const double length_m = RoundLength(room_px / px_per_m);
  const int length = std::max(2, cvRound(length_m * px_per_m));
  const int half = length / 2;
  const int tall = layout.Px(4);
  const cv::Rect bar(left.x, left.y, length, tall);
  cv::rectangle(image, bar, Bgr(layout.style->words), cv::FILLED);
  cv::rectangle(
      image,
      cv::Rect(left.x + half, left.y + 1, std::max(1, length - half - 1), std::max(1, tall - 2)),
      Bgr(layout.style->panel), cv::FILLED);
  constexpr double kNauticalMile_m = 1852.0;
  std::string text = length_m >= 1000.0 ? Number(length_m / 1000.0, 0) + " km"
                                        : Number(length_m, length_m < 1.0 ? 3 : 0) + " m";
  if (length_m >= 100.0) text += " = " + Number(length_m / kNauticalMile_m, 2) + " nmi";
  const std::string count = Number(length_m / cell_size_m, 0);
  const std::string cells = " = " + count + (count == "1" ? " cell" : " cells");
  const bool is_whole = std::abs(std::remainder(length_m, cell_size_m)) < 1e-6 * length_m;
  if (is_whole && fonts.small.Width(text + cells) <= room_px) text += cells;
  fonts.small.Draw(image, text, {left.x, left.y - layout.Px(4)}, Bgr(layout.style->words));
}

void DrawNorthArrow(cv::Mat& image, cv::Point at, const Layout& layout, const Fonts& fonts) {
  static const std::vector<cv::Point2f> kWest{{0.0F, 1.0F}, {0.0F, -0.45F}, {-0.55F, -0.85F}};
  static const std::vector<cv::Point2f> kEast{{0.0F, 1.0F}, {0.55F, -0.85F}, {0.0F, -0.45F}};
  const Pose2 placing{at, 11.0 * layout.unit, 0.0};
  FillShape(image, kWest, placing, Bgr(layout.style->words));
  FillShape(image, kEast, placing, Bgr(layout.style->faint));
  fonts.bold.Draw(image, "N", {at.x - fonts.bold.Width("N") / 2, at.y - layout.Px(14)},
                  Bgr(layout.style->words));
}

}  // namespace

void DrawLegend(cv::Mat& image, const FarmSpec& spec, const Layout& layout, const Fonts& fonts) {
  if (!HasLegend(layout)) return;
  const cv::Rect place = IsBelowMap(layout) ? layout.key : layout.panel;
  const int width = IsBelowMap(layout) ? ScalePx(layout) : place.width - layout.Px(16);
  const int left = place.br().x - width - (IsBelowMap(layout) ? 0 : layout.Px(6));
  const int foot = place.br().y - layout.Px(14);
  DrawNorthArrow(image, {left + layout.Px(8), foot - layout.Px(6)}, layout, fonts);
  DrawScaleBar(image, {left + layout.Px(30), foot}, width - layout.Px(30), spec.cell_size_m, layout,
               fonts);
}

bool HasLegend(const Layout& layout) { return IsBelowMap(layout) || !layout.panel.empty(); }

namespace {

// Returns whether a ring has a radius now or later.
bool HasRing(const Course& course, std::size_t ring) {
  return std::any_of(course.ahead.begin(), course.ahead.end(), [ring](const TrackPoint& point) {
    return ring < point.radii.size() &&
           std::any_of(point.radii[ring].begin(), point.radii[ring].end(),
                       [](double cells) { return cells > 0.0; });
  });
}

// Returns the rings that have a radius now or later, of all drawn disasters, each once. Without
// names, rings with the same rounded risk count as the same ring.
RiskKey ListRings(const FarmState& state, const std::vector<Course>& courses, bool has_names) {
  RiskKey key;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    const auto& disaster = state.disasters[i];
    if (!IsDrawn(disaster)) continue;
    for (std::size_t ring = disaster.risks.size(); ring-- > 0;) {
      if (!HasRing(courses[i], ring)) continue;
      const std::vector<std::int32_t>& winds = courses[i].ring_winds_kt;
      const KeyRing one{has_names && ring < winds.size() ? winds[ring] : 0,
                        std::round(double(disaster.risks[ring])), disaster.kind};
      const auto is_same = [&](const KeyRing& other) {
        return other.wind_kt == one.wind_kt && other.risk == one.risk &&
               (!has_names || other.kind == one.kind);
      };
      if (std::none_of(key.begin(), key.end(), is_same)) key.push_back(one);
    }
  }
  return key;
}

}  // namespace

RiskKey MakeRiskKey(const FarmState& state, const std::vector<Course>& courses) {
  bool has_names = true;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    has_names = has_names && (!IsDrawn(state.disasters[i]) || !courses[i].ring_winds_kt.empty());
  }
  RiskKey key = ListRings(state, courses, has_names);
  if (has_names && key.size() > kMaxColors) key = ListRings(state, courses, false);
  if (!HasNames(key)) {
    std::stable_sort(key.begin(), key.end(),
                     [](const KeyRing& a, const KeyRing& b) { return a.risk > b.risk; });
  }
  return key.size() > kMaxColors ? RiskKey() : key;
}

std::string FittingRingName(std::int32_t wind_kt, int width_px, const Font& font) {
  const std::string full = aquafarm::RingName(wind_kt);
  if (font.Width(full) <= width_px) return full;
  // Shortens the name and not the wind, because the wind is more important.
  const std::size_t space = full.find(' ');
  const std::size_t knots = full.find(" (");
  if (knots == std::string::npos || space == knots) return full;
  return full.substr(0, space) + full.substr(knots);
}

namespace {

// Adds the signs of the moves of a trail.
void AddPathSigns(std::set<Sign>& signs, const FarmState& state, const Trail& trail) {
  for (const auto& ship : state.ships) {
    const ShipTrail* way = ship.visible ? trail.Find(ship.id) : nullptr;
    if (way == nullptr) continue;
    for (std::size_t i = DrawnFrom(state, *way) + 1; i < way->loaded.size(); ++i) {
      signs.insert(ship.own_device >= 0 ? Sign::kPath
                   : way->loaded[i]     ? Sign::kLoadedPath
                                        : Sign::kEmptyPath);
    }
  }
}

}  // namespace

std::vector<Sign> SignsOf(const FarmSpec& spec, const FarmState& state, const Overlays& overlays,
                          const Outlook& outlook, const RiskKey& key, const Layout& layout) {
  std::vector<Sign> signs;
  const auto add = [&signs](bool is_shown, Sign sign) {
    if (is_shown) signs.push_back(sign);
  };
  const Layers& layers = overlays.layers;
  add(layers.risk && key.empty() &&
          std::any_of(state.disasters.begin(), state.disasters.end(), IsDrawn),
      Sign::kAtRisk);
  const auto in_danger = layers.risk ? CountInDanger(outlook) : 0;
  add(in_danger > 0, Sign::kInDanger);
  add(in_danger > 0 && HasHitFirst(spec, outlook), Sign::kFirstReached);
  add(std::any_of(state.devices.begin(), state.devices.end(),
                  [](const auto& device) {
                    return device.status == aquafarm_msgs::DeviceState::DELIVERED;
                  }),
      Sign::kDelivered);
  add(std::any_of(state.devices.begin(), state.devices.end(),
                  [](const auto& device) {
                    return device.status != aquafarm_msgs::DeviceState::DEPLOYED &&
                           !device.self_propelled;
                  }),
      Sign::kFetched);
  std::set<Sign> paths;
  if (layers.route && overlays.route != nullptr) AddPathSigns(paths, state, *overlays.route);
  if (layers.trail && overlays.trail != nullptr) AddPathSigns(paths, state, *overlays.trail);
  signs.insert(signs.end(), paths.begin(), paths.end());
  bool has_heading = false;
  bool has_pointer = false;
  for (const auto& disaster : state.disasters) {
    if (!IsDrawn(disaster)) continue;
    const SignPlace sign = PlaceSign(disaster, layout);
    has_heading = has_heading || sign.arrow_to != sign.at;
    has_pointer = has_pointer || !sign.is_inside;
  }
  add(has_pointer, Sign::kPointer);
  add(has_heading, Sign::kHeading);
  add(layers.directions, Sign::kDirection);
  add(layers.sight && spec.view_mode == FarmSpec::PARTIAL, Sign::kSight);
  add(!spec.ports.empty(), Sign::kPort);
  add(!spec.rocks.empty(), Sign::kRock);
  add(std::any_of(state.devices.begin(), state.devices.end(),
                  [](const auto& device) {
                    return device.status != aquafarm_msgs::DeviceState::DELIVERED;
                  }),
      Sign::kHealth);
  return signs;
}

int SignSpan(Sign sign) { return sign == Sign::kInDanger ? 2 : 1; }

const char* SignWords(Sign sign) {
  switch (sign) {
    case Sign::kAtRisk:
      return "at risk";
    case Sign::kFirstReached:
      return "hit first";
    case Sign::kInDanger:
      return "in danger, colour by risk";
    case Sign::kDelivered:
      return "in port";
    case Sign::kFetched:
      return "fetched";
    case Sign::kPath:
      return "path";
    case Sign::kLoadedPath:
      return "loaded";
    case Sign::kEmptyPath:
      return "empty";
    case Sign::kPointer:
      return "to centre";
    case Sign::kHeading:
      return "heading";
    case Sign::kDirection:
      return "legal move";
    case Sign::kSight:
      return "sensors";
    case Sign::kPort:
      return "port";
    case Sign::kRock:
      return "rock";
    case Sign::kHealth:
      return "health";
  }
  return "";
}

namespace {

// Draws the pattern of each kind of the drawn disasters, side by side.
void DrawRiskSamples(cv::Mat& image, cv::Point2d at, const FarmState& state, const Layout& layout) {
  std::set<std::uint8_t> kinds;
  for (const auto& disaster : state.disasters) {
    if (IsDrawn(disaster)) kinds.insert(disaster.kind);
  }
  const int width = layout.Px(15) / std::max(1, static_cast<int>(kinds.size()));
  cv::Rect box(cvRound(at.x) - layout.Px(7), cvRound(at.y) - layout.Px(6), width, layout.Px(12));
  for (const std::uint8_t kind : kinds) {
    DrawRiskSample(image, box, kind, kMildRisk, /*is_filled=*/true, layout);
    box.x += width;
  }
}

// Draws the colours of a bar of health, from 0 to 100 %.
void DrawHealthSample(cv::Mat& image, cv::Point2d at, const Layout& layout) {
  const int width = layout.Px(15);
  const cv::Point left(cvRound(at.x) - width / 2, cvRound(at.y) - layout.Px(2));
  for (int i = 0; i < width; ++i) {
    cv::rectangle(image, cv::Rect(left.x + i, left.y, 1, layout.Px(5)),
                  Bgr(HealthColor((i + 0.5) / width)), cv::FILLED);
  }
}

void DrawSign(cv::Mat& image, Sign sign, cv::Point2d at, const FarmState& state,
              const Layout& layout) {
  const double unit = layout.unit;
  const Style& style = *layout.style;
  const cv::Point2d half(7.0 * unit, 0.0);
  switch (sign) {
    case Sign::kAtRisk:
      DrawRiskSamples(image, at, state, layout);
      break;
    case Sign::kFirstReached:
      StrokeCircle(image, at, 3.0 * unit, Bgr(style.words), layout.Px(1.4));
      [[fallthrough]];
    case Sign::kInDanger:
      StrokeCircle(image, at, 6.0 * unit, Bgr(style.words), layout.Px(1.4));
      break;
    case Sign::kDelivered:
      DrawDeviceSymbol(image, 0, {at, 4.5 * unit, 0.0}, 0.35);
      break;
    case Sign::kFetched:
      DrawFetched(image, 0, at, 6.0 * unit, layout);
      break;
    case Sign::kPath:
    case Sign::kLoadedPath:
    case Sign::kEmptyPath:
      DrawPathSample(image, at - half, at + half, sign == Sign::kEmptyPath, state, layout);
      break;
    case Sign::kPointer: {
      const Pose2 placing{at, 6.0 * unit, 225.0};
      StrokeShape(image, PointerOutline(), placing, Bgr(kInk), layout.Px(3));
      StrokeShape(image, PointerOutline(), placing, Bgr(style.words), layout.Px(1.5));
      break;
    }
    case Sign::kHeading:
      DrawArrow(image, at, 45, 17.0 * unit, Bgr(kInk), layout.Px(4));
      DrawArrow(image, at, 45, 17.0 * unit, Bgr(kPaper), layout.Px(2.4));
      break;
    case Sign::kDirection:
      DrawArrow(image, at, 90, 15.0 * unit, Bgr(kInk), layout.Px(4));
      DrawArrow(image, at, 90, 15.0 * unit, Bgr(kDirectionColor), layout.Px(2));
      break;
    case Sign::kSight:
      StrokeCircle(image, at, 6.0 * unit, Bgr(kInk), layout.Px(2.5));
      StrokeCircle(image, at, 6.0 * unit, Bgr(kPaper), layout.Px(1.5));
      break;
    case Sign::kPort:
      FillCircle(image, at, 5.5 * unit, Bgr(kPort));
      StrokeCircle(image, at, 5.5 * unit, Bgr(kInk), layout.Px(1.2));
      break;
    case Sign::kRock:
      DrawRock(image, at, 5.5 * unit);
      break;
    case Sign::kHealth:
      DrawHealthSample(image, at, layout);
      break;
  }
}

}  // namespace

int LegendPx(const RiskKey* key, const std::vector<Sign>& signs, const Layout& layout) {
  if (IsBelowMap(layout)) return 0;
  return layout.Px(kFoot) + MakeSignGrid(signs, layout).rows() * layout.Px(kKeyRow) +
         KeyPx(key, layout) + layout.Px(kHeading);
}

namespace {

// Draws the key of signs.
// @param rows  position and width of the signs
void DrawSigns(cv::Mat& image, const std::vector<Sign>& signs, const SignGrid& grid, cv::Rect rows,
               const FarmState& state, const Layout& layout, const Fonts& fonts) {
  const int width = rows.width / grid.columns;
  for (std::size_t i = 0; i < signs.size(); ++i) {
    const int x = rows.x + grid.cells[i].x * width;
    const int y = rows.y + grid.cells[i].y * layout.Px(kKeyRow) + layout.Px(kKeyRow / 2);
    const Sign sign = signs[i];
    DrawSign(image, sign, cv::Point2d(x + layout.Px(7), y), state, layout);
    fonts.small.Draw(
        image, fonts.small.Fit(SignWords(sign), SignSpan(sign) * width - layout.Px(22)),
        {x + layout.Px(20), y + fonts.small.cap_height() / 2}, Bgr(layout.style->words));
  }
}

// Draws a sample of each ring, and the risk next to it.
void DrawRisks(cv::Mat& image, const RiskKey& rings, bool is_filled, cv::Rect row,
               const Layout& layout, const Fonts& fonts) {
  const int base = row.y + (row.height + fonts.small.cap_height()) / 2;
  int x = row.x;
  x += fonts.small.Draw(image, "risk", {x, base}, Bgr(layout.style->words)) + layout.Px(10);
  const int step = (row.br().x - x) / std::max(1, static_cast<int>(rings.size()));
  for (const KeyRing& ring : rings) {
    const cv::Rect box(x, row.y + layout.Px(1.5), layout.Px(17), row.height - layout.Px(3));
    DrawRiskSample(image, box, ring.kind, ring.risk, is_filled, layout);
    fonts.small.Draw(image, Number(ring.risk, 0), {box.br().x + layout.Px(4), base},
                     Bgr(layout.style->words));
    x += step;
  }
}

// Draws a sample of a ring, its name, and its risk. Below the map, the risk is next to the name,
// else at the right end of the row.
void DrawNamedRing(cv::Mat& image, const KeyRing& ring, bool is_filled, cv::Rect row,
                   const Layout& layout, const Fonts& fonts) {
  const int base = row.y + (row.height + fonts.small.cap_height()) / 2;
  const cv::Rect box(row.x, row.y + layout.Px(1.5), layout.Px(15), layout.Px(12));
  DrawRiskSample(image, box, ring.kind, ring.risk, is_filled, layout);
  const std::string risk = "risk " + Number(ring.risk, 0);
  const int words = row.x + layout.Px(22);
  const int space = row.br().x - fonts.small.Width(risk) - layout.Px(8) - words;
  const std::string name =
      fonts.small.Fit(FittingRingName(ring.wind_kt, space, fonts.small), space);
  const int end = words + fonts.small.Draw(image, name, {words, base}, Bgr(layout.style->words));
  const int at = IsBelowMap(layout) ? end + layout.Px(8) : row.br().x - fonts.small.Width(risk);
  fonts.small.Draw(image, risk, {at, base}, Bgr(layout.style->faint));
}

// Draws the colours of all risks, from the mildest to the worst.
void DrawRiskScale(cv::Mat& image, cv::Rect row, const Layout& layout, const Fonts& fonts) {
  const cv::Rect scale(row.x, row.y, row.width, layout.Px(7));
  for (int i = 0; i < scale.width; ++i) {
    cv::rectangle(image, cv::Rect(scale.x + i, scale.y, 1, scale.height),
                  Bgr(layout.style->Risk(double(i) / scale.width)), cv::FILLED);
  }
  const int base = row.y + layout.Px(10) + fonts.small.cap_height();
  const std::string worst = "-20 worst";
  fonts.small.Draw(image, "risk -5", {row.x, base}, Bgr(layout.style->faint));
  fonts.small.Draw(image, worst, {row.br().x - fonts.small.Width(worst), base},
                   Bgr(layout.style->faint));
}

// Draws the key of risks.
// @param row  position and size of its first row
void DrawRiskKey(cv::Mat& image, const RiskKey& key, bool is_filled, cv::Rect row,
                 const Layout& layout, const Fonts& fonts) {
  if (key.empty()) return DrawRiskScale(image, row, layout, fonts);
  if (!HasNames(key)) return DrawRisks(image, key, is_filled, row, layout, fonts);
  const cv::Point next =
      IsBelowMap(layout) ? cv::Point(row.width / int(key.size()), 0) : cv::Point(0, row.height);
  if (next.x > 0) row.width = next.x;
  for (const KeyRing& ring : key) {
    DrawNamedRing(image, ring, is_filled, row, layout, fonts);
    row += next;
  }
}

}  // namespace

void DrawKeys(cv::Mat& image, const RiskKey* key, bool is_filled, const std::vector<Sign>& signs,
              const FarmState& state, const Layout& layout, const Fonts& fonts) {
  const SignGrid grid = MakeSignGrid(signs, layout);
  const int row_px = layout.Px(kKeyRow);
  const int key_px = KeyPx(key, layout);
  cv::Rect risks = layout.key;
  cv::Rect below;  // the signs
  if (IsBelowMap(layout)) {
    if (key != nullptr && !HasNames(*key))
      risks.width = std::min(risks.width, layout.Px(kMaxRisks));
    below = {risks.x, risks.y + key_px, layout.key.width - ScalePx(layout), 0};
  } else {
    const cv::Rect& panel = layout.panel;
    const int top = panel.br().y - layout.Px(kFoot) - grid.rows() * row_px - key_px;
    risks = {panel.x + layout.Px(10), top, panel.width - layout.Px(20), 0};
    below = {risks.x, top + key_px, panel.width - layout.Px(16), 0};
    const int heading_px = layout.Px(kHeading);
    fonts.bold.Draw(image, "KEY",
                    {risks.x, top - heading_px + (heading_px + fonts.bold.cap_height()) / 2},
                    Bgr(layout.style->faint));
  }
  risks.height = row_px;
  if (key != nullptr) DrawRiskKey(image, *key, is_filled, risks, layout, fonts);
  DrawSigns(image, signs, grid, below, state, layout, fonts);
}

}  // namespace aquafarm_viz
