// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/draw/image.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <set>
#include <stdexcept>

#include "aquafarm_viz/base/checks.h"
#include "draw/course.h"
#include "draw/map_labels.h"
#include "draw/paths.h"
#include "draw/symbols.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

// Returns true if the pictures of two specs have the same background.
bool SameBackground(const FarmSpec& a, const FarmSpec& b) {
  const auto same_cell = [](const auto& c, const auto& d) { return c.x == d.x && c.y == d.y; };
  return a.width == b.width && a.height == b.height && a.cell_size_m == b.cell_size_m &&
         a.scenario_hash == b.scenario_hash &&
         std::equal(a.islands.begin(), a.islands.end(), b.islands.begin(), b.islands.end(),
                    same_cell) &&
         std::equal(a.rocks.begin(), a.rocks.end(), b.rocks.begin(), b.rocks.end(),
                    [&](const auto& c, const auto& d) { return same_cell(c.cell, d.cell); }) &&
         std::equal(a.ports.begin(), a.ports.end(), b.ports.begin(), b.ports.end(),
                    [&](const auto& c, const auto& d) {
                      return c.id == d.id && same_cell(c.cell, d.cell);
                    });
}

// Returns true if two maps of values look the same. Compares bytes, because cells without a
// value are NaN, which is not equal to itself.
bool SameMap(const Values& a, const Values& b) {
  return a.width == b.width && a.height == b.height && a.lowest == b.lowest &&
         a.highest == b.highest && a.actions == b.actions &&
         std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)) == 0;
}

}  // namespace

struct FarmPainter::Parts {
  Parts(ImageSize wanted, const Style& colours)
      : style(&colours),
        size{std::clamp(wanted.width, kMinImageSide, kMaxImageSide),
             std::clamp(wanted.height, kMinImageSide, kMaxImageSide), wanted.has_panel,
             wanted.text_scale},
        fonts(MakeLayout(1, 1, size).unit) {}

  const Style* style;
  ImageSize size;
  Fonts fonts;
  Layout layout;
  FarmSpec drawn;   // spec for which the background was drawn
  std::string sea;  // sea layer of the background; empty: none
  cv::Mat background;
  std::optional<std::vector<PortDirections>> directions;  // of the spec; nullopt before use
  CourseReader courses;
  cv::Mat1b land;                  // IslandCoverage of the background
  std::vector<CoastRing> coast;    // CoastAround of the spec
  std::optional<MoveSigns> moves;  // for the layout; nullopt before the first use
  Values values;                   // values drawn in `valued`
  cv::Mat valued;                  // map of the background with V_π; empty if not drawn yet
  cv::Mat image;

  /// Clears `valued` if the values or the background have changed.
  void Follow(const Values* now, bool is_new_background) {
    const bool is_new = now != nullptr && !SameMap(*now, values);
    if (is_new) values = *now;
    if (is_new || is_new_background) valued.release();
  }

  /// Draws the background if the present one does not fit. Returns true if it was drawn.
  bool PrepareBackground(const FarmSpec& spec, const std::string& wanted_sea) {
    const bool same_sea =
        wanted_sea == sea && (wanted_sea.empty() || spec.scenario_yaml == drawn.scenario_yaml);
    if (!background.empty() && SameBackground(spec, drawn) && same_sea) return false;
    background.release();  // stays empty if DrawSea throws
    layout = MakeLayout(spec.width, spec.height, size, *style);
    moves.reset();
    directions.reset();
    cv::Mat fresh = DrawBackground(spec, layout, fonts, size);
    cv::Mat below = fresh(layout.map);
    if (!wanted_sea.empty()) DrawSea(below, spec, wanted_sea, layout, fonts);
    background = fresh;
    land = IslandCoverage(spec, layout);
    coast = CoastAround(spec);
    drawn = spec;
    sea = wanted_sea;
    return true;
  }

  /// Draws the rings, courses and signs of disasters, and the marks around devices in danger.
  /// Returns the marks on the courses.
  std::vector<CourseMark> DrawDisasters(cv::Mat& map, const FarmSpec& spec, const FarmState& state,
                                        const Forecasts& forecasts, bool has_risk,
                                        bool has_values) {
    // A tint would change the colours of the values, so that they would not match their scale, and
    // a pattern would make them hard to read.
    if (has_risk) ShadeDisasters(map, state, land, /*is_filled=*/!has_values, layout);
    std::vector<CourseMark> marks;
    for (std::size_t i = 0; has_risk && i < state.disasters.size(); ++i) {
      if (!IsDrawn(state.disasters[i])) continue;
      const auto here = DrawCourse(
          map, spec, forecasts.courses[i],
          [this](double x, double y) { return layout.view.ToPixel(x, y); }, layout);
      marks.insert(marks.end(), here.begin(), here.end());
    }
    DrawDisasterSigns(map, state, layout, fonts);
    if (has_risk) DrawDangerMarks(map, spec, state, forecasts.outlook, layout);
    return marks;
  }

  /// Draws the scale of values and the choice of a compared policy on the map, for pictures whose
  /// panel has no space for them.
  void DrawPolicyKey(cv::Mat& map, const FarmState& state, const Overlays& overlays,
                     const Values* now, FreeSpace& space) {
    if (overlays.choice != nullptr) {
      DrawChoiceWords(map, state, *overlays.choice, space, layout, fonts);
    }
    if (overlays.layers.values && now != nullptr) {
      DrawValueScale(map, *now, space, layout, fonts);
    }
  }

