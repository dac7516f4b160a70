// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/storms/notices.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "base/field_error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/time.h"
#include "input/file_type.h"
#include "input/json_object.h"

namespace aquafarm {
namespace {

using internal::JsonObject;
using internal::ParseContext;
using internal::Quoted;
using Json = nlohmann::json;

constexpr std::int64_t kBeijing_s = 8 * 3600;
constexpr const char* kExpected = ", expected a weather service's warnings or anchorage forecasts";

// Returns 1 to 4 for Blue, Yellow, Orange and Red; 0 for White, which is not a warning.
std::int32_t GradeOf(const JsonObject& warning, const std::string& color) {
  constexpr std::array<const char*, 5> kColors{"WHITE", "BLUE", "YELLOW", "ORANGE", "RED"};
  for (std::size_t i = 0; i < kColors.size(); ++i) {
    if (internal::Upper(color) == kColors[i]) return static_cast<std::int32_t>(i);
  }
  warning.Here().FailValue(
      internal::Join(warning.path(), "severityColor"),
      "got " + Quoted(color) + ", expected White, Blue, Yellow, Orange or Red");
}

void CheckSpan(const Notice& notice, const JsonObject& where, const char* key) {
  if (notice.end > notice.start) return;
  where.Here().FailValue(internal::Join(where.path(), key),
                         "got an end that is not after the start");
}

std::vector<Notice> ReadWarnings(const JsonObject& answer, ParseContext& place) {
  const std::string code = answer.Text({"code"});
  if (!code.empty() && code != "200") {
    answer.Here().FailValue("code", "got " + Quoted(code) + ", expected '200'");
  }
  std::vector<Notice> notices;
  const Json* list = answer.List({"warning"});
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
    const JsonObject warning((*list)[i], internal::At("warning", i), place);
    if (warning.Text({"status"}) == "cancel") continue;
    Notice notice;
    notice.place = warning.Text({"sender"});
    notice.what = warning.Text({"typeName", "title"});
    notice.grade = GradeOf(warning, warning.Text({"severityColor", "level"}));
    notice.start = warning.NeedTime({"startTime", "pubTime"}, kBeijing_s);
    notice.end = warning.NeedTime({"endTime"}, kBeijing_s);
    CheckSpan(notice, warning, "endTime");
    notices.push_back(std::move(notice));
  }
  return notices;  // empty if no warning is in force
}

// Returns the upper end [m] of a range such as "<0.5m" or "1.0-1.5m", or the number of a text such
// as "2m"; nullopt for other texts.
std::optional<double> WaveMax(const std::string& text) {
  if (text.size() < 2 || text.back() != 'm') return std::nullopt;
  const std::size_t from = text.find_first_of("-<");
  const std::size_t start = from == std::string::npos ? 0 : from + 1;
  const auto value = internal::ParseNumber(text.substr(start, text.size() - 1 - start));
  return value && *value >= 0.0 && *value <= 40.0 ? value : std::nullopt;
}

// Removes a number of one or two digits, followed by `word`, from the front of a text and returns
// the number; nullopt if the text does not begin so.
std::optional<int> TakeNumber(std::string& text, const std::string& word) {
  const std::size_t at = text.find(word);
  if (at == 0 || at == std::string::npos || at > 2) return std::nullopt;
  std::int32_t value = 0;
  if (!internal::Parse(text[0] == '0' ? text.substr(1, at - 1) : text.substr(0, at), value)) {
    if (text.substr(0, at) != "0") return std::nullopt;
  }
  text.erase(0, at + word.size());
  return value;
}

// Converts a day of the month and an hour to a time. There are three candidates for the month: that
// of the publication, the previous month and the next month. Calendar selects the month in which
// the day is nearest to the publication.
class Calendar {
 public:
  /// @param published "2026050411", Beijing time
  Calendar(const JsonObject& answer, const std::string& published) {
    const bool digits =
        published.size() == 10 && published.find_first_not_of("0123456789") == std::string::npos;
    const auto part = [&](std::size_t from, std::size_t count) {
      return std::stoi(published.substr(from, count));
    };
    if (digits) {
      year_ = part(0, 4);
      month_ = part(4, 2);
      if (const auto time = internal::UtcSeconds(year_, month_, part(6, 2), part(8, 2), 0, 0)) {
        published_ = *time;
        return;
      }
    }
    answer.Here().FailValue("publishCode", "got " + Quoted(published) + ", expected YYYYMMDDHH");
  }
  /// Returns UTC [s since 1970]; nullopt if there is no such day or hour.
  /// @param hour [0, 24] in Beijing time; 24 is the end of the day
  std::optional<std::int64_t> At(int day, int hour) const {
    if (hour < 0 || hour > 24) return std::nullopt;
    std::optional<std::int64_t> nearest;
    for (int away = -1; away <= 1; ++away) {
      const int months = year_ * 12 + month_ - 1 + away;
      const auto midnight = internal::UtcSeconds(months / 12, months % 12 + 1, day, 0, 0, 0);
      if (!midnight) continue;
      const auto far = [this](std::int64_t time) { return std::abs(time - published_); };
      if (!nearest || far(*midnight) < far(*nearest)) nearest = midnight;
    }
    if (!nearest) return std::nullopt;
    return *nearest + hour * 3600 - kBeijing_s;
  }

