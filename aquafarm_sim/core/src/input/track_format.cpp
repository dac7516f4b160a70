// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/input/track_format.h"

#include <vector>

#include "base/name_of.h"
#include "base/text.h"
#include "input/json_object.h"

namespace aquafarm {
namespace {

bool IsDigits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// Distinguishes the best tracks of CMA and JMA by the first point, which `text` starts with. A
// point of the JMA has a time of eight digits and then 002.
std::optional<TrackFormat> DetectBestTrack(std::string_view text) {
  const std::vector<std::string_view> words = internal::SplitWords(internal::TakeLine(text));
  if (words.empty() || !IsDigits(words[0])) return std::nullopt;
  if (words[0].size() == 8 && words.size() > 1 && words[1] == "002") return TrackFormat::kJma;
  return TrackFormat::kCma;
}

bool HasKey(std::string_view text, std::string_view key) {
  return text.find(key) != std::string_view::npos;
}

}  // namespace

std::string_view ToString(TrackFormat value) {
  return internal::NameOf(value, std::array<std::string_view, kTrackFormatCount>{
                                     "CMA best track", "JMA best track", "ATCF b-deck", "IBTrACS",
                                     "bulletin", "weather service track", "storm archive"});
}

std::optional<TrackFormat> DetectTrackFormat(const std::string& text) {
  std::string_view rest = internal::WithoutMark(text);
  const std::string_view whole = rest;
  const std::string_view first = internal::TakeLine(rest);
  if (first.substr(0, 5) == "66666") return DetectBestTrack(rest);
  if (first.substr(0, 16) == "aquafarm-storms ") return TrackFormat::kArchive;
  if (first.substr(0, 4) == "SID,") return TrackFormat::kIbtracs;
  std::vector<std::string_view> fields;
  internal::SplitFields(first.substr(0, 1000), fields);
  if (fields.size() > 7 && fields[0].size() == 2 && IsDigits(fields[2])) {
    return TrackFormat::kAtcf;
  }
  const bool json = !first.empty() && std::string_view("[{`/").find(first[0]) != first.npos;
  if (!json && !internal::IsAssignment(first)) return std::nullopt;
  if (HasKey(whole, "\"tfbh\"") || HasKey(whole, "\"tfid\"") ||
      (HasKey(whole, "\"points\"") && HasKey(whole, "\"ename\""))) {
    return TrackFormat::kBulletin;
  }
  if (HasKey(whole, "\"track\"") || HasKey(whole, "\"windRadius30\"") ||
      (HasKey(whole, "\"forecast\"") && HasKey(whole, "\"fxTime\""))) {
    return TrackFormat::kWeatherService;
  }
  return std::nullopt;
}

}  // namespace aquafarm
