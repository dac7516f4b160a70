// SPDX-License-Identifier: BSD-3-Clause
#include "input/json_object.h"

#include <algorithm>
#include <array>
#include <set>

#include "base/field_error.h"
#include "base/text.h"
#include "base/time.h"
#include "grid/longitude.h"

namespace aquafarm::internal {
namespace {

using Json = nlohmann::json;

std::int32_t LineAt(const std::string& text, std::size_t offset) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(offset, text.size()));
  return static_cast<std::int32_t>(1 + std::count(text.begin(), end, '\n'));
}

// Returns whether a value is null, a blank string or "null".
bool SaysNothing(const Json& value) {
  if (!value.is_string()) return value.is_null();
  const std::string& text = value.get_ref<const std::string&>();
  return Trim(text).empty() || text == "null";
}

// Iterator that passes a text to the parser and records the position that it has reached.
class ReadingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;
  ReadingIterator(const char* at, const char** read) : at_(at), read_(read) {}
  reference operator*() const { return *at_; }
  ReadingIterator& operator++() {
    *read_ = ++at_;
    return *this;
  }
  ReadingIterator operator++(int) {
    const ReadingIterator before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const ReadingIterator& a, const ReadingIterator& b) {
    return a.at_ == b.at_;
  }
  friend bool operator!=(const ReadingIterator& a, const ReadingIterator& b) { return !(a == b); }

 private:
  const char* at_;
  const char** read_;
};

// Parses until the value at a path is found, and then stops. Records its position, or that of its
// nearest parent.
class PathFinder : public nlohmann::json_sax<Json> {
 public:
  PathFinder(const std::string& wanted, const char* const& read) : wanted_(wanted), read_(read) {}
  /// Position after the value at the path; for an object or a list, after its opening bracket. If
  /// the path has no value, position after the opening bracket of its nearest parent.
  const char* found() const { return found_; }
  bool null() override { return Value(); }
  bool boolean(bool) override { return Value(); }
  bool number_integer(number_integer_t) override { return Value(); }
  bool number_unsigned(number_unsigned_t) override { return Value(); }
  bool number_float(number_float_t, const string_t&) override { return Value(); }
  bool string(string_t&) override { return Value(); }
  bool binary(binary_t&) override { return Value(); }
  bool start_object(std::size_t) override { return Open(false); }
  bool start_array(std::size_t) override { return Open(true); }
  bool end_object() override { return Close(); }
  bool end_array() override { return Close(); }
  bool key(string_t& key) override {
    levels_.back().key = key;
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const Json::exception&) override {
    return false;
  }

 private:
  struct Level {
    bool array{};
    std::size_t index{};
    std::string key;
    std::string path;
  };
  std::string Path() const {
    if (levels_.empty()) return "";
    const Level& level = levels_.back();
    return level.array ? internal::At(level.path, level.index) : Join(level.path, level.key);
  }
  // Returns whether `path` is the wanted path. If `path` is the wanted path or a parent of it,
  // records the current position. A parent that is parsed later is deeper, so its position replaces
  // the recorded one.
  bool IsWanted(const std::string& path) {
    const bool holds = wanted_.compare(0, path.size(), path) == 0;
    const bool ends = path.empty() || path.size() == wanted_.size() ||
                      (holds && (wanted_[path.size()] == '.' || wanted_[path.size()] == '['));
    if (holds && ends) found_ = read_;
    return path == wanted_;
  }
  bool Value() {
    if (IsWanted(Path())) return false;
    if (!levels_.empty()) ++levels_.back().index;
    return true;
  }
  bool Open(bool array) {
    const std::string path = Path();
    if (IsWanted(path)) return false;
    levels_.push_back({array, 0, "", path});
    return true;
  }
  bool Close() {
    levels_.pop_back();
    if (!levels_.empty()) ++levels_.back().index;
    return true;
  }
  const std::string& wanted_;
  const char* const& read_;
  const char* found_{};
  std::vector<Level> levels_;
};

// Rejects JSON with more than 64 nested levels. Bulletins and charts have fewer.
void CheckDepth(const std::string& text, ParseContext& place) {
  constexpr int kMaxDepth = 64;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\') {
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && (c == '[' || c == '{')) {
      if (++depth <= kMaxDepth) continue;
      place.path.clear();
      place.line = LineAt(text, i);
      place.Fail("got JSON nested more deeply than " + std::to_string(kMaxDepth) +
                 " levels, expected a bulletin or a chart");
    } else if (!quoted && (c == ']' || c == '}')) {
      --depth;
    }
  }
}

