// SPDX-License-Identifier: BSD-3-Clause
#include "markers/legend.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "aquafarm_viz/base/palette.h"
#include "aquafarm_viz/base/text.h"
#include "aquafarm_viz/names.h"
#include "base/marker_color.h"
#include "base/text_scale.h"
#include "markers/maker.h"
#include "scene/arrow.h"
#include "scene/nautical.h"
#include "scene/storm_track.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::FarmSpec;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

// Adds the parts of one line of the legend next to each other, below the map.
class Row {
 public:
  // @param line  0 is the uppermost line, below the names of the axis
  // @param space  namespace of bars and symbols; that of texts has "_text" appended
  Row(MarkerArray& array, const FarmSpec& spec, int line, std::string space)
      : array_(array),
        header_(spec.header),
        space_(std::move(space)),
        size_m_(0.03 * TextScale(spec) * std::max(spec.width, spec.height) * spec.cell_size_m),
        x_m_(-0.5 * spec.cell_size_m),
        y_m_(-0.5 * spec.cell_size_m - (2.1 + 1.3 * line) * size_m_) {
    header_.frame_id = names::kMapFrame;
  }

  double size_m() const { return size_m_; }
  void Skip(double width_m) { x_m_ += width_m; }

  void Bar(double width_m, Rgb color) {
    Marker bar = Make(space_, Marker::CUBE, x_m_ + 0.5 * width_m);
    bar.scale.x = width_m;
    bar.scale.y = 0.35 * size_m_;
    bar.scale.z = 0.01 * size_m_;
    bar.color = Color(color);
    array_.markers.push_back(bar);
    x_m_ += width_m + 0.4 * size_m_;
  }

  // Adds a bar with the colours of values, the lowest value on the left.
  void ValueBar(double width_m) {
    constexpr int kParts = 32;
    Marker bar = Make(space_, Marker::TRIANGLE_LIST, x_m_);
    bar.scale.x = bar.scale.y = bar.scale.z = 1.0;
    bar.color = Color(kPaper);
    const double half_m = 0.25 * size_m_;
    for (int i = 0; i < kParts; ++i) {
      const double left = width_m * i / kParts;
      const double right = width_m * (i + 1) / kParts;
      for (const auto& [x, y] : {std::pair(left, -half_m),
                                 {right, -half_m},
                                 {right, half_m},
                                 {left, -half_m},
                                 {right, half_m},
                                 {left, half_m}}) {
        geometry_msgs::Point corner;
        corner.x = x;
        corner.y = y;
        bar.points.push_back(corner);
        bar.colors.push_back(Color(ValueColor((i + 0.5) / kParts)));
      }
    }
    array_.markers.push_back(bar);
    x_m_ += width_m + 0.4 * size_m_;
  }

  // Adds the circle around a device in danger.
  void Circle() { Circles({0.45}); }
  // Adds the circles around a device that is hit first.
  void TwoCircles() { Circles({0.26, 0.5}); }

  // Adds the pattern of the rings.
  void Pattern() {
    Marker lines = MakeList();
    const double half_m = 0.45 * size_m_;
    const double width_m = 0.06 * size_m_;
    for (const double shift : {-1.0, 0.0, 1.0}) {  // three diagonal lines
      const double from = std::max(-half_m, -half_m + shift * half_m);
      const double to = std::min(half_m, half_m + shift * half_m);
      const double up_m = shift * half_m;
      for (const auto& [x, side] :
           {std::pair(from, 1.0), {to, 1.0}, {to, -1.0}, {from, 1.0}, {to, -1.0}, {from, -1.0}}) {
        lines.points.push_back(Point(x + side * width_m, x - up_m - side * width_m));
      }
    }
    lines.color = Color(SeverityColor(0.0));
    Put(lines);
  }

  // Adds the pointer towards a centre outside the farm.
  void Pointer() {
    Marker pointer = MakeList();
    AddFilled(pointer, PointerOutline(), 0.5 * size_m_);
    pointer.color = Color(GradeColor(3));
    Put(pointer);
  }

  // Adds the frame of a cell in which the best move is a pickup or a drop-off.
  void Frame(Rgb color) {
    Marker frame = MakeList();
    AddFrame(frame, 0.0, 0.0, 0.9 * size_m_);
    frame.color = Color(color);
    Put(frame);
  }

  // Adds the arrow of a best move.
  void Arrow() {
    Marker arrow = MakeList();
    AddArrow(arrow, 0.0, 0.0, 45, size_m_, 1.6);
    arrow.color = Color(kPaper);
    Put(arrow);
  }

  // Deletes the marker with the next id.
  void Remove(const std::string& space) {
    Marker marker = Make(space, Marker::CUBE, x_m_);
    marker.action = Marker::DELETE;
    array_.markers.push_back(marker);
  }

