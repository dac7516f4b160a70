// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/base/text.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <opencv2/imgproc.hpp>

namespace aquafarm_viz {
namespace {

constexpr std::uint32_t kReplacement = '?';
constexpr std::uint32_t kEllipsis = 0x2026;

// Returns the code point at `at` and advances `at`. Returns the replacement character for an
// invalid sequence or a control character.
std::uint32_t NextCode(std::string_view text, std::size_t& at) {
  const auto lead = static_cast<unsigned char>(text[at++]);
  if (lead < 0x80) return lead < 0x20 ? kReplacement : lead;
  const int more = lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : lead >= 0xc0 ? 1 : 0;
  if (more == 0) return kReplacement;
  std::uint32_t code = lead & (0x3fU >> more);
  for (int i = 0; i < more; ++i) {
    if (at >= text.size() || (static_cast<unsigned char>(text[at]) & 0xc0U) != 0x80) {
      return kReplacement;
    }
    code = (code << 6U) | (static_cast<unsigned char>(text[at++]) & 0x3fU);
  }
  return code;
}

void Blend(cv::Mat& image, const cv::Mat1b& coverage, cv::Point at, const cv::Scalar& color) {
  const cv::Rect whole(at, coverage.size());
  const cv::Rect seen = whole & cv::Rect({0, 0}, image.size());
  const std::array<int, 3> paint{cvRound(color[0]), cvRound(color[1]), cvRound(color[2])};
  for (int row = seen.y; row < seen.y + seen.height; ++row) {
    const std::uint8_t* cover = coverage.ptr(row - at.y) + (seen.x - at.x);
    std::uint8_t* pixel = image.ptr(row) + 3L * seen.x;
    for (int i = 0; i < seen.width; ++i, pixel += 3) {
      const int share = cover[i] + (cover[i] >> 7);
      if (share == 0) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        pixel[c] = static_cast<std::uint8_t>(pixel[c] + (((paint[c] - pixel[c]) * share) >> 8));
      }
    }
  }
}

}  // namespace

Font::Font(int size_px, const std::string& file) {
  const int size = std::max(size_px, 4);
  if (file.empty() || !LoadTrueType(size, file)) LoadStrokes(size);
}

bool Font::LoadTrueType(int size_px, const std::string& file) {
  FT_Library raw_library = nullptr;
  if (FT_Init_FreeType(&raw_library) != 0) return false;
  const std::unique_ptr<FT_LibraryRec_, FT_Error (*)(FT_Library)> library(raw_library,
                                                                          FT_Done_FreeType);
  FT_Face raw_face = nullptr;
  if (FT_New_Face(library.get(), file.c_str(), 0, &raw_face) != 0) return false;
  const std::unique_ptr<FT_FaceRec_, FT_Error (*)(FT_Face)> face(raw_face, FT_Done_Face);
  if (FT_Set_Pixel_Sizes(face.get(), 0, static_cast<FT_UInt>(size_px)) != 0) return false;
  for (std::uint32_t code = 0x20; code < glyphs_.size(); ++code) {
    if (FT_Load_Char(face.get(), code, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) != 0) continue;
    const FT_GlyphSlot slot = face->glyph;
    Glyph& glyph = glyphs_[code];
    glyph.left = slot->bitmap_left;
    glyph.top = slot->bitmap_top;
    glyph.advance = static_cast<int>((slot->advance.x + 32) >> 6);
    if (slot->bitmap.width == 0 || slot->bitmap.pixel_mode != FT_PIXEL_MODE_GRAY) continue;
    glyph.coverage =
        cv::Mat1b(static_cast<int>(slot->bitmap.rows), static_cast<int>(slot->bitmap.width),
                  slot->bitmap.buffer, static_cast<std::size_t>(slot->bitmap.pitch))
            .clone();
  }
  cap_height_ = glyphs_['H'].top;
  return cap_height_ > 0;
}

