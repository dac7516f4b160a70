// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/charts/ascii_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "base/files.h"
#include "base/text.h"
#include "charts/map_image.h"
#include "input/parse_context.h"

namespace aquafarm {
namespace {

using internal::Format;
using internal::ParseContext;

float LandAt(float value, float sea_level) {
  return std::isnan(value) || value > sea_level ? 1.0F : 0.0F;
}

// Maps the spellings of a header key to one name.
std::string KeyOf(std::string_view word) {
  const std::string key = internal::Upper(word);
  // GeoClaw's xlower and ylower are the position of the south-west value.
  if (key == "XLOWER") return "XLLCENTER";
  if (key == "YLOWER") return "YLLCENTER";
  if (key == "XLL") return "XLLCORNER";
  if (key == "YLL") return "YLLCORNER";
  return key == "NODATA" ? "NODATA_VALUE" : key;
}

struct Entry {
  double number{};
  std::int32_t line{};
};

struct Header {
  std::map<std::string, Entry> entries;

  bool Has(const std::string& key) const { return entries.count(key) != 0; }
  /// Throws InputError with the line of the key, or the current line if the key is missing.
  [[noreturn]] void Fail(const std::string& key, const std::string& what,
                         ParseContext place) const {
    if (Has(key)) place.line = entries.at(key).line;
    place.Fail(key + ": got " + (Has(key) ? Format(entries.at(key).number) : "nothing") + what);
  }
  double Get(const std::string& key, double min, double max, const ParseContext& place) const {
    const auto found = entries.find(key);
    if (found != entries.end() && found->second.number >= min && found->second.number <= max) {
      return found->second.number;
    }
    Fail(key, ", expected a number in [" + Format(min) + ", " + Format(max) + "]", place);
  }
  /// Returns the coordinate of the centre of the first cell along an axis, from `center` or, if
  /// that is missing, from `corner`.
  double First(const std::string& center, const std::string& corner, double cell_size,
               const ParseContext& place) const {
    constexpr double kFar = 1.0e9;
    if (Has(center)) return Get(center, -kFar, kFar, place);
    return Get(corner, -kFar, kFar, place) + cell_size / 2.0;
  }
  /// Checks that the centres of `count` cells starting at `first` lie in [-max, max] degrees. A
  /// tolerance of half a cell accepts a header that gives the outermost node as the corner.
  void NeedDegrees(const std::string& center, const std::string& corner, double first,
                   Eigen::Index count, double max, const AsciiGrid& grid,
                   const ParseContext& place) const {
    const double last = first + static_cast<double>(count - 1) * grid.cell_size;
    const double limit = max + grid.cell_size * 0.501;
    if (first >= -limit && last <= limit) return;
    Fail(Has(center) ? center : corner,
         ", so that the cells reach from " + Format(first) + " to " + Format(last) +
             ", expected degrees in [" + Format(-max) + ", " + Format(max) +
             "], because CELLSIZE is below 1",
         place);
  }
};

bool IsWord(std::string_view text) {
  const char c = text.empty() ? ' ' : text[0];
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// Returns whether a word is a value such as NaN or null that other programs write. Such a word is
// not a key.
bool IsNoNumber(std::string_view word) {
  const std::string upper = internal::Upper(word);
  return upper == "NAN" || upper == "NULL" || upper == "NA" || upper == "NONE" || upper == "INF";
}

// Adds the entry of a header line to `header`. Returns false if the line does not belong to the
// header.
bool ReadHeaderLine(const std::vector<std::string_view>& words, Header& header,
                    const ParseContext& place) {
  if (words.size() < 2) return false;
  const bool name_first = IsWord(words[0]);
  const std::string_view name = words[name_first ? 0 : 1];
  if (!IsWord(name) || IsNoNumber(name)) return false;
  const std::string key = KeyOf(name);
  constexpr std::array<std::string_view, 8> kKeys{"NCOLS",     "NROWS",       "CELLSIZE",
                                                  "XLLCENTER", "YLLCENTER",   "XLLCORNER",
                                                  "YLLCORNER", "NODATA_VALUE"};
  if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) {
    place.Fail(internal::Quoted(name) +
               ": unknown key, expected ncols, nrows, cellsize, xllcenter, yllcenter, "
               "xllcorner, yllcorner, xlower, ylower or nodata_value");
  }
  if (header.Has(key)) place.Fail(key + ": got the key twice, expected it once");
  const std::string axis = key.substr(0, 4);  // XLLC or YLLC
  for (const std::string& other : {axis + "ENTER", axis + "ORNER"}) {
    if (header.Has(other)) place.Fail(key + ": appears together with " + other + ", expected one");
  }
  header.entries[key] = {
      internal::ReadNumber(words[name_first ? 1 : 0], key.c_str(), -1.0e9, 1.0e9, place),
      place.line};
  return true;
}

// Splits a line into words. Rejects a line of more than 16 MiB, because its words would take
// several times its memory.
std::vector<std::string_view> WordsOf(std::string_view line, const ParseContext& place) {
  constexpr std::size_t kMaxBytes = std::size_t{16} << 20U;
  if (line.size() <= kMaxBytes) return internal::SplitWords(line);
  place.Fail("got a line of " + std::to_string(line.size()) + " bytes, expected at most " +
             std::to_string(kMaxBytes) + ": a row of the grid in each line");
}

}  // namespace

bool AsciiGrid::IsGeographic() const {
  return cell_size < 1.0 && std::abs(west) <= 720.0 && std::abs(south) <= 180.0;
}

std::array<long, 2> AsciiGrid::Nearest(GeoPoint place) const {
  // Counts from the middle column, so that grids that start at -180 and grids that start at 0
  // degrees both work.
  const double middle = static_cast<double>(value.cols() - 1) / 2.0;
  const double east = std::remainder(place.longitude - (west + middle * cell_size), 360.0);
  return {std::lround(middle + east / cell_size),
          std::lround((place.latitude - south) / cell_size)};
}

bool AsciiGrid::Covers(GeoPoint place) const {
  const auto [column, row] = Nearest(place);
  return column >= 0 && column < value.cols() && row >= 0 && row < value.rows();
}

AsciiGrid ParseAsciiGrid(const std::string& text, const std::string& origin_name) {
  std::vector<std::string> unused;
  ParseContext place(origin_name, unused);
  internal::LineReader lines(internal::WithoutMark(text), place);
  std::string_view line;
  Header header;
  std::vector<std::string_view> words;
  bool more = false;
  while ((more = lines.Next(line))) {
    words = WordsOf(line, place);
    if (!words.empty() && !ReadHeaderLine(words, header, place)) break;
  }
  if (place.line == 0) place.line = 1;
  constexpr double kMax = internal::kMaxMapSide;
  const auto side = [&](const char* key) {
    const double number = header.Get(key, 1.0, kMax, place);
    if (number != std::floor(number)) header.Fail(key, ", expected a whole number", place);
    return static_cast<Eigen::Index>(number);
  };
  const Eigen::Index columns = side("NCOLS");
  const Eigen::Index rows = side("NROWS");
  AsciiGrid grid;
  grid.cell_size = header.Get("CELLSIZE", 1.0e-6, 1.0e6, place);
  grid.west = header.First("XLLCENTER", "XLLCORNER", grid.cell_size, place);
  grid.south = header.First("YLLCENTER", "YLLCORNER", grid.cell_size, place);
  if (grid.IsGeographic()) {
    header.NeedDegrees("XLLCENTER", "XLLCORNER", grid.west, columns, 360.0, grid, place);
    header.NeedDegrees("YLLCENTER", "YLLCORNER", grid.south, rows, 90.0, grid, place);
  }
  const double nodata =
      header.Has("NODATA_VALUE") ? header.entries["NODATA_VALUE"].number : -9999.0;
  const auto wanted = static_cast<std::size_t>(columns * rows);
  if (text.size() / 2 + 1 < wanted) {  // a value has at least a digit and a blank
    place.Fail("got " + std::to_string(text.size()) + " bytes, expected " +
               std::to_string(columns) + " x " + std::to_string(rows) + " values");
  }
  grid.value.resize(rows, columns);
  std::size_t count = 0;
  while (more) {
    for (const std::string_view word : words) {
      const double value = internal::ReadNumber(word, "value", -1.0e9, 1.0e9, place);
      if (count >= wanted) {
        place.Fail("got more values than the " + std::to_string(wanted) +
                   " that the header states");
      }
      const auto i = static_cast<Eigen::Index>(count++);
      grid.value(rows - 1 - i / columns, i % columns) =
          value == nodata ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(value);
    }
    more = lines.Next(line);
    words = more ? WordsOf(line, place) : std::vector<std::string_view>();
  }
  if (count < wanted) {
    place.Fail("got " + std::to_string(count) + " values, expected the " + std::to_string(wanted) +
               " that the header states");
  }
  return grid;
}

AsciiGrid LoadAsciiGrid(const std::string& path) {
  return ParseAsciiGrid(internal::ReadTextFile(path), path);
}

LandShare ShareOfLand(const AsciiGrid& grid, const GeoFrame& frame, std::int32_t width,
                      std::int32_t height, float sea_level) {
  constexpr int kSamples = 5;
  LandShare share = LandShare::Zero(height, width);
  for (std::int32_t y = 0; y < height; ++y) {
    for (std::int32_t x = 0; x < width; ++x) {
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const int row_of_sample = k / kSamples;
        const GeoPoint point = frame.ToGeo(x + (k % kSamples + 0.5) / kSamples - 0.5,
                                           y + (row_of_sample + 0.5) / kSamples - 0.5);
        const auto [column, row] = grid.Nearest(point);
        share(y, x) += grid.Covers(point) ? LandAt(grid.value(row, column), sea_level) : 1.0F;
      }
      share(y, x) /= kSamples * kSamples;
    }
  }
  return share;
}

LandShare ShareOfLand(const AsciiGrid& grid, float sea_level) {
  return grid.value.unaryExpr([sea_level](float value) { return LandAt(value, sea_level); });
}

}  // namespace aquafarm
