// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>
#include <tuple>

#include "aquafarm_viz/base/text.h"
#include "aquafarm_viz/scene/labels.h"
#include "draw/legend.h"
#include "draw/region.h"
#include "draw/symbols.h"
#include "scene/graticule.h"
#include "scene/nautical.h"
#include "scene/outlook_text.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DeviceState;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;
using aquafarm_msgs::ShipState;

struct ColoredText {
  std::string text;
  Rgb color;
};

// Draws the lists of the panel from its top down to the legend.
class Panel {
 public:
  /// @param legend_px  height of the legend below the lists
  Panel(cv::Mat& image, int legend_px, const Layout& layout, const Fonts& fonts)
      : image_(image),
        layout_(layout),
        fonts_(fonts),
        left_(layout.panel.x + layout.Px(10)),
        right_(layout.panel.x + layout.panel.width - layout.Px(8)),
        y_(layout.panel.y + layout.Px(8)),
        end_(layout.panel.y + layout.panel.height - legend_px) {}

  int RowsLeft() const { return std::max(0, (end_ - y_) / RowPx()); }
  int RowPx() const { return layout_.Px(17); }
  cv::Point2d SymbolAt() const { return {double(left_ + layout_.Px(7)), y_ + RowPx() / 2.0}; }
  cv::Point2d SecondSymbolAt() const { return {double(Middle() + layout_.Px(7)), SymbolAt().y}; }
  cv::Mat& image() { return image_; }
  /// Returns the part of the panel between the lists and the legend [pixels].
  cv::Rect Room() const {
    return {left_, y_ + layout_.Px(8), right_ - left_, end_ - y_ - layout_.Px(8)};
  }

  void Heading(const std::string& text, const std::string& right_text) {
    y_ += layout_.Px(5);
    Row(left_, text, fonts_.bold, layout_.style->faint, right_text, layout_.style->faint);
  }

  void Item(const std::string& text, const std::string& right_text, Rgb right_color) {
    Row(left_ + layout_.Px(21), text, fonts_.small, layout_.style->words, right_text, right_color);
  }

  /// Returns whether two texts fit next to each other in a row of Item or Detail.
  bool Fits(const std::string& text, const std::string& right_text) const {
    const int gap = layout_.Px(6);
    return fonts_.small.Width(text) + gap + fonts_.small.Width(right_text) <=
           right_ - left_ - layout_.Px(21);
  }

  /// Draws two texts with space for a symbol before each (SymbolAt, SecondSymbolAt).
  void Pair(const ColoredText& first, const ColoredText& second) {
    const int base = y_ + (RowPx() + fonts_.small.cap_height()) / 2;
    const auto draw = [&](const ColoredText& one, int left) {
      fonts_.small.Draw(image_, one.text, {left + layout_.Px(21), base}, Bgr(one.color));
    };
    draw(first, left_);
    draw(second, Middle());
    y_ += RowPx();
  }

  /// Returns whether a text fits in one half of a row (Pair).
  bool FitsInHalf(const std::string& text) const {
    return fonts_.small.Width(text) <= Middle() - left_ - layout_.Px(21 + 4);
  }

  /// Draws the colour scale of values, with the lowest value on the left.
  void ValueBar() {
    const int top = y_ + layout_.Px(3);
    for (int x = left_; x < right_; ++x) {
      cv::rectangle(image_, cv::Rect(x, top, 1, RowPx() - layout_.Px(5)),
                    Bgr(ValueColor(double(x - left_) / std::max(1, right_ - left_ - 1))),
                    cv::FILLED);
    }
    y_ += RowPx();
  }

