// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Anti-aliased text. Each character is drawn once and then copied, so that text is fast enough to
/// draw in every frame.

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace aquafarm_viz {

/// The Latin-1 characters at one size. Uses DejaVu or Liberation if installed, else OpenCV's
/// stroke font.
class Font {
 public:
  /// @param size_px  nominal height, from ascender to descender, in pixels; at least 4.
  /// @param file     a TrueType file; empty selects OpenCV's stroke font.
  Font(int size_px, const std::string& file);

  /// Returns the width of a text (UTF-8) in pixels.
  int Width(std::string_view text) const;

  /// Returns the text, truncated with an ellipsis if it is wider than `width_px`.
  std::string Fit(std::string_view text, int width_px) const;

  /// Draws a text (UTF-8) with the left end of its baseline at `at`. Returns its width in pixels.
  /// Parts outside the 8-bit BGR image are clipped.
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

/// Returns the first suitable font file that is installed, regular or bold; empty if there is none.
std::string FindFontFile(bool bold);

/// Formats a number with `decimals` decimal places; "-" if it is not finite.
std::string Number(double value, int decimals);

/// Formats a count with commas between thousands.
std::string Count(std::uint64_t value);

/// Formats a seed: "7"; "evaluation 1000" for the seeds of evaluation episodes, which have the
/// highest bit set (aquafarm/base/rng.h).
std::string SeedText(std::uint64_t seed);

}  // namespace aquafarm_viz
