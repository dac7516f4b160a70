// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The lists at the right of a picture; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "aquafarm_viz/scene/trail.h"
#include "draw/symbols.h"
#include "scene/outlook.h"

namespace aquafarm_viz {

/// A text with its colour.
struct ColoredText {
  std::string text;
  Rgb color;
};

/// Parts of a text that follow each other.
using ColoredTexts = std::vector<ColoredText>;

/// Draws the lists of the panel from its top down to the legend.
class Panel {
 public:
  static constexpr int kRowsOfRegion = 12;  ///< kept free for headings and the map of the region

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
    Row(left_, text, fonts_.bold, layout_.style->faint, {{right_text, layout_.style->faint}});
  }

  void Item(const std::string& text, const std::string& right_text, Rgb right_color) {
    Item(text, ColoredTexts{{right_text, right_color}});
  }

  /// Draws a row whose right text consists of parts with different colours.
  void Item(const std::string& text, const ColoredTexts& right_parts) {
    Row(left_ + layout_.Px(21), text, fonts_.small, layout_.style->words, right_parts);
  }

  /// Returns whether two texts fit next to each other in a row of Item or Detail.
  bool Fits(const std::string& text, const std::string& right_text) const {
    const int gap = layout_.Px(6);
    return fonts_.small.Width(text) + gap + fonts_.small.Width(right_text) <=
           right_ - left_ - layout_.Px(21);
  }

  /// Draws two texts with space for a symbol before each (SymbolAt, SecondSymbolAt).
  void Pair(const ColoredTexts& first, const ColoredTexts& second) {
    const int base = y_ + (RowPx() + fonts_.small.cap_height()) / 2;
    DrawParts(first, {left_ + layout_.Px(21), base});
    DrawParts(second, {Middle() + layout_.Px(21), base});
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
    Row(left_, left_text, fonts_.small, layout_.style->words, {{right_text, layout_.style->words}});
  }

  void Detail(const std::string& text, const std::string& right_text, Rgb right_color) {
    Detail(text, ColoredTexts{{right_text, right_color}});
  }

  /// Draws a row whose right text consists of parts with different colours.
  void Detail(const std::string& text, const ColoredTexts& right_parts) {
    Row(left_ + layout_.Px(21), text, fonts_.small, layout_.style->faint, right_parts);
  }

 private:
  int Middle() const { return (left_ + right_) / 2; }

  void Row(int left, const std::string& text, const Font& font, Rgb color,
           const ColoredTexts& right_parts) {
    const int base = y_ + (RowPx() + fonts_.small.cap_height()) / 2;
    int right_from = right_;
    for (const ColoredText& part : right_parts) right_from -= fonts_.small.Width(part.text);
    font.Draw(image_, font.Fit(text, right_from - left - layout_.Px(3)), {left, base}, Bgr(color));
    DrawParts(right_parts, {right_from, base});
    y_ += RowPx();
  }

  void DrawParts(const ColoredTexts& parts, cv::Point at) {
    for (const ColoredText& part : parts) {
      fonts_.small.Draw(image_, part.text, at, Bgr(part.color));
      at.x += fonts_.small.Width(part.text);
    }
  }

  cv::Mat& image_;
  const Layout& layout_;
  const Fonts& fonts_;
  int left_;
  int right_;
  int y_;
  int end_;
};

/// Draws the list of devices. Up to 6 devices are drawn in one or two rows each, with their symbols
/// and their danger or status. If there is space, 7 to 12 devices are drawn two in each row. In all
/// other cases, draws the number of delivered devices and of all devices of each kind.
/// @param trail  null: times are left out
void ListDevices(Panel& panel, const aquafarm_msgs::FarmSpec& spec,
                 const aquafarm_msgs::FarmState& state, const Trail* trail, const Outlook& outlook,
                 const Layout& layout);

}  // namespace aquafarm_viz