std::string Shown(const Json* value) {
  if (value == nullptr) return "nothing";
  if (value->is_object()) return "an object";
  if (value->is_array()) return "a list";
  if (value->is_string()) return Quoted(value->get_ref<const std::string&>());
  return value->dump();
}

std::string InRange(double min, double max) {
  return "a number in [" + Format(min) + ", " + Format(max) + "]";
}

// Returns the position after leading blanks and JavaScript comments.
std::size_t EndOfComments(const std::string& text) {
  std::size_t at = text.find_first_not_of(" \t\r\n");
  while (at != std::string::npos && text[at] == '/') {
    const bool block = text.compare(at, 2, "/*") == 0;
    if (!block && text.compare(at, 2, "//") != 0) return at;
    const std::size_t end = block ? text.find("*/", at + 2) : text.find('\n', at);
    at = end == std::string::npos ? end : text.find_first_not_of(" \t\r\n", end + (block ? 2 : 0));
  }
  return std::min(at, text.size());
}

}  // namespace

bool IsAssignment(std::string_view text) {
  for (const std::string_view word : {"let ", "var ", "const "}) {
    if (text.substr(0, word.size()) == word) return text.find('=') != std::string_view::npos;
  }
  return false;
}

std::string CleanJson(const std::string& text) {
  std::string clean = text;
  const auto blank = [&clean](std::size_t first, std::size_t end) {
    std::fill(clean.begin() + static_cast<std::ptrdiff_t>(first),
              clean.begin() + static_cast<std::ptrdiff_t>(end), ' ');
  };
  if (clean.compare(0, 3, "\xEF\xBB\xBF") == 0) blank(0, 3);
  const std::size_t script = EndOfComments(clean);
  const std::string_view rest = std::string_view(clean).substr(script);
  const bool assigned = IsAssignment(rest.substr(0, rest.find('\n')));
  const std::size_t value = assigned ? clean.find('=', script) + 1 : script;
  std::replace_if(
      clean.begin(), clean.begin() + static_cast<std::ptrdiff_t>(value),
      [](char c) { return c != '\n'; }, ' ');
  const std::size_t last = clean.find_last_not_of(" \t\r\n");
  if (assigned && last != std::string::npos && clean[last] == ';') blank(last, last + 1);
  const std::size_t fence = clean.find_first_not_of(" \t\r\n");
  if (fence == std::string::npos || clean.compare(fence, 3, "```") != 0) return clean;
  blank(fence, std::min(clean.find('\n', fence), clean.size()));
  const std::size_t end = clean.rfind("```");
  if (end != std::string::npos) blank(end, std::min(clean.find('\n', end), clean.size()));
  return clean;
}

Json ParseJson(const std::string& text, ParseContext& place) {
  CheckDepth(text, place);
  const char* read = text.data();
  const char* const end = text.data() + text.size();
  std::vector<std::set<std::string>> keys;  // keys of the enclosing objects
  const auto check = [&](int, Json::parse_event_t event, const Json& parsed) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event != Json::parse_event_t::key) return true;
    const std::string& key = parsed.get_ref<const std::string&>();
    if (keys.back().insert(key).second) return true;
    place.path.clear();
    place.line = LineAt(text, static_cast<std::size_t>(read - text.data()));
    place.Fail("got the key " + Quoted(key) + " twice in an object, expected it once");
  };
  try {
    return Json::parse(ReadingIterator(text.data(), &read), ReadingIterator(end, &read), check);
  } catch (const Json::parse_error& error) {
    place.path.clear();
    place.line = LineAt(text, error.byte == 0 ? 0 : error.byte - 1);
    const std::string what = error.what();
    const std::size_t reason = what.find("; ");  // the library writes: position; reason
    place.Fail("invalid JSON: " + (reason == std::string::npos ? what : what.substr(reason + 2)));
  } catch (const Json::out_of_range& error) {  // a number is too large; the message contains it
    const std::string what = error.what();
    const std::size_t from = what.find('\'') + 1;
    const std::string number = what.substr(from, what.rfind('\'') - from);
    place.path.clear();
    place.line = LineAt(text, std::min(text.find(number), text.size()));
    place.Fail("got " + Quoted(number) + ", expected a number that a double can hold");
  }
}

