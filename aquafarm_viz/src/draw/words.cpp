// SPDX-License-Identifier: BSD-3-Clause
// Draws the texts above and below the map.
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "aquafarm_viz/base/text.h"
#include "aquafarm_viz/scene/labels.h"
#include "draw/symbols.h"
#include "scene/nautical.h"
#include "scene/outlook_text.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;
using aquafarm_msgs::TrainingStatus;

// Draws texts next to each other until the width of the line is used up.
class Line {
 public:
  Line(cv::Mat& image, cv::Point start, int right) : image_(image), at_(start), right_(right) {}

  void Put(const Font& font, const std::string& text, Rgb color, int gap_px) {
    if (at_.x >= right_) return;
    at_.x += font.Draw(image_, font.Fit(text, right_ - at_.x), at_, Bgr(color)) + gap_px;
  }

  /// Returns whether a text of this width fits.
  bool Has(int width_px) const { return at_.x + width_px <= right_; }

 private:
  cv::Mat& image_;
  cv::Point at_;
  int right_;
};

// Draws the danger in the first row: the longest headline that fits, in the largest font in which
// it fits, in the colour of the worst ring. Returns false if there is nothing to draw.
bool DrawDanger(cv::Mat& image, const FarmSpec& spec, const FarmState& state,
                const Outlook& outlook, cv::Point at, int width, const Layout& layout,
                const Fonts& fonts) {
  const std::vector<std::string> lines = Headlines(spec, state, outlook);
  if (lines.empty()) return false;
  const double worst = WorstRisk(outlook);
  const cv::Scalar color = Bgr(worst < 0.0 ? RiskTextColor(worst, layout) : layout.style->words);
  for (const std::string& line : lines) {
    for (const Font* font : {&fonts.title, &fonts.headline, &fonts.bold}) {
      if (font->Width(line) > width) continue;
      font->Draw(image, line, at, color);
      return true;
    }
  }
  fonts.bold.Draw(image, fonts.bold.Fit(lines.back(), width), at, color);
  return true;
}

// Draws two rows. The first row contains the danger or, if there is none, the scenario. After the
// end of an episode it is left to DrawEnd. The second row contains the scenario (if the first row
// does not), the episode, step, return and time. Its texts end before the time.
void DrawTop(cv::Mat& image, const FarmSpec& spec, const FarmState& state, const Outlook& outlook,
             const Layout& layout, const Fonts& fonts) {
  const int left = layout.Px(10);
  const int right = layout.top.width - layout.Px(10);
  const cv::Point first(left, layout.Px(18));
  const int second = layout.Px(36);
  const int gap = layout.Px(14);
  const std::string time = WorldTimeText(spec, state);
  const int time_left = right - fonts.small.Width(time);
  fonts.small.Draw(image, time, {time_left, second}, Bgr(layout.style->words));
  Line line(image, {left, second}, time_left - gap);
  const std::string name = spec.scenario_name.empty() ? "aquafarm" : spec.scenario_name;
  const bool is_over = state.terminated || state.truncated;
  if (is_over || DrawDanger(image, spec, state, outlook, first, right - left, layout, fonts)) {
    // A long name is cut, so that there is space for the step and the return.
    line.Put(fonts.bold, fonts.bold.Fit(name, (time_left - left) / 3), layout.style->words, gap);
  } else {
    fonts.title.Draw(image, fonts.title.Fit(name, right - left), first, Bgr(layout.style->words));
  }
  const auto pair = [&](const std::string& name_of, const std::string& value, Rgb color) {
    if (!line.Has(fonts.small.Width(name_of) + layout.Px(5) + fonts.bold.Width(value))) return;
    line.Put(fonts.small, name_of, layout.style->faint, layout.Px(5));
    line.Put(fonts.bold, value, color, gap);
  };
  pair("episode", Count(state.episode), layout.style->words);
  pair("step", Count(state.step) + " / " + Count(std::uint64_t(std::max(0, spec.step_limit))),
       layout.style->words);
  pair("return", Number(state.joint_return, 1),
       state.joint_return < 0.0F ? layout.style->bad : layout.style->good);
  if (state.paused) line.Put(fonts.bold, "paused", layout.style->GradeText(2), gap);
  if (state.observer >= 0)
    pair("as seen by ship", std::to_string(state.observer), layout.style->words);
  pair("seed", SeedText(state.seed), layout.style->faint);
}

