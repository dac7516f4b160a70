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
  /// Description, such as "a netCDF file". For an unknown text: its beginning in quotes.
  std::string words;
};

/// Detects the kind of a file. @param text content of the file, or its beginning
DetectedFile DetectFileType(const std::string& text);

/// Returns the kind of chart that the extension of a file name suggests; kUnknown for other
/// extensions. If the content is of unknown kind, the ranch builder calls the reader of the
/// suggested kind, which then reports the error.
FileKind KindByName(const std::string& path);

}  // namespace aquafarm::internal
