// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Anti-aliased text, fast enough for every frame: each character is drawn once, then copied.

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace aquafarm_viz {

/// The characters of Latin-1 at one size. Uses DejaVu or Liberation where installed, else the
/// strokes that OpenCV brings.
class Font {
 public:
  /// @param size_px  nominal height, from ascender to descender, in pixels; at least 4.
  /// @param file     a TrueType file; empty chooses OpenCV's strokes.
  Font(int size_px, const std::string& file);

  /// The width of a text (UTF-8) in pixels.
  int Width(std::string_view text) const;

  /// The text, cut with an ellipsis where it is wider than `width_px`.
  std::string Fit(std::string_view text, int width_px) const;

  /// Draws a text (UTF-8) with its baseline's left end at `at` and returns its width in pixels.
  /// Whatever falls outside the 8-bit BGR image is left out.
  int Draw(cv::Mat& image, std::string_view text, cv::Point at, const cv::Scalar& color) const;

  /// The height of a capital letter in pixels.
  int cap_height() const { return cap_height_; }

 private:
  struct Glyph {
    cv::Mat1b coverage;
    int left{};
    int top{};
    int advance{};
  };

  bool LoadTrueType(int size_px, const std::string& file);
  void LoadStrokes(int size_px);
  const Glyph& At(std::uint32_t code) const;

  std::array<Glyph, 256> glyphs_;
  int cap_height_{};
};

/// The first installed font file that suits, plain or bold; empty when there is none.
std::string FindFontFile(bool bold);

/// A number as people write it, with `decimals` places; "-" for one that is not finite.
std::string Number(double value, int decimals);

/// A count with commas between thousands.
std::string Count(std::uint64_t value);

}  // namespace aquafarm_viz
