// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace aquafarm::internal {

/// Kinds of input files.
enum class FileKind : std::uint8_t {
  kUnknown,
  kTracks,   ///< storm tracks in any format
  kNotices,  ///< warnings of a weather service, or anchorage forecasts
  kGeoJson,
  kAsciiGrid,
  kMapYaml,
  kPicture,
  kNetcdf,
};

/// Kind and description of a file.
struct DetectedFile {
  FileKind kind{};
  std::string words;  ///< description, such as "a netCDF file"; for an unknown text, its first
                      ///< line in quotes
};

/// Detects the kind of a file. @param text content of the file, or its beginning
DetectedFile DetectFileType(const std::string& text);

/// Returns the kind of chart that the extension of a file name suggests. The ranch builder uses it
/// for content of unknown kind, so that the reader of that kind reports the error.
FileKind KindByName(const std::string& path);

}  // namespace aquafarm::internal