  void Text(const std::string& text) {
    const double width_m = TextWidth(text) * size_m_;
    Marker words = Make(space_ + "_text", Marker::TEXT_VIEW_FACING, x_m_ + 0.5 * width_m);
    words.scale.z = size_m_;
    words.text = text;
    words.color = Color(kPaper);
    array_.markers.push_back(words);
    x_m_ += width_m + 0.6 * size_m_;
  }

 private:
  // @param radii  outer radii of the circles [size_m()]
  void Circles(const std::vector<double>& radii) {
    Marker list = MakeList();
    for (const double radius : radii) {
      const double outer_m = radius * size_m_;
      const double inner_m = outer_m - 0.12 * size_m_;
      AddBand(list, {inner_m, inner_m, inner_m, inner_m}, {outer_m, outer_m, outer_m, outer_m});
    }
    list.color = Color(kPaper);
    Put(list);
  }

  Marker MakeList() {
    Marker list = Make(space_, Marker::TRIANGLE_LIST, x_m_ + 0.5 * size_m_);
    list.scale.x = list.scale.y = list.scale.z = 1.0;
    return list;
  }

  void Put(const Marker& symbol) {
    array_.markers.push_back(symbol);
    x_m_ += 1.4 * size_m_;
  }

  Marker Make(const std::string& space, int type, double x_m) {
    Marker marker;
    marker.header = header_;
    marker.ns = space;
    marker.id = next_id_++;
    marker.type = type;
    marker.action = Marker::ADD;
    marker.pose.position.x = x_m;
    marker.pose.position.y = y_m_;
    marker.pose.orientation.w = 1.0;
    return marker;
  }

  MarkerArray& array_;
  std_msgs::Header header_;
  std::string space_;
  double size_m_;
  double x_m_;
  double y_m_;
  int next_id_{0};
};

}  // namespace

void AddLegend(MarkerArray& array, const FarmSpec& spec) {
  Row row(array, spec, 0, "legend");
  const double length_m = RoundLength(0.2 * spec.width * spec.cell_size_m);
  row.Bar(length_m, kPaper);
  row.Text(length_m >= 1000.0 ? Number(length_m / 1000.0, 0) + " km"
                              : Number(length_m, length_m < 1.0 ? 2 : 0) + " m");
  row.Skip(row.size_m());
  row.Text("risk");
  for (const auto& [risk, name] : NamedRisks(spec)) {
    row.Bar(row.size_m(), SeverityColor(Severity(risk)));
    row.Text(name);
  }
}

void AddSignLegend(MarkerArray& array, const FarmSpec& spec, const MapSigns& signs) {
  Row row(array, spec, 1, "sign_legend");
  const auto text = [&row](bool is_shown, const char* words) {
    if (is_shown) return row.Text(words);
    row.Remove("sign_legend_text");
  };
  const auto symbol = [&row](bool is_shown, void (Row::*add)()) {
    if (is_shown) return (row.*add)();
    row.Remove("sign_legend");
  };
  symbol(signs.circle, &Row::Circle);
  text(signs.circle, "danger");
  symbol(signs.two_circles, &Row::TwoCircles);
  text(signs.two_circles, "hit first");
  symbol(signs.pointer, &Row::Pointer);
  text(signs.pointer, "to the centre");
  symbol(signs.pattern, &Row::Pattern);
  text(signs.pattern, "at risk");
  text(signs.dashes, "dashed: empty ship");
}

void AddValueLegend(MarkerArray& array, const FarmSpec& spec, const Values& values) {
  Row row(array, spec, 2, "value_legend");
  if (values.highest > values.lowest) {
    row.Text("value " + Number(double(values.lowest), 1));
    row.ValueBar(4.4 * row.size_m());
    row.Text(Number(double(values.highest), 1));
    row.Skip(0.6 * row.size_m());
  } else {  // for example, the policy has no values
    row.Remove("value_legend_text");
    row.Remove("value_legend");
    row.Remove("value_legend_text");
  }
  row.Arrow();
  row.Text("best move");
  constexpr std::uint8_t kPickup = 8;  // values of Command.action
  constexpr std::uint8_t kDropOff = 9;
  for (const auto& [action, name, color] :
       {std::tuple(kPickup, "pickup", kPickupColor), {kDropOff, "drop-off", kDropOffColor}}) {
    if (std::find(values.actions.begin(), values.actions.end(), action) != values.actions.end()) {
      row.Frame(color);
      row.Text(name);
    } else {
      row.Remove("value_legend");
      row.Remove("value_legend_text");
    }
  }
}

}  // namespace aquafarm_viz