void Font::LoadStrokes(int size_px) {
  constexpr int kOversampling = 4;
  const double scale = cv::getFontScaleFromHeight(cv::FONT_HERSHEY_SIMPLEX,
                                                  cvRound(size_px * 0.72 * kOversampling), 1);
  const int thickness = std::max(1, size_px * kOversampling / 12);
  const int above = size_px;
  const int rows = above + size_px / 2;
  for (std::uint32_t code = 0x20; code < 0x7f; ++code) {
    const std::string text(1, static_cast<char>(code));
    int baseline = 0;
    const cv::Size size =
        cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale, thickness, &baseline);
    Glyph& glyph = glyphs_[code];
    glyph.top = above;
    glyph.advance = (size.width + kOversampling - 1) / kOversampling;
    cv::Mat1b large(rows * kOversampling, (glyph.advance + 1) * kOversampling, std::uint8_t{0});
    cv::putText(large, text, {0, above * kOversampling}, cv::FONT_HERSHEY_SIMPLEX, scale, 255,
                thickness, cv::LINE_AA);
    cv::resize(large, glyph.coverage, {}, 1.0 / kOversampling, 1.0 / kOversampling, cv::INTER_AREA);
  }
  cap_height_ = cvRound(size_px * 0.72);
}

const Font::Glyph& Font::At(std::uint32_t code) const {
  const bool known = code < glyphs_.size() && glyphs_[code].advance > 0;
  return glyphs_[known ? code : kReplacement];
}

int Font::Width(std::string_view text) const {
  int width = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::uint32_t code = NextCode(text, at);
    width += code == kEllipsis ? 3 * At('.').advance : At(code).advance;
  }
  return width;
}

std::string Font::Fit(std::string_view text, int width_px) const {
  if (Width(text) <= width_px) return std::string(text);
  const int room = width_px - 3 * At('.').advance;
  std::size_t end = 0;
  for (int width = 0; end < text.size();) {
    std::size_t next = end;
    width += At(NextCode(text, next)).advance;
    if (width > room) break;
    end = next;
  }
  return std::string(text.substr(0, end)) + "…";
}

int Font::Draw(cv::Mat& image, std::string_view text, cv::Point at, const cv::Scalar& color) const {
  CV_Assert(image.type() == CV_8UC3);
  const int start = at.x;
  const auto put = [&](const Glyph& glyph) {
    Blend(image, glyph.coverage, at + cv::Point(glyph.left, -glyph.top), color);
    at.x += glyph.advance;
  };
  for (std::size_t i = 0; i < text.size();) {
    const std::uint32_t code = NextCode(text, i);
    if (code != kEllipsis) {
      put(At(code));
      continue;
    }
    for (int dot = 0; dot < 3; ++dot) put(At('.'));
  }
  return at.x - start;
}

std::string FindFontFile(bool bold) {
  const std::string truetype = "/usr/share/fonts/truetype/";
  const std::vector<std::string> files{
      truetype + (bold ? "dejavu/DejaVuSans-Bold.ttf" : "dejavu/DejaVuSans.ttf"),
      truetype +
          (bold ? "liberation/LiberationSans-Bold.ttf" : "liberation/LiberationSans-Regular.ttf"),
      truetype + (bold ? "liberation2/LiberationSans-Bold.ttf"
                       : "liberation2/LiberationSans-Regular.ttf")};
  for (const auto& file : files) {
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) return file;
  }
  return "";
}

std::string Number(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), std::abs(value) < 1e12 ? "%.*f" : "%.*e", decimals,
                value);
  const bool zero =
      std::string_view(text.data()).find_first_not_of("-0.") == std::string_view::npos;
  return zero && text[0] == '-' ? text.data() + 1 : text.data();
}

std::string Percent(double fraction) {
  if (!std::isfinite(fraction)) return "-";
  const double percent = std::round(100.0 * fraction);
  return Number(fraction < 1.0 ? std::min(percent, 99.0) : percent, 0) + " %";
}

std::string SeedText(std::uint64_t seed) {
  constexpr std::uint64_t kEvaluationBit = std::uint64_t{1} << 63U;
  if ((seed & kEvaluationBit) == 0) return std::to_string(seed);
  return "evaluation " + std::to_string(seed & ~kEvaluationBit);
}

std::string Count(std::uint64_t value) {
  std::string text = std::to_string(value);
  for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3) {
    text.insert(static_cast<std::size_t>(at), 1, ',');
  }
  return text;
}

}  // namespace aquafarm_viz
