// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What the readers of tracks share: lines with their numbers, strict numbers, times, and where a
/// refusal or a repair was.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "aquafarm/storms/reader.h"

namespace aquafarm::internal {

/// Most fixes of one storm: a year of hourly ones.
inline constexpr std::size_t kMaxFixes = 10000;
/// No storm's was ever below 870.
inline constexpr double kLeastPressure_hpa = 800.0;

/// Where a reader stands: it refuses and warns in the name of a file and a line.
class HazardPlace {
 public:
  HazardPlace(const std::string& file, std::vector<std::string>& warnings)
      : file_(file), warnings_(warnings) {}

  std::int32_t line{};  ///< 0: `locate` finds it when it is asked for
  std::string path;     ///< of a value in JSON, said before what is wrong
  std::function<std::int32_t(const std::string& path)> locate;

  /// @throws InputError "file:line: what", with a path "file:line: path.what"
  [[noreturn]] void Refuse(const std::string& what) const;
  /// @throws InputError "file:line: value_path: what", with the line of that value
  [[noreturn]] void RefuseValue(const std::string& value_path, const std::string& what) const;
  void Warn(const std::string& what);
  void WarnValue(const std::string& value_path, const std::string& what);

 private:
  std::string At(const std::string& what) const;
  std::string AtValue(const std::string& value_path, const std::string& what) const;
  const std::string& file_;
  std::vector<std::string>& warnings_;
};

/// The lines of a text, one by one, without CR and LF.
class LineReader {
 public:
  LineReader(std::string_view text, HazardPlace& place) : rest_(text), place_(place) {
    place.line = 0;
  }
  /// False at the end of the text. Puts place.line on the line it gives.
  bool Next(std::string_view& line);

 private:
  std::string_view rest_;
  HazardPlace& place_;
};

/// Refuses what is there and no regular file: a pipe would be waited for, a device never ends.
/// @throws InputError "path: cannot read: is no regular file"
void NeedRegularFile(const std::string& path);

/// A whole regular file. @throws InputError when it cannot be read, or is larger than 512 MiB: all
/// of IBTrACS is some 300.
std::string ReadTextFile(const std::string& path);

/// A file's text without the byte order mark that may stand before it.
std::string_view WithoutMark(std::string_view text);
std::string_view Trim(std::string_view text);
std::vector<std::string_view> SplitWords(std::string_view text);
/// Fields between commas, blanks around them taken off.
void SplitFields(std::string_view text, std::vector<std::string_view>& fields);
/// As "'text'", cut when long and without control characters.
std::string Quoted(std::string_view text);
std::string Upper(std::string_view text);

/// A decimal number; none: it is none.
std::optional<double> ParseNumber(std::string_view text);
/// A whole number in [min, max]. @throws InputError "name: got 'x', expected a whole number in …"
std::int32_t ReadWhole(std::string_view text, const char* name, std::int32_t min, std::int32_t max,
                       const HazardPlace& place);
/// A decimal number in [min, max].
double ReadNumber(std::string_view text, const char* name, double min, double max,
                  const HazardPlace& place);
/// As ReadWhole, none for a blank text.
std::optional<std::int32_t> ReadWholeOrBlank(std::string_view text, const char* name,
                                             std::int32_t min, std::int32_t max,
                                             const HazardPlace& place);

/// UTC seconds of YYYYMMDDHH. @throws InputError for a date that is not
std::int64_t ReadHour(std::string_view text, const HazardPlace& place);
/// UTC seconds of "YYYY-MM-DD HH:MM[:SS]" with T or a blank, '-' or '/', one or two digits of
/// month, day and hour, and Z or ±HH:MM or, without a zone, `zone_s` east of Greenwich; none: it is
/// no such time.
std::optional<std::int64_t> ParseDateTime(std::string_view text, std::int64_t zone_s);

/// Tenths of a degree, at most 90 either way. @throws InputError
double ReadLatitudeTenths(std::string_view text, const HazardPlace& place);
/// Tenths of a degree up to 3600, brought to (-180, 180]. @throws InputError
double ReadLongitudeTenths(std::string_view text, const HazardPlace& place);
/// Brings [-180, 360] to (-180, 180].
double NormalLongitude(double longitude);

/// Adds a fix after the ones there. A time that is there already is left out with a warning.
/// @throws InputError for a time before the last, or too many fixes
void AppendFix(HazardFix fix, std::vector<HazardFix>& fixes, HazardPlace& place);

/// Ends a track: checks that it has fixes, computes what motion the source does not give.
void FinishTrack(HazardTrack& track, const HazardPlace& place);

/// Puts a ring in order of wind. @returns false when there is one of this wind already
bool AddRing(WindRing ring, std::vector<WindRing>& rings);

/// "NE", "ENE", "西北", … as a compass bearing; none: no direction.
std::optional<double> ParseDirection(std::string_view text);

/// What the header of a storm says in the best tracks of CMA and JMA.
struct BestTrackHeader {
  HazardTrack track;
  std::int32_t points{};  ///< lines that follow
};

/// Storms of a header, 66666 …, and as many points as it promises, each on a line of its own.
std::vector<HazardTrack> ReadBestTracks(std::string_view text, HazardPlace& place,
                                        BestTrackHeader (*read_header)(std::string_view line,
                                                                       const HazardPlace& place),
                                        HazardFix (*read_point)(std::string_view line,
                                                                const HazardPlace& place));

// The readers, one a format; `place` refuses and warns.
std::vector<HazardTrack> ReadCma(std::string_view text, HazardPlace& place);
std::vector<HazardTrack> ReadJma(std::string_view text, HazardPlace& place);
std::vector<HazardTrack> ReadAtcf(std::string_view text, HazardPlace& place);
std::vector<HazardTrack> ReadIbtracs(std::string_view text, HazardPlace& place);
std::vector<HazardTrack> ReadBulletin(const std::string& text, HazardPlace& place);
std::vector<HazardTrack> ReadWeatherService(const std::string& text, HazardPlace& place);

}  // namespace aquafarm::internal
