// SPDX-License-Identifier: BSD-3-Clause
#include "charts/map_image.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#define STBI_ONLY_BMP
#define STBI_MAX_DIMENSIONS 16384
#include <stb/stb_image.h>

#include <algorithm>
#include <memory>

#include "input/parse_context.h"

namespace aquafarm::internal {
namespace {

// Reads the numbers of a PGM header, and pixels written as text. Blanks separate the numbers. A
// comment extends from # to the end of its line.
class PgmHeader {
 public:
  PgmHeader(const std::string& bytes, ParseContext& place) : bytes_(bytes), place_(place) {
    place.line = 1;
  }

  std::int32_t Next(const char* name, std::int32_t max) {
    return ReadWhole(Word(), name, 1, max, place_);
  }
  /// Reads a pixel written as text.
  std::int32_t Pixel(std::int32_t max) { return ReadWhole(Word(), "pixel", 0, max, place_); }
  /// Skips the end of the header: one blank, or CR and LF. If it is one blank, one line feed after
  /// the pixels is accepted.
  void SkipEnd(std::size_t pixels) {
    const std::size_t left = bytes_.size() - std::min(bytes_.size(), at_);
    const bool one_more = left == pixels + 2;
    const bool dos = one_more && bytes_.compare(at_, 2, "\r\n") == 0;
    if (left > pixels + 1 && !dos && !(one_more && bytes_.back() == '\n')) {
      place_.Fail("got " + std::to_string(left - 1) + " bytes of pixels, expected " +
                  std::to_string(pixels));
    }
    at_ += dos ? 2 : 1;
  }
  bool HasMore() {
    SkipBlanks();
    return at_ < bytes_.size();
  }
  std::size_t at_{2};

 private:
  std::string_view Word() {
    SkipBlanks();
    const std::size_t from = std::min(at_, bytes_.size());
    at_ = std::min(bytes_.find_first_of(" \t\r\n#", from), bytes_.size());
    return std::string_view(bytes_).substr(from, at_ - from);
  }
  void SkipBlanks() {
    bool comment = false;
    for (; at_ < bytes_.size(); ++at_) {
      const char c = bytes_[at_];
      if (c == '\n') {
        ++place_.line;
        comment = false;
      } else if (c == '#') {
        comment = true;
      } else if (!comment && c != ' ' && c != '\t' && c != '\r') {
        return;
      }
    }
  }

  const std::string& bytes_;
  ParseContext& place_;
};

void CheckSize(std::size_t got, std::size_t width, std::size_t height, std::size_t bytes,
               const ParseContext& place) {
  if (got >= width * height * bytes) return;
  place.Fail("got " + std::to_string(got) + " bytes of pixels, expected " + std::to_string(width) +
             " x " + std::to_string(height) + " of " + std::to_string(bytes) +
             (bytes == 1 ? " byte" : " bytes"));
}

MapImage ParsePgm(const std::string& bytes, ParseContext& place) {
  PgmHeader header(bytes, place);
  const std::int32_t width = header.Next("width", kMaxMapSide);
  const std::int32_t height = header.Next("height", kMaxMapSide);
  const std::int32_t white = header.Next("max value (maxval)", 65535);
  const auto columns = static_cast<std::size_t>(width);
  const auto rows = static_cast<std::size_t>(height);
  const bool text = bytes[1] == '2';
  const std::size_t depth = white > 255 ? 2 : 1;
  if (!text) header.SkipEnd(columns * rows * depth);
  // In text format each pixel takes at least two bytes, a digit and a blank. The last pixel needs
  // no blank.
  CheckSize(text ? (bytes.size() - header.at_ + 1) / 2
                 : bytes.size() - std::min(bytes.size(), header.at_),
            columns, rows, text ? 1 : depth, place);
  MapImage image;
  image.grey.resize(height, width);
  for (std::size_t i = 0; i < columns * rows; ++i) {
    std::int32_t value = 0;
    if (text) {
      value = header.Pixel(white);
    } else {
      for (std::size_t k = 0; k < depth; ++k) {
        value = value * 256 + static_cast<unsigned char>(bytes[header.at_ + i * depth + k]);
      }
    }
    if (value > white) {
      place.Fail("pixel: got " + std::to_string(value) + ", expected one from 0 to " +
                 std::to_string(white));
    }
    image.grey.data()[i] = static_cast<std::uint8_t>(white == 255 ? value : value * 255 / white);
  }
  if (text && header.HasMore()) place.Fail("got more pixels than the stated size has");
  return image;
}

// Rejects a PNG with a chunk that is longer than the rest of the file: stb allocates the stated
// length before it reads. Also rejects a PNG whose first chunk of pixels (IDAT) is empty: stb would
// pass a null pointer to memcpy.
void CheckPngChunks(const std::string& bytes, const ParseContext& place) {
  constexpr std::size_t kSignature = 8;
  constexpr std::size_t kAround = 12;  // length and name before a chunk's data, checksum after it
  if (bytes.compare(0, kSignature, "\x89PNG\r\n\x1a\n") != 0) return;
  std::size_t at = kSignature;
  bool has_pixels = false;
  while (bytes.size() - at >= kAround) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      length = length * 256 + static_cast<unsigned char>(bytes[at + i]);
    }
    const std::size_t left = bytes.size() - at - kAround;
    if (length > left) {
      place.Fail("got a chunk of " + std::to_string(length) + " bytes, expected at most the " +
                 std::to_string(left) + " that the file still has; is it cut off?");
    }
    if (bytes.compare(at + 4, 4, "IEND") == 0) return;
    if (bytes.compare(at + 4, 4, "IDAT") == 0) {
      if (length == 0 && !has_pixels) place.Fail("got an empty first chunk of pixels (IDAT)");
      has_pixels = true;
    }
    at += length + kAround;
  }
}