  /// Writes the labels of the map, the most important ones first, because space is limited.
  void Label(cv::Mat& map, const FarmSpec& spec, const FarmState& state, const Overlays& overlays,
             const Forecasts& forecasts, LabelSpace& space) {
    const Layers& layers = overlays.layers;
    for (const Trail* paths :
         {layers.trail ? overlays.trail : nullptr, layers.route ? overlays.route : nullptr}) {
      if (paths != nullptr) space.BlockPaths(state, *paths, layout);
    }
    LabelShips(map, spec, state, space, layout, fonts);
    // Pointers precede devices, because there is less space around a pointer at the edge.
    LabelPointers(map, spec, state, forecasts.courses, space, layout, fonts);
    std::set<std::int32_t> labelled;
    if (layers.risk) {
      labelled = LabelDanger(map, spec, state, forecasts.outlook, space, layout, fonts);
    }
    if (layers.labels) {
      LabelDevices(map, spec, state, labelled, space, layout, fonts);
      LabelFetched(map, spec, state, overlays.trail, space, layout, fonts);
    }
    // If best moves are drawn, rings get no labels, because the moves need the space. The key
    // explains the rings.
    if (layers.risk && !layers.moves)
      LabelRings(map, state, forecasts.courses, space, layout, fonts);
  }
};

FarmPainter::FarmPainter(ImageSize size, const Style& style)
    : parts_(std::make_unique<Parts>(size, style)) {}
FarmPainter::~FarmPainter() = default;
FarmPainter::FarmPainter(FarmPainter&&) noexcept = default;
FarmPainter& FarmPainter::operator=(FarmPainter&&) noexcept = default;

const cv::Mat& FarmPainter::Draw(const FarmSpec& spec, const FarmState& state,
                                 const Overlays& overlays) {
  Parts& p = *parts_;
  const bool is_new = p.PrepareBackground(spec, overlays.layers.sea);
  p.background.copyTo(p.image);
  cv::Mat map = p.image(p.layout.map);
  const Layers& layers = overlays.layers;
  const Values* values = overlays.values;
  if (values != nullptr && (values->width != spec.width || values->height != spec.height)) {
    values = nullptr;
  }
  p.Follow(values, is_new);
  if (layers.values && values != nullptr) {
    if (p.valued.empty()) {
      DrawValues(map, spec, *values, p.layout);
      p.valued = map.clone();
    } else {
      p.valued.copyTo(map);
    }
  }
  Forecasts forecasts;
  forecasts.courses = p.courses.Read(spec, state);
  forecasts.outlook = ComputeOutlook(spec, state, forecasts.courses);
  // Without the layer `risk`, devices in danger have no circles, which would block space.
  FreeSpace space =
      BlockSymbols(spec, state, layers.risk ? forecasts.outlook : Outlook(), p.layout);
  const bool has_route = layers.route && overlays.route != nullptr;  // the route contains the trail
  if (layers.trail && overlays.trail != nullptr && !has_route) {
    DrawPaths(map, state, *overlays.trail, p.layout);
  }
  const auto marks =
      p.DrawDisasters(map, spec, state, forecasts, layers.risk, layers.values && values != nullptr);
  if (has_route) DrawPaths(map, state, *overlays.route, p.layout);
  if (layers.sight) DrawSight(map, spec, state, p.layout);
  if (layers.directions) {
    if (!p.directions) p.directions = LegalDirections(spec);
    DrawDirections(map, *p.directions, p.layout);
    BlockDirections(*p.directions, p.layout, space);
  }
  DrawPorts(map, spec, p.layout, p.fonts);
  DrawDevices(map, spec, state, p.layout);
  DrawShips(map, spec, state, overlays.trail, p.layout);
  if (overlays.choice != nullptr) DrawChoice(map, spec, state, *overlays.choice, p.layout);
  if (!DrawPanel(p.image, spec, state, overlays, values, forecasts, p.coast, p.layout, p.fonts)) {
    p.DrawPolicyKey(map, state, overlays, values, space);
  }
  LabelSpace labels(space, spec, p.layout);
  p.Label(map, spec, state, overlays, forecasts, labels);
  FreeSpace left = labels.space(Cover::kPathsAndLand);
  LabelMarks(map, marks, left, p.layout, p.fonts);
  if (layers.moves && values != nullptr) {  // last, so that they are drawn only where space is free
    if (!p.moves) p.moves.emplace(p.layout);
    p.moves->Draw(map, *values, &left);
  }
  DrawWords(p.image, spec, state, overlays, forecasts.outlook, p.layout, p.fonts);
  return p.image;
}

cv::Mat DrawFarm(const FarmSpec& spec, const FarmState& state, ImageSize size,
                 const Overlays& overlays, const Style& style) {
  if (const auto fault = CheckSpec(spec); !fault.empty()) throw std::invalid_argument(fault);
  if (const auto fault = CheckState(state); !fault.empty()) throw std::invalid_argument(fault);
  return FarmPainter(size, style).Draw(spec, state, overlays).clone();
}

}  // namespace aquafarm_viz