  /// Draws two texts at the ends of a row, and one in its middle if there is space for it.
  void Ends(const std::string& left_text, const std::string& right_text,
            const std::string& middle_text = "") {
    const int base = y_ + (RowPx() + fonts_.small.cap_height()) / 2;
    const int half = fonts_.small.Width(middle_text) / 2 + layout_.Px(6);
    if (left_ + fonts_.small.Width(left_text) < Middle() - half &&
        right_ - fonts_.small.Width(right_text) > Middle() + half) {
      fonts_.small.Draw(image_, middle_text, {Middle() - half + layout_.Px(6), base},
                        Bgr(layout_.style->words));
    }
    Row(left_, left_text, fonts_.small, layout_.style->words, right_text, layout_.style->words);
  }

  void Detail(const std::string& text, const std::string& right_text, Rgb right_color) {
    Row(left_ + layout_.Px(21), text, fonts_.small, layout_.style->faint, right_text, right_color);
  }

 private:
  int Middle() const { return (left_ + right_) / 2; }

  void Row(int left, const std::string& text, const Font& font, Rgb color,
           const std::string& right_text, Rgb right_color) {
    const int base = y_ + (RowPx() + fonts_.small.cap_height()) / 2;
    const int right_from = right_ - fonts_.small.Width(right_text);
    font.Draw(image_, font.Fit(text, right_from - left - layout_.Px(3)), {left, base}, Bgr(color));
    fonts_.small.Draw(image_, right_text, {right_from, base}, Bgr(right_color));
    y_ += RowPx();
  }

  cv::Mat& image_;
  const Layout& layout_;
  const Fonts& fonts_;
  int left_;
  int right_;
  int y_;
  int end_;
};

// Returns when a device was fetched, and its port: "fetched 0:27", "port B". Unknown parts are
// empty.
std::pair<std::string, std::string> TripOf(const FarmSpec& spec, const DeviceState& device,
                                           const Trail* trail) {
  const auto at = trail == nullptr ? std::nullopt : trail->FetchedAt(device.id);
  const std::string fetched = at ? "fetched " + TimeOfDay(spec, *at) : "";
  for (const auto& port : spec.ports) {
    const bool is_there = port.cell.x == device.x && port.cell.y == device.y;
    if (is_there && device.status == DeviceState::DELIVERED) {
      return {fetched, "port " + PortLetter(port.id)};
    }
  }
  return {fetched, ""};
}

// Returns the health and the value of a device: "health 88 %", "value 80".
std::pair<std::string, std::string> HealthAndValue(const DeviceState& device) {
  const std::string health = Number(100.0 * double(device.health), 0) + " %";
  return {device.health_known ? "health " + health : "",
          "value " + Number(double(device.value), 0)};
}

// Draws two rows for a device in danger: the first ring in the first row, worse ones in the second.
// Each row has the colour of its worst ring.
void ListDanger(Panel& panel, const FarmSpec& spec, const DeviceState& device,
                const DeviceOutlook& outlook, const Layout& layout) {
  const auto [first, worse] = FirstAndWorse(
      spec, outlook, [&panel](const std::string& text) { return panel.Fits("", text); });
  const double risk = outlook.risk_now < 0.0 ? outlook.risk_now : outlook.arrivals.front().risk;
  panel.Item(DeviceLabel(device.id) + " " + DeviceName(device.kind), first,
             RiskColor(risk, layout));
  panel.Detail("", worse.empty() ? HealthAndValue(device).first : worse,
               worse.empty() ? layout.style->faint : RiskColor(WorstRisk(outlook), layout));
}

