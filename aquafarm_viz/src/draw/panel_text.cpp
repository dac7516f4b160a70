// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>

#include "aquafarm_viz/base/text.h"
#include "aquafarm_viz/scene/labels.h"
#include "draw/legend.h"
#include "draw/panel.h"
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
    const std::string name = kind + (wind.empty() ? "" : " " + wind);
    if (panel.Fits(name, grade) && panel.Fits(motion, known)) {
      panel.Item(name, grade, color);
      panel.Detail(motion, known, layout.style->words);
      continue;
    }
    panel.Item(kind, grade, color);
    panel.Detail(motion, "", layout.style->faint);
    if (!wind.empty() && panel.Fits(known, "wind " + wind)) wind = "wind " + wind;
    panel.Detail(known, wind, layout.style->words);
  }
  if (shown == 0) panel.Detail("none known", "", layout.style->faint);
}

// Returns the place of a ship: "port B", else its cell, "(9, 9)". If HasGraticule is true, the axes
// of the map do not number the cells, and the second text is empty.
std::string PlaceOf(const FarmSpec& spec, const ShipState& ship) {
  const std::string port = PortText(spec, ship.x, ship.y);
  if (!port.empty() || HasGraticule(spec)) return port;
  return "(" + std::to_string(ship.x) + ", " + std::to_string(ship.y) + ")";
}

void ListShips(Panel& panel, const FarmSpec& spec, const FarmState& state, const Layout& layout) {
  constexpr int kRowsOfPolicy = 8;  // kept free if there is no region
  panel.Heading("SHIPS", "");
  const int rows_kept = HasRegion(spec, state) ? Panel::kRowsOfRegion : kRowsOfPolicy;
  const bool has_details = panel.RowsLeft() >= 3 * int(state.ships.size()) + rows_kept;
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
    const std::string cell = PlaceOf(spec, ship);
    const std::string fault = OutcomeName(ship.outcome);
    const std::string action = ActionName(ship.action) + (fault.empty() ? "" : ": " + fault);
    const std::string load = ship.own_device >= 0 ? ""
                                                  : std::to_string(ship.aboard.size()) + "/" +
                                                        std::to_string(ship.capacity) + " aboard";
    const std::string where = cell + (cell.empty() || load.empty() ? "" : ", ") + load;
    if (panel.Fits(name + ": " + action, where)) {
      panel.Item(name + ": " + action, where, layout.style->faint);
      ++rows;
    } else {
      panel.Item(name, cell, layout.style->faint);
      panel.Detail(action, load, layout.style->faint);
    }
    if (!has_details) continue;
    const bool has_energy = ship.episode_energy > 0.0;  // 0 also if the scenario has no energy
    panel.Detail("sailed " + DistanceText(1000.0 * ship.episode_distance),
                 has_energy ? Number(ship.episode_energy, 0) + " kWh" : "", layout.style->faint);
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
    return !PortText(spec, cell.x, cell.y).empty() ||
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
    panel.Pair({{"pickup", layout.style->words}}, {{"drop-off", layout.style->words}});
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
  const bool has_risk = overlays.layers.risk;
  const RiskKey risks = has_risk ? MakeRiskKey(state, forecasts.courses) : RiskKey();
  const RiskKey* key = has_risk ? &risks : nullptr;
  const std::vector<Sign> signs = SignsOf(spec, state, overlays, forecasts.outlook, risks, layout);
  const bool has_values = overlays.layers.values && values != nullptr;
  DrawKeys(image, key, /*is_filled=*/!has_values, signs, state, layout, fonts);
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