bool IsBlank(const Json& value) {
  if (!value.is_object()) return SaysNothing(value);
  return std::all_of(value.begin(), value.end(), SaysNothing);
}

std::int32_t LineOfJson(const std::string& text, const std::string& path) {
  const char* read = text.data();
  PathFinder finder(path, read);
  const char* end = text.data() + text.size();
  Json::sax_parse(ReadingIterator(text.data(), &read), ReadingIterator(end, &read), &finder);
  const char* found = finder.found();
  // To find the end of a number, the parser reads the character after it, which may be a line feed.
  // The - 1 excludes this character.
  return found == nullptr || found == text.data()
             ? 1
             : LineAt(text, static_cast<std::size_t>(found - text.data() - 1));
}

namespace {

// Calls `read` and rethrows an InputError as a FixError, for a time or a position.
template <typename Read>
auto OfFix(Read read) {
  try {
    return read();
  } catch (const InputError& error) {
    throw FixError(error.what());
  }
}

}  // namespace

JsonObject::JsonObject(const Json& value, std::string path, ParseContext& place)
    : value_(value), path_(std::move(path)), place_(place) {
  if (value.is_object()) return;
  place_.FailValue(path_, "got " + Shown(&value) + ", expected an object");
}

const Json* JsonObject::Find(Keys keys) const {
  for (const char* key : keys) {
    const auto found = value_.find(key);
    if (found != value_.end() && !SaysNothing(*found)) return &*found;
  }
  return nullptr;
}

std::string JsonObject::KeyOf(Keys keys) const {
  for (const char* key : keys) {
    if (Find({key}) != nullptr) return key;
  }
  for (const char* key : keys) {
    if (value_.contains(key)) return key;
  }
  return *keys.begin();
}

void JsonObject::Fail(Keys keys, const Json* got, const std::string& expected) const {
  place_.FailValue(Join(path_, KeyOf(keys)), "got " + Shown(got) + ", expected " + expected);
}

std::optional<double> JsonObject::Number(Keys keys, double min, double max) const {
  const Json* value = Find(keys);
  if (value == nullptr) return std::nullopt;
  std::optional<double> number;
  if (value->is_number()) number = value->get<double>();
  if (value->is_string()) number = ParseNumber(value->get_ref<const std::string&>());
  if (number && *number >= min && *number <= max) return number;
  Fail(keys, value, InRange(min, max));
}

double JsonObject::NeedNumber(Keys keys, double min, double max) const {
  const std::optional<double> number = Number(keys, min, max);
  if (number) return *number;
  Fail(keys, nullptr, InRange(min, max));
}

std::string JsonObject::Text(Keys keys) const {
  const Json* value = Find(keys);
  if (value == nullptr) return "";
  if (value->is_number()) return value->dump();
  if (!value->is_string()) Fail(keys, value, "a text");
  return value->get<std::string>();
}

template <typename Read>
auto JsonObject::Try(Keys keys, Read read) const -> decltype(read()) {
  try {
    return read();
  } catch (const InputError& error) {
    place_.WarnOnce(KeyOf(keys), error, kIgnored);
    return {};
  }
}

std::optional<double> JsonObject::TryNumber(Keys keys, double min, double max) const {
  return Try(keys, [&] { return Number(keys, min, max); });
}

std::string JsonObject::TryText(Keys keys) const {
  return Try(keys, [&] { return Text(keys); });
}

const Json* JsonObject::TryList(Keys keys) const {
  return Try(keys, [&] { return List(keys); });
}

std::int64_t JsonObject::NeedTime(Keys keys, std::int64_t zone_s) const {
  return OfFix([&] {
    const std::optional<std::int64_t> time = ParseDateTime(Text(keys), zone_s);
    if (!time) Fail(keys, Find(keys), "a time such as 2021-07-25T14:00:00");
    return *time;
  });
}

GeoPoint JsonObject::NeedPosition(Keys latitude, Keys longitude) const {
  return OfFix([&]() -> GeoPoint {
    return {NeedNumber(latitude, -90.0, 90.0),
            NormalLongitude(NeedNumber(longitude, -180.0, 360.0))};
  });
}

const Json* JsonObject::List(Keys keys) const {
  const Json* value = Find(keys);
  if (value != nullptr && !value->is_array()) Fail(keys, value, "a list");
  return value;
}

ParseContext& JsonObject::Here() const {
  place_.line = 0;
  place_.path = path_;
  return place_;
}

}  // namespace aquafarm::internal
