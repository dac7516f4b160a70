// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Anti-aliased text. A font draws each character once and then copies it, so that text is fast
/// enough for every frame.

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace aquafarm_viz {

/// The characters of a font at one size: Latin-1 of a TrueType font, or ASCII of OpenCV's stroke
/// font. "?" replaces all other characters, but an ellipsis is drawn as three dots.
class Font {
 public:
  /// @param size_px  em size [pixels]; a value below 4 is raised to 4
  /// @param file     a TrueType file, see FindFontFile; if it is empty or cannot be read, OpenCV's
  ///                 stroke font is used
  Font(int size_px, const std::string& file);

  /// Returns the width of a text in UTF-8 [pixels].
  int Width(std::string_view text) const;

  /// Returns the text, truncated with an ellipsis if it is wider than `width_px`.
  std::string Fit(std::string_view text, int width_px) const;

  /// Draws a text in UTF-8 with the left end of its baseline at `at`. Returns its width [pixels].
  /// @param image 8-bit BGR; parts of the text outside it are clipped
  int Draw(cv::Mat& image, std::string_view text, cv::Point at, const cv::Scalar& color) const;

  /// Returns the height of a capital letter [pixels].
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

/// Returns the file of DejaVu Sans or, if that is not installed, of Liberation Sans, regular or
/// bold. Looks in /usr/share/fonts/truetype; returns an empty string if neither is there.
std::string FindFontFile(bool bold);

/// Formats a number with `decimals` decimal places, or with an exponent if its magnitude is at
/// least 1e12; "-" if it is not finite.
std::string Number(double value, int decimals);

/// Formats a fraction as "98 %"; "-" if it is not finite. A fraction below 1 is at most "99 %", so
/// that a single failure is visible.
std::string Percent(double fraction);

/// Formats a count with commas between thousands.
std::string Count(std::uint64_t value);

/// Formats a seed: "7", or "evaluation 1000" for an evaluation seed. An evaluation seed has the
/// highest bit set (kEvaluationSeedBit in aquafarm/base/rng.h).
std::string SeedText(std::uint64_t seed);

}  // namespace aquafarm_viz