 private:
  int year_{};
  int month_{};
  std::int64_t published_{};  // Beijing time, computed as if it were UTC
};

// Parses "04日23时-05日02时" to notice.start and notice.end. The second day may be missing if it
// equals the first. Returns false if the text has another form.
bool ReadPeriod(std::string text, const Calendar& calendar, Notice& notice) {
  const auto day = TakeNumber(text, "日");
  const auto from = TakeNumber(text, "时-");
  if (!day || !from) return false;
  const auto next_day = text.find("日") == std::string::npos ? day : TakeNumber(text, "日");
  const auto to = TakeNumber(text, "时");
  if (!next_day || !to || !text.empty()) return false;
  const auto start = calendar.At(*day, *from);
  const auto end = calendar.At(*next_day, *to);
  if (!start || !end) return false;
  notice.start = *start;
  notice.end = *end;
  return true;
}

// Returns the worst (smallest) of the ratings in a text such as "4 4 3 3"; 0 for an empty text.
std::int32_t Worst(const JsonObject& period, const std::string& ratings) {
  std::int32_t worst = 0;
  for (const std::string_view word : internal::SplitWords(ratings)) {
    if (word.size() != 1 || word[0] < '1' || word[0] > '4') {
      period.Here().FailValue(internal::Join(period.path(), "Riskrating"),
                              "got " + Quoted(ratings) + ", expected numbers from 1 to 4");
    }
    const std::int32_t rating = word[0] - '0';
    worst = worst == 0 ? rating : std::min(worst, rating);
  }
  return worst;
}

std::vector<Notice> ReadAnchorages(const JsonObject& answer, ParseContext& place) {
  const Calendar calendar(answer, answer.Text({"publishCode"}));
  std::vector<Notice> notices;
  const Json* anchors = answer.Find({"anchors"});
  const JsonObject named(*anchors, "anchors", place);
  if (anchors->empty()) place.WarnValue("anchors", "got none, expected anchorages by name");
  for (const auto& [name, value] : anchors->items()) {
    const std::string path = internal::Join("anchors", name);
    const JsonObject anchor(value, path, place);
    const Json* periods = anchor.List({"PreciseForecast"});
    if (periods == nullptr || periods->empty()) {
      place.WarnValue(path, "got no PreciseForecast; the anchorage is left out");
    }
    for (std::size_t i = 0; periods != nullptr && i < periods->size(); ++i) {
      const JsonObject period((*periods)[i],
                              internal::At(internal::Join(path, "PreciseForecast"), i), place);
      Notice notice;
      notice.place = name;
      const std::string time = period.Text({"Time"});
      if (!ReadPeriod(time, calendar, notice)) {
        period.Here().FailValue(
            internal::Join(period.path(), "Time"),
            "got " + Quoted(time) + ", expected a period such as '04日08时-11时'");
      }
      CheckSpan(notice, period, "Time");
      notice.wind_mps = period.Number({"WindSpeedAvg"}, 0.0, 150.0);
      notice.gust_mps = period.Number({"WindSpeed"}, 0.0, 150.0);
      const std::string wave = period.Text({"WindWave"});
      notice.wave_max_m = WaveMax(wave);
      if (!wave.empty() && !notice.wave_max_m) {
        period.Here().FailValue(internal::Join(period.path(), "WindWave"),
                                "got " + Quoted(wave) + ", expected a range such as '0.5-1.0m'");
      }
      notice.suitability = Worst(period, period.Text({"Riskrating"}));
      notices.push_back(std::move(notice));
    }
  }
  return notices;
}

}  // namespace

NoticeFile ParseNotices(const std::string& text, const std::string& origin_name) {
  NoticeFile file;
  ParseContext place(origin_name, file.warnings);
  const std::string clean = internal::CleanJson(text);
  const internal::DetectedFile look = internal::DetectFileType(text);
  const bool notices = look.kind == internal::FileKind::kNotices;
  const std::size_t begin = clean.find_first_not_of(" \t\r\n");
  const bool object = begin != std::string::npos && clean[begin] == '{';
  if (!object && !notices) {
    place.line = 1;
    place.Fail("got " + look.words + kExpected);
  }
  place.locate_bytes = clean.size();
  place.locate = [&clean](const std::string& path) { return internal::LineOfJson(clean, path); };
  const Json document = internal::ParseJson(clean, place);
  const JsonObject answer(document, "", place);
  if (answer.Find({"alerts"}) != nullptr) {
    place.FailValue(
        "alerts", std::string("got the newer interface's alerts, which are not read") + kExpected);
  }
  if (answer.Find({"anchors"}) != nullptr) {
    file.notices = ReadAnchorages(answer, place);
    if (answer.Find({"warning"}) != nullptr) {
      place.WarnValue("warning", "is ignored in a file with anchors");
    }
  } else if (answer.Find({"warning"}) != nullptr) {
    file.notices = ReadWarnings(answer, place);
  } else {
    const bool known = look.kind != internal::FileKind::kUnknown && !notices;
    answer.Here().Fail("got " + (known ? look.words : "neither \"warning\" nor \"anchors\"") +
                       kExpected);
  }
  return file;
}

NoticeFile LoadNotices(const std::string& path) {
  return ParseNotices(internal::ReadTextFile(path), path);
}

std::string Describe(const Notice& notice) {
  std::string text = notice.what.empty() ? notice.place : notice.what + " of " + notice.place;
  if (notice.grade > 0) text += ", grade " + std::to_string(notice.grade);
  if (notice.wind_mps) text += ", wind " + internal::Format(*notice.wind_mps) + " m/s";
  if (notice.gust_mps) text += ", gusts " + internal::Format(*notice.gust_mps) + " m/s";
  if (notice.wave_max_m) text += ", waves to " + internal::Format(*notice.wave_max_m) + " m";
  if (notice.suitability > 0) text += ", rating " + std::to_string(notice.suitability) + " of 4";
  return text + ", from " + internal::FormatTime(notice.start) + " to " +
         internal::FormatTime(notice.end);
}

}  // namespace aquafarm