MapImage ParseWithStb(const std::string& bytes, const ParseContext& place) {
  CheckPngChunks(bytes, place);
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(std::min<std::size_t>(bytes.size(), 1U << 30U));
  int width = 0;
  int height = 0;
  int channels = 0;
  const auto refuse = [&place] {
    place.Fail(std::string("got an unreadable image (") + stbi_failure_reason() +
               "), expected PGM, PNG or BMP");
  };
  if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0) refuse();
  // Rejects a size that the file is too short for. Deflate compresses at most 1032 to 1 (zlib,
  // technical details), and a byte contains at most 8 pixels.
  constexpr std::size_t kMaxPacking = 8 * 1032;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (width > kMaxMapSide || height > kMaxMapSide || pixels / kMaxPacking > bytes.size()) {
    place.Fail("got a size of " + std::to_string(width) + " x " + std::to_string(height) +
               " pixels in " + std::to_string(bytes.size()) + " bytes, expected at most " +
               std::to_string(kMaxMapSide) + " x " + std::to_string(kMaxMapSide) + " and " +
               std::to_string(kMaxPacking) + " pixels per byte");
  }
  const std::unique_ptr<stbi_uc, void (*)(void*)> loaded(
      stbi_load_from_memory(data, size, &width, &height, &channels, 0), &stbi_image_free);
  if (loaded == nullptr) refuse();
  const int colours = channels < 3 ? 1 : 3;
  const bool alpha = channels == 2 || channels == 4;
  MapImage image;
  image.grey.resize(height, width);
  if (alpha) image.alpha.resize(height, width);
  for (Eigen::Index i = 0; i < image.grey.size(); ++i) {
    const stbi_uc* pixel = loaded.get() + i * channels;
    int sum = 0;
    for (int c = 0; c < colours; ++c) sum += pixel[c];
    image.grey.data()[i] = static_cast<std::uint8_t>(sum / colours);
    if (alpha) image.alpha.data()[i] = pixel[channels - 1];
  }
  return image;
}

}  // namespace

MapImage ParseMapImage(const std::string& bytes, const std::string& origin_name) {
  std::vector<std::string> unused;
  ParseContext place(origin_name, unused);
  place.line = 1;
  if (bytes.compare(0, 2, "P5") == 0 || bytes.compare(0, 2, "P2") == 0) {
    return ParsePgm(bytes, place);
  }
  return ParseWithStb(bytes, place);
}

}  // namespace aquafarm::internal
