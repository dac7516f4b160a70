// SPDX-License-Identifier: BSD-3-Clause
#include "markers/axes.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "scene/graticule.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::FarmSpec;
using visualization_msgs::MarkerArray;

constexpr Rgb kTickColor{0xb4, 0xc3, 0xd0};

// Formats degrees and minutes of arc as in navigational warnings: 30-06N. rviz's font has no degree
// sign.
std::string ArcText(int minutes, char positive, char negative) {
  const int all = std::abs(minutes);
  const std::string rest = std::to_string(all % 60);
  return std::to_string(all / 60) + "-" + (rest.size() < 2 ? "0" : "") + rest +
         (minutes < 0 ? negative : positive);
}

// Adds ticks and their names below the farm and on its left.
class Axes {
 public:
  Axes(MarkerArray& array, const Maker& maker)
      : array_(array), maker_(maker), letter_(maker.line_m() / maker.cell_m()) {}

  // @param at  distance from the western edge [cells]
  void Below(double at, const std::string& text) {
    const double x = at - 0.5;
    Tick(x, -0.5 - 0.15 * letter_, /*is_below=*/true);
    Name(x, -0.5 - 0.95 * letter_, text);
  }

  // @param at  distance from the southern edge [cells]
  void Left(double at, const std::string& text) {
    const double y = at - 0.5;
    Tick(-0.5 - 0.15 * letter_, y, /*is_below=*/false);
    Name(-0.5 - (0.5 + 0.5 * TextWidth(text)) * letter_, y, text);
  }

 private:
  void Tick(double x, double y, bool is_below) {
    auto tick = maker_.Make("axis", next_id_++, visualization_msgs::Marker::CUBE, kLandLayer, x, y);
    const double length_m = 0.3 * maker_.line_m();
    const double width_m = 0.08 * maker_.line_m();
    tick.scale.x = is_below ? width_m : length_m;
    tick.scale.y = is_below ? length_m : width_m;
    tick.scale.z = 0.5 * maker_.layer_m();
    tick.color = Color(kTickColor);
    array_.markers.push_back(tick);
  }

  void Name(double x, double y, const std::string& text) {
    array_.markers.push_back(
        maker_.Text("axis", next_id_++, x, y, text, maker_.line_m(), kTickColor));
  }

  MarkerArray& array_;
  const Maker& maker_;
  double letter_;  // height [cells]
  int next_id_{};
};

}  // namespace

void AddAxes(MarkerArray& array, const Maker& maker, const FarmSpec& spec) {
  const double letter = maker.line_m() / maker.cell_m();
  Axes axes(array, maker);
  if (HasGraticule(spec)) {
    for (const auto& [minutes, at] : LongitudeTicks(spec, 6.0 * letter)) {
      axes.Below(at, ArcText(minutes, 'E', 'W'));
    }
    for (const auto& [minutes, at] : LatitudeTicks(spec, 2.5 * letter)) {
      axes.Left(at, ArcText(minutes, 'N', 'S'));
    }
    return;
  }
  const int step = CellTickStep(2.2 * letter);
  for (int x = 0; x < spec.width; x += step) axes.Below(x + 0.5, std::to_string(x));
  for (int y = 0; y < spec.height; y += step) axes.Left(y + 0.5, std::to_string(y));
}

}  // namespace aquafarm_viz
