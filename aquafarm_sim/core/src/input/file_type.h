// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace aquafarm::internal {

enum class FileKind : std::uint8_t {
  kUnknown,
  kTracks,   ///< of storms, in any format
  kNotices,  ///< warnings or anchorage forecasts
  kGeoJson,
  kAsciiGrid,
  kMapYaml,
  kPicture,
  kNetcdf,
};

/// What a file seems to be by its content.
struct FileLook {
  FileKind kind{};
  std::string words;  ///< "a netCDF file", "tracks of storms (CMA best track)", "'first line…'"
};

FileLook LookAt(const std::string& text);

/// The kind of chart that a name's ending promises, for a content that does not tell: its reader
/// then says what is wrong with it.
FileKind KindByName(const std::string& path);

}  // namespace aquafarm::internal
