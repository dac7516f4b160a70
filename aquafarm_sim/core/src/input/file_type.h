// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace aquafarm::internal {

enum class FileKind : std::uint8_t {
  kUnknown,
  kTracks,   ///< storm tracks in any format
  kNotices,  ///< warnings or anchorage forecasts
  kGeoJson,
  kAsciiGrid,
  kMapYaml,
  kPicture,
  kNetcdf,
};

/// Type of a file, detected from its content.
struct DetectedFile {
  FileKind kind{};
  std::string words;  ///< description: "a netCDF file", "tracks of storms (CMA best track)", or
                      ///< the quoted first line
};

/// Detects the type of a file from its content.
DetectedFile DetectFileType(const std::string& text);

/// Returns the kind of chart that the extension of a file name indicates. Used if the content is
/// not recognized, so that the reader of that kind reports the error.
FileKind KindByName(const std::string& path);

}  // namespace aquafarm::internal