// Draws one row for each device with its symbol, its kind, and its danger or status.
// @param has_details  true: draws a second row for each device
void ListEachDevice(Panel& panel, const FarmSpec& spec, const FarmState& state, const Trail* trail,
                    const Outlook& outlook, bool has_details, const Layout& layout) {
  for (const auto& device : state.devices) {
    const bool done = device.status == DeviceState::DELIVERED;
    DrawDeviceSymbol(panel.image(), device.kind, {panel.SymbolAt(), 6.0 * layout.unit, 0.0},
                     done ? 0.5 : 0.0);
    std::string status = done ? "safe" : StatusName(device.status);
    if (const auto at = trail == nullptr ? std::nullopt : trail->ChangedAt(device.id)) {
      status += " " + TimeOfDay(spec, *at);
    }
    Rgb color = done ? layout.style->good : layout.style->faint;
    std::string name = DeviceLabel(device.id) + " " + DeviceName(device.kind);
    const DeviceOutlook* danger = nullptr;
    for (const DeviceOutlook& one : outlook.devices) {
      if (one.id == device.id && !DangerText(spec, one).empty()) danger = &one;
    }
    if (danger != nullptr && has_details) {
      ListDanger(panel, spec, device, *danger, layout);
      continue;
    }
    if (danger != nullptr) {
      color = RiskColor(WorstRisk(*danger), layout);
      std::tie(name, status) = NameAndDanger(
          spec, DeviceName(device.kind), *danger,
          [&panel](const auto& left, const auto& right) { return panel.Fits(left, right); });
    }
    panel.Item(name, status, color);
    if (!has_details) continue;
    const auto [left, right] = device.status == DeviceState::DEPLOYED ? HealthAndValue(device)
                                                                      : TripOf(spec, device, trail);
    panel.Detail(left, right, layout.style->faint);
  }
}

// Returns the label of a device with its danger or status: the longest text that fits in half a
// row.
ColoredText DeviceInHalf(const Panel& panel, const FarmSpec& spec, const DeviceState& device,
                         const Trail* trail, const Outlook& outlook, const Layout& layout) {
  const bool done = device.status == DeviceState::DELIVERED;
  const std::string status = done ? "safe" : StatusName(device.status);
  const auto at = trail == nullptr ? std::nullopt : trail->ChangedAt(device.id);
  for (const DeviceOutlook& one : outlook.devices) {
    if (one.id != device.id || !(WorstRisk(one) < 0.0)) continue;
    const auto [name, danger] = NameAndDanger(spec, DeviceName(device.kind), one,
                                              [&panel](const auto& left, const auto& right) {
                                                return panel.FitsInHalf(left + " " + right);
                                              });
    return {name + " " + danger, RiskColor(WorstRisk(one), layout)};
  }
  const std::string text = DeviceLabel(device.id) + " " + status;
  const std::string longer = at ? text + " " + TimeOfDay(spec, *at) : text;
  return {panel.FitsInHalf(longer) ? longer : text,
          done ? layout.style->good : layout.style->faint};
}

// Draws two devices in each row. The left column contains the first half of the devices.
void ListInHalves(Panel& panel, const FarmSpec& spec, const FarmState& state, const Trail* trail,
                  const Outlook& outlook, const Layout& layout) {
  const std::size_t rows = (state.devices.size() + 1) / 2;
  for (std::size_t row = 0; row < rows; ++row) {
    std::array<ColoredText, 2> halves;
    const std::array<cv::Point2d, 2> symbols{panel.SymbolAt(), panel.SecondSymbolAt()};
    for (std::size_t half = 0; half < 2; ++half) {
      if (row + half * rows >= state.devices.size()) continue;
      const DeviceState& device = state.devices[row + half * rows];
      DrawDeviceSymbol(panel.image(), device.kind, {symbols[half], 6.0 * layout.unit, 0.0},
                       device.status == DeviceState::DELIVERED ? 0.5 : 0.0);
      halves[half] = DeviceInHalf(panel, spec, device, trail, outlook, layout);
    }
    panel.Pair(halves[0], halves[1]);
  }
}

void ListKinds(Panel& panel, const FarmState& state, const Layout& layout) {
  constexpr std::size_t kKinds = 4;
  std::array<int, kKinds> total{};
  std::array<int, kKinds> delivered{};
  for (const auto& device : state.devices) {
    if (device.kind >= kKinds) continue;
    ++total[device.kind];
    delivered[device.kind] += device.status == DeviceState::DELIVERED ? 1 : 0;
  }
  for (std::uint8_t kind = 0; kind < kKinds; ++kind) {
    DrawDeviceSymbol(panel.image(), kind, {panel.SymbolAt(), 6.0 * layout.unit, 0.0},
                     total[kind] == 0 ? 0.75 : 0.0);
    panel.Item(DeviceName(kind),
               std::to_string(delivered[kind]) + " / " + std::to_string(total[kind]),
               layout.style->faint);
  }
}