// @param y  base of the line, from the upper edge of Layout::bottom down [design units]
void DrawRewardLine(cv::Mat& image, const FarmState& state, double y, const Layout& layout,
                    const Fonts& fonts) {
  Line line(image, {layout.Px(10), layout.bottom.y + layout.Px(y)},
            layout.bottom.width - layout.Px(10));
  const auto color = [&layout](float value) {
    return value == 0.0F ? layout.style->faint : value < 0 ? layout.style->bad : layout.style->good;
  };
  line.Put(fonts.bold, "reward", layout.style->words, layout.Px(5));
  line.Put(fonts.bold, Signed(state.joint_reward), color(state.joint_reward), layout.Px(16));
  for (const auto& [name, value] : RewardTermsOf(state)) {
    if (value == 0.0F && name == "energy") continue;  // most scenarios do not model energy
    line.Put(fonts.small, name, value == 0.0F ? layout.style->faint : layout.style->words,
             layout.Px(4));
    if (value == 0.0F) {
      line.Put(fonts.small, "0", layout.style->faint, layout.Px(11));
    } else {
      line.Put(fonts.bold, Signed(value), color(value), layout.Px(11));
    }
  }
}

void DrawTrainingLine(cv::Mat& image, const TrainingStatus& training, const Layout& layout,
                      const Fonts& fonts) {
  Line line(image, {layout.Px(10), layout.bottom.y + layout.Px(35)},
            layout.bottom.width - layout.Px(10));
  const int gap = layout.Px(11);
  const auto pair = [&](const std::string& name, const std::string& value) {
    line.Put(fonts.small, name, layout.style->faint, layout.Px(4));
    line.Put(fonts.small, value, layout.style->words, gap);
  };
  line.Put(fonts.bold, training.algorithm, layout.style->words, layout.Px(5));
  line.Put(fonts.small, PhaseName(training.phase), layout.style->faint, gap);
  pair("episodes",
       Count(training.episode) + (training.episodes > 0 ? " / " + Count(training.episodes) : ""));
  pair("mean return", Number(training.mean_return, 1));
  pair("success", Percent(double(training.success_rate)));
  if (training.steps_per_second > 0.0F) pair("steps/s", Rate(training.steps_per_second));
  if (const auto left = Duration(training.time_left_s); !left.empty()) pair("left", left);
}

// Writes why the episode ended: in the first row, or on a plate on the map if there are no rows.
void DrawEnd(cv::Mat& image, const FarmState& state, const Layout& layout, const Fonts& fonts) {
  if (!state.terminated && !state.truncated) return;
  const std::string text = EndText(state);
  const bool success = state.reason == FarmState::ALL_RETRIEVED;
  if (!layout.top.empty()) {
    const int left = layout.Px(10);
    fonts.title.Draw(image, fonts.title.Fit(text, layout.top.width - 2 * left),
                     {left, layout.Px(18)},
                     Bgr(success ? layout.style->good : layout.style->words));
    return;
  }
  const int width = fonts.title.Width(text) + layout.Px(28);
  const cv::Rect plate(layout.map.x + (layout.map.width - width) / 2, layout.map.y + layout.Px(12),
                       width, layout.Px(28));
  Tint(image, plate, Bgr(success ? Rgb{0x12, 0x6b, 0x3a} : kInk), 0.92);
  cv::rectangle(image, plate, Bgr(success ? layout.style->good : layout.style->faint), 1);
  fonts.title.Draw(
      image, text,
      {plate.x + layout.Px(14), plate.y + (plate.height + fonts.title.cap_height()) / 2},
      Bgr(kPaper));
}

}  // namespace

void DrawWords(cv::Mat& image, const FarmSpec& spec, const FarmState& state,
               const Overlays& overlays, const Outlook& outlook, const Layout& layout,
               const Fonts& fonts) {
  if (layout.top.empty()) return DrawEnd(image, state, layout, fonts);
  DrawTop(image, spec, state, outlook, layout, fonts);
  DrawEnd(image, state, layout, fonts);
  // Without a line about a training, the rewards are in the middle of Layout::bottom.
  DrawRewardLine(image, state, overlays.training != nullptr ? 17.0 : 26.0, layout, fonts);
  if (overlays.training != nullptr) DrawTrainingLine(image, *overlays.training, layout, fonts);
}

}  // namespace aquafarm_viz
