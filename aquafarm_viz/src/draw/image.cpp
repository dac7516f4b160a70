// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/draw/image.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "aquafarm_viz/base/checks.h"
#include "draw/region.h"
#include "draw/symbols.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

// Returns true if two episodes have the same background.
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

// Returns true if two maps look the same. Compares bytes, because NaN means that there is no value.
bool SameMap(const Values& a, const Values& b) {
  return a.width == b.width && a.height == b.height && a.lowest == b.lowest &&
         a.highest == b.highest && a.actions == b.actions &&
         std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)) == 0;
}

}  // namespace

struct FarmPainter::Parts {
  explicit Parts(ImageSize wanted)
      : size{std::clamp(wanted.width, kMinImageSide, kMaxImageSide),
             std::clamp(wanted.height, kMinImageSide, kMaxImageSide)},
        fonts(MakeLayout(1, 1, size).unit) {}

  ImageSize size;
  Fonts fonts;
  Layout layout;
  FarmSpec drawn;   // spec of the background
  std::string sea;  // sea layer of the background
  cv::Mat background;
  std::optional<std::vector<PortDirections>> directions;  // of the spec; nullopt before use
  std::vector<std::vector<TrackPoint>> tracks;            // of the background's scenario
  cv::Mat1b land;                                         // IslandCoverage of the background
  std::optional<MoveSigns> moves;  // for the layout; nullopt before the first use
  Values values;                   // values drawn in `valued`
  cv::Mat valued;                  // map of the background with V_π; empty if not drawn yet
  cv::Mat image;

  /// Clears the cache if the values or the background have changed.
  void Follow(const Values* now, bool is_new_background) {
    const bool is_new = now != nullptr && !SameMap(*now, values);
    if (is_new) values = *now;
    if (is_new || is_new_background) valued.release();
  }
};

FarmPainter::FarmPainter(ImageSize size) : parts_(std::make_unique<Parts>(size)) {}
FarmPainter::~FarmPainter() = default;
FarmPainter::FarmPainter(FarmPainter&&) noexcept = default;
FarmPainter& FarmPainter::operator=(FarmPainter&&) noexcept = default;

const cv::Mat& FarmPainter::Draw(const FarmSpec& spec, const FarmState& state,
                                 const Overlays& overlays) {
  Parts& p = *parts_;
  const std::string& sea = overlays.layers.sea;
  const bool same_sea =
      sea == p.sea && (sea.empty() || spec.scenario_yaml == p.drawn.scenario_yaml);
  const bool is_new = p.background.empty() || !SameBackground(spec, p.drawn) || !same_sea;
  if (is_new) {
    p.background.release();  // stays empty if DrawSea throws
    p.layout = MakeLayout(spec.width, spec.height, p.size);
    p.moves.reset();
    p.directions.reset();
    cv::Mat background = DrawBackground(spec, p.layout, p.fonts, p.size);
    cv::Mat below = background(p.layout.map);
    if (!sea.empty()) DrawSea(below, spec, sea, p.layout, p.fonts);
    p.background = background;
    p.tracks = ReadTracks(spec.scenario_yaml);
    p.land = IslandCoverage(spec, p.layout);
    p.drawn = spec;
    p.sea = sea;
  }
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
      DrawValues(map, *values);
      p.valued = map.clone();
    } else {
      p.valued.copyTo(map);
    }
  }
  if (layers.trail && overlays.trail != nullptr) DrawTrails(map, state, *overlays.trail, p.layout);
  if (layers.risk) ShadeDisasters(map, state, p.land, p.layout);
  if (layers.route && overlays.route != nullptr) DrawRoutes(map, state, *overlays.route, p.layout);
  if (layers.sight) DrawSight(map, spec, state, p.layout);
  if (layers.moves && values != nullptr) {
    if (!p.moves) p.moves.emplace(p.layout);
    p.moves->Draw(map, *values);
  }
  if (layers.directions) {
    if (!p.directions) p.directions = LegalDirections(spec);
    DrawDirections(map, *p.directions, p.layout);
  }
  DrawPorts(map, spec, p.layout, p.fonts);
  DrawDevices(map, spec, state, p.layout);
  if (layers.labels) DrawLabels(map, spec, state, p.layout, p.fonts);
  DrawDisasterSigns(map, spec, state, p.layout, p.fonts);
  DrawShips(map, spec, state, overlays.trail, p.layout, p.fonts);
  if (overlays.choice != nullptr) DrawChoice(map, state, *overlays.choice, p.layout, p.fonts);
  if (layers.values && values != nullptr) DrawValueScale(map, *values, p.layout, p.fonts);
  DrawWords(p.image, spec, state, overlays, p.tracks, p.layout, p.fonts);
  return p.image;
}

cv::Mat DrawFarm(const FarmSpec& spec, const FarmState& state, ImageSize size,
                 const Overlays& overlays) {
  if (const auto fault = CheckSpec(spec); !fault.empty()) throw std::invalid_argument(fault);
  if (const auto fault = CheckState(state); !fault.empty()) throw std::invalid_argument(fault);
  return FarmPainter(size).Draw(spec, state, overlays).clone();
}

}  // namespace aquafarm_viz