void ListDevices(Panel& panel, const FarmSpec& spec, const FarmState& state, const Trail* trail,
                 const Outlook& outlook, const Layout& layout) {
  constexpr std::size_t kMaxRows = 6;
  constexpr int kRowsBelow = 8;      // kept free for disasters and ships
  constexpr int kRowsOfRegion = 12;  // kept free for headings and the region
  const auto delivered = std::count_if(
      state.devices.begin(), state.devices.end(),
      [](const DeviceState& device) { return device.status == DeviceState::DELIVERED; });
  const std::string zone = spec.has_start_time && trail != nullptr ? ", " + ZoneText(spec) : "";
  panel.Heading("DEVICES" + zone,
                std::to_string(delivered) + " / " + std::to_string(state.devices.size()) + " safe");
  if (state.devices.size() <= kMaxRows) {
    const auto rows = 2 * state.devices.size() + 3 * state.disasters.size() + state.ships.size();
    const bool has_details = panel.RowsLeft() >= static_cast<int>(rows) + kRowsOfRegion;
    ListEachDevice(panel, spec, state, trail, outlook, has_details, layout);
  } else if (state.devices.size() <= 2 * kMaxRows &&
             panel.RowsLeft() >= int(kMaxRows) + kRowsBelow) {
    ListInHalves(panel, spec, state, trail, outlook, layout);
  } else {
    ListKinds(panel, state, layout);
  }
}

void ListDisasters(Panel& panel, const FarmSpec& spec, const FarmState& state,
                   const std::vector<Course>& courses, const Layout& layout, int rows) {
  static constexpr std::array<const char*, 5> kGrades{"", "blue alert", "yellow alert",
                                                      "orange alert", "red alert"};
  int shown = 0;
  panel.Heading("DISASTERS", "");
  for (std::size_t i = 0; i < state.disasters.size(); ++i) {
    const auto& disaster = state.disasters[i];
    if (!disaster.known || 3 * (shown + 1) > rows) continue;
    ++shown;
    const bool over = disaster.steps_left <= 0;
    FillCircle(panel.image(), panel.SymbolAt(), 5.5 * layout.unit,
               Bgr(over ? layout.style->rule : GradeColor(disaster.grade)));
    const std::string kind = NameNow(disaster, courses[i]);
    const std::string grade = over                              ? "over"
                              : disaster.grade < kGrades.size() ? kGrades[disaster.grade]
                                                                : "";
    const Rgb color = over ? layout.style->faint : layout.style->GradeText(disaster.grade);
    const std::string left =
        over ? ""
        : spec.step_duration_s > 0.0
            ? "ends in " + HoursText(disaster.steps_left * spec.step_duration_s)
            : Count(std::uint64_t(disaster.steps_left)) + " steps left";
    const std::string known =
        disaster.visible ? left : "seen " + std::to_string(disaster.age) + " ago";
    const std::string motion = MotionNow(spec, disaster);
    std::string wind = over ? "" : WindText(courses[i].ahead.front());
    const std::string both = grade + (known.empty() ? "" : ", " + known);
    if (wind.empty() && panel.Fits(motion, known)) {
      panel.Item(kind, grade, color);
      panel.Detail(motion, known, layout.style->words);
      continue;
    }
    if (panel.Fits(kind, both) && panel.Fits(motion, "wind " + wind)) {
      panel.Item(kind, both, color);
      panel.Detail(motion, "wind " + wind, layout.style->words);
      continue;
    }
    panel.Item(kind, grade, color);
    panel.Detail(motion, "", layout.style->faint);
    if (!wind.empty() && panel.Fits(known, "wind " + wind)) wind = "wind " + wind;
    panel.Detail(known, wind, layout.style->words);
  }
  if (shown == 0) panel.Detail("none known", "", layout.style->faint);
}

