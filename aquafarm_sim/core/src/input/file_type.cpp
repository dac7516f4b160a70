// SPDX-License-Identifier: BSD-3-Clause
#include "input/file_type.h"

#include <algorithm>
#include <filesystem>

#include "aquafarm/input/track_format.h"
#include "base/text.h"
#include "input/json_object.h"

namespace aquafarm::internal {
namespace {

bool Starts(std::string_view text, std::string_view with) {
  return text.substr(0, with.size()) == with;
}

bool Has(std::string_view text, std::string_view words) {
  return text.find(words) != std::string_view::npos;
}

bool HasLine(std::string_view text, const std::string& start) {
  return Starts(text, start) || Has(text, "\n" + start);
}

// Returns the beginning of a JSON text on one line, because its first line may be only a bracket.
std::string OnOneLine(const std::string& text, std::size_t begin) {
  constexpr std::size_t kEnough = 200;
  std::string part = text.substr(begin, kEnough);
  std::replace(part.begin(), part.end(), '\n', ' ');
  std::string words;
  for (const std::string_view word : SplitWords(part)) {
    words += (words.empty() ? "" : " ") + std::string(word);
  }
  return words;
}

DetectedFile DetectJsonType(const std::string& text) {
  const bool collected = Has(text, "\"features\"") || Has(text, "\"geometries\"");
  if (Has(text, "\"type\"") && (collected || Has(text, "\"coordinates\""))) {
    return {FileKind::kGeoJson, "GeoJSON"};
  }
  if (Has(text, "\"anchors\"")) return {FileKind::kNotices, "anchorage forecasts"};
  if (Has(text, "\"warning\"")) return {FileKind::kNotices, "a weather service's warnings"};
  return {};
}

// Detects netCDF files and pictures from their first bytes, and other binary files from a zero
// byte.
DetectedFile DetectBinaryType(const std::string& text) {
  if (Starts(text, "CDF") || Starts(text, "\x89HDF")) return {FileKind::kNetcdf, "a netCDF file"};
  if (Starts(text, "\x89PNG")) return {FileKind::kPicture, "a PNG picture"};
  const bool binary = Has(text, std::string_view("\0", 1));
  if (Starts(text, "BM") && binary) return {FileKind::kPicture, "a BMP picture"};
  const bool grey = Starts(text, "P2") || Starts(text, "P5");
  if (grey && text.size() > 2 && Has(" \t\r\n", text.substr(2, 1))) {
    return {FileKind::kPicture, "a PGM picture"};
  }
  return {FileKind::kUnknown, binary ? "a binary file" : ""};
}

}  // namespace

DetectedFile DetectFileType(const std::string& text) {
  const DetectedFile bytes = DetectBinaryType(text);
  if (!bytes.words.empty()) return bytes;
  const std::string clean = CleanJson(text);
  const std::size_t begin = clean.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos) return {FileKind::kUnknown, "an empty file"};
  if (clean[begin] == '{' || clean[begin] == '[') {
    const DetectedFile json = DetectJsonType(clean);
    if (json.kind != FileKind::kUnknown) return json;
  }
  if (const std::optional<TrackFormat> format = DetectTrackFormat(text)) {
    return {FileKind::kTracks, "tracks of storms (" + std::string(ToString(*format)) + ")"};
  }
  const std::string_view line =
      std::string_view(clean).substr(begin, clean.find('\n', begin) - begin);
  const std::vector<std::string_view> words = SplitWords(line);
  const auto is_size = [](std::string_view word) {
    return Upper(word) == "NCOLS" || Upper(word) == "NROWS";
  };
  if (words.size() == 2 && std::any_of(words.begin(), words.end(), is_size)) {
    return {FileKind::kAsciiGrid, "an ASCII grid"};
  }
  if (HasLine(clean, "image:") && HasLine(clean, "resolution:")) {
    return {FileKind::kMapYaml, "a map of map_server"};
  }
  if (line[0] == '{' || line[0] == '[')
    return {FileKind::kUnknown, Quoted(OnOneLine(clean, begin))};
  return {FileKind::kUnknown, Quoted(Trim(line))};
}

FileKind KindByName(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".yaml" || extension == ".yml") return FileKind::kMapYaml;
  if (extension == ".asc" || extension == ".tt2") return FileKind::kAsciiGrid;
  const bool json = extension == ".json" || extension == ".geojson";
  return json ? FileKind::kGeoJson : FileKind::kUnknown;
}

}  // namespace aquafarm::internal