void ListShips(Panel& panel, const FarmSpec& spec, const FarmState& state, const Layout& layout) {
  panel.Heading("SHIPS", "");
  int rows = panel.RowsLeft();
  std::size_t left_out = 0;
  for (const auto& ship : state.ships) {
    const bool is_last = &ship == &state.ships.back();
    if (!ship.visible || rows < (is_last ? 2 : 3)) {
      ++left_out;
      continue;
    }
    rows -= 2;
    if (ship.own_device >= 0) {
      StrokeCircle(panel.image(), panel.SymbolAt(), 5.0 * layout.unit, Bgr(layout.style->words),
                   layout.Px(2));
    } else {
      const Pose2 placing{panel.SymbolAt(), 7.5 * layout.unit, 0.0};
      StrokeShape(panel.image(), HullOutline(), placing, Bgr(kInk), layout.Px(2));
      FillShape(panel.image(), HullOutline(), placing, Bgr(kPaper));
      FillShape(panel.image(), HullOutline(), {placing.at, 4.5 * layout.unit, 0.0},
                Bgr(ShipColor(ship.id)));
    }
    const std::string name = ship.own_device >= 0 ? "device " + std::to_string(ship.own_device)
                                                  : "ship " + std::to_string(ship.id);
    // If HasGraticule is true, the axes of the map do not number the cells.
    const std::string cell =
        HasGraticule(spec) ? ""
                           : "(" + std::to_string(ship.x) + ", " + std::to_string(ship.y) + ")";
    const std::string fault = OutcomeName(ship.outcome);
    const std::string action = ActionName(ship.action) + (fault.empty() ? "" : ": " + fault);
    const std::string load = ship.own_device >= 0 ? ""
                                                  : std::to_string(ship.aboard.size()) + "/" +
                                                        std::to_string(ship.capacity) + " aboard";
    const std::string where = cell + (cell.empty() || load.empty() ? "" : ", ") + load;
    if (panel.Fits(name + ": " + action, where)) {
      panel.Item(name + ": " + action, where, layout.style->faint);
      ++rows;
      continue;
    }
    panel.Item(name, cell, layout.style->faint);
    panel.Detail(action, load, layout.style->faint);
  }
  if (left_out > 0 && rows > 0) {
    panel.Detail("and " + std::to_string(left_out) + " more", "", layout.style->faint);
  }
}

std::string PolicyName(const Overlays& overlays) {
  if (overlays.choice != nullptr) return overlays.choice->policy;
  return overlays.training != nullptr ? overlays.training->algorithm : "";
}

// Returns the choice of a compared policy (PolicyChoice) as text, one line for each ship.
std::vector<std::string> ChoiceLines(const FarmState& state, const Overlays& overlays) {
  std::vector<std::string> lines;
  if (overlays.choice == nullptr || !IsOf(*overlays.choice, state)) return lines;
  for (const auto& ship : state.ships) {
    const std::string words = ChoiceText(*overlays.choice, ship);
    if (words.empty()) continue;
    lines.push_back(state.ships.size() > 1 ? "ship " + std::to_string(ship.id) + ": " + words
                                           : "would choose " + words);
  }
  return lines;
}

// Returns whether the symbol of a greedy pickup or drop-off is visible on the map. The symbols of
// ports and devices cover most of these symbols.
bool HasPickupSigns(const FarmSpec& spec, const FarmState& state, const Values& values, int every) {
  const auto is_covered = [&](cv::Point cell) {
    return std::any_of(
               spec.ports.begin(), spec.ports.end(),
               [&](const auto& port) { return port.cell.x == cell.x && port.cell.y == cell.y; }) ||
           std::any_of(state.devices.begin(), state.devices.end(), [&](const auto& device) {
             return device.status == DeviceState::DEPLOYED && device.x == cell.x &&
                    device.y == cell.y;
           });
  };
  const auto shown = ShownActions(values, every);
  return std::any_of(shown.begin(), shown.end(), [&](cv::Point cell) {
    return values.actions[values.Index(cell.x, cell.y)] >= 8 && !is_covered(cell);
  });
}

// Explains the colours and symbols of a policy, if there is a policy and space for the explanation.
// Returns whether the explanation was drawn.
bool ListPolicy(Panel& panel, const FarmSpec& spec, const FarmState& state,
                const Overlays& overlays, const Values* values, const Layout& layout) {
  const std::vector<std::string> choices = ChoiceLines(state, overlays);
  const bool has_scale =
      overlays.layers.values && values != nullptr && values->highest > values->lowest;
  const bool has_moves = overlays.layers.moves && values != nullptr;
  const int every = MoveSpacing(layout);
  const bool has_signs = has_moves && HasPickupSigns(spec, state, *values, every);
  const int rows =
      (has_scale ? 3 : 0) + (has_moves ? 1 : 0) + (has_signs ? 1 : 0) + int(choices.size());
  if (rows == 0 || panel.RowsLeft() < rows + 2) return false;
  const bool has_step = values != nullptr && values->step;
  panel.Heading("POLICY " + PolicyName(overlays), has_step ? "step " + Count(*values->step) : "");
  if (has_scale) {
    panel.Ends("discounted return from each cell", "");
    panel.ValueBar();
    const auto low = double(values->lowest);
    const auto high = double(values->highest);
    panel.Ends(Number(low, 1), Number(high, 1) + " points", Number((low + high) / 2.0, 1));
  }
  if (has_moves) {
    DrawMove(panel.image(), panel.SymbolAt(), 3, 13.0 * layout.unit, layout);
    panel.Item(every == 1 ? "best move" : "best move, every " + std::to_string(every) + " cells",
               "", layout.style->words);
  }
  if (has_signs) {
    DrawMove(panel.image(), panel.SymbolAt(), 8, 15.0 * layout.unit, layout);
    DrawMove(panel.image(), panel.SecondSymbolAt(), 9, 15.0 * layout.unit, layout);
    panel.Pair({"pickup", layout.style->words}, {"drop-off", layout.style->words});
  }
  for (const std::string& line : choices) {
    DrawArrow(panel.image(), panel.SymbolAt(), 90, 15.0 * layout.unit, Bgr(kChoiceColor),
              layout.Px(2.5));
    panel.Item(line, "", layout.style->words);
  }
  return true;
}

}  // namespace

bool DrawPanel(cv::Mat& image, const FarmSpec& spec, const FarmState& state,
               const Overlays& overlays, const Values* values, const Forecasts& forecasts,
               const std::vector<CoastRing>& coast, const Layout& layout, const Fonts& fonts) {
  if (!HasLegend(layout)) return false;
  const RiskKey key = MakeRiskKey(state, forecasts.courses);
  const std::vector<Sign> signs = SignsOf(spec, state, overlays, forecasts.outlook, key, layout);
  DrawSigns(image, key, signs, state, layout, fonts);
  const bool has_values = overlays.layers.values && values != nullptr;
  DrawRiskKey(image, key, /*is_filled=*/!has_values, signs, layout, fonts);
  if (layout.panel.empty()) return false;
  Panel panel(image, LegendPx(key, signs, layout), layout, fonts);
  const Trail* trail = overlays.trail != nullptr ? overlays.trail : overlays.route;
  ListDevices(panel, spec, state, trail, forecasts.outlook, layout);
  ListDisasters(panel, spec, state, forecasts.courses, layout, std::max(3, panel.RowsLeft() - 7));
  ListShips(panel, spec, state, layout);
  const bool has_policy = ListPolicy(panel, spec, state, overlays, values, layout);
  DrawRegion(image, panel.Room(), spec, state, forecasts.courses, coast, layout, fonts);
  return has_policy;
}

}  // namespace aquafarm_viz
