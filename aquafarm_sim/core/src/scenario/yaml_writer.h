// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenario/schema.h"

namespace aquafarm::internal {

/// Archive that writes structs as YAML, one key per line, in the order of schema.h.
class YamlWriter {
 public:
  static constexpr bool kReads = false;
  /// @param old_names whether renamed keys get their old names
  explicit YamlWriter(bool old_names = false) : old_names_(old_names) {}

  static bool Has(const char*, bool fallback) { return fallback; }
  void When(bool used, const char*) { used_ = used; }
  void Always() { used_ = true; }
  const std::string& text() const { return text_; }

  template <typename T, typename Domain>
  void Field(const char* key, const T& value, const Domain&, Need = Need::kOptional) {
    if (used_) Line(key, Value(value));
  }
  template <typename T, typename Domain>
  void Field(const char* key, const std::optional<T>& value, const Domain& domain,
             Need need = Need::kOptional) {
    if (value) Field(key, *value, domain, need);
  }
  void Field(const char* key, std::int64_t value, UtcTime, Need = Need::kOptional) {
    if (used_) Line(key, FormatTime(value));
  }
  void Field(const char* key, const std::string& value, LinesOf, Need = Need::kOptional) {
    if (used_) Block(key, value);
  }
  template <typename T, typename Domain>
  void Renamed(const char* key, const char* old_key, const T& value, const Domain& domain) {
    Field(old_names_ ? old_key : key, value, domain);
  }
  template <typename Visit>
  void Struct(const char* key, const Visit& visit) {
    if (!used_) return;
    Line(key, "");
    depth_ += 2;
    visit(*this);
    depth_ -= 2;
  }
  template <typename T, typename Visit>
  void Optional(const char* key, const std::optional<T>& value, const Visit& visit) {
    if (value) Struct(key, [&](YamlWriter& self) { visit(self, *value); });
  }
  template <typename T, typename Visit>
  void Structs(const char* key, const std::vector<T>& values, std::array<std::size_t, 2>,
               const Visit& visit) {
    if (!used_ || values.empty()) return;
    Line(key, "");
    depth_ += 4;
    for (const T& value : values) {
      dash_ = true;
      visit(*this, value);
    }
    depth_ -= 4;
  }

  /// Returns the text of a value.
  static std::string Value(float value) { return std::isnan(value) ? ".nan" : Format(value); }
  static std::string Value(double value) { return Format(value); }
  static std::string Value(std::int32_t value) { return Format(value); }
  static std::string Value(std::uint64_t value) { return Format(value); }
  static std::string Value(bool value) { return value ? "true" : "false"; }
  static std::string Value(const std::string& value);
  static std::string Value(Cell cell) { return Pair(cell.x, cell.y); }
  static std::string Value(const std::array<float, 2>& pair) { return Pair(pair[0], pair[1]); }
  static std::string Value(const QuadrantRadii& radii) {
    return Value(std::vector<float>(radii.begin(), radii.end()));
  }
  template <typename T>
  static std::string Value(const Range<T>& range) {
    return Pair(range.min, range.max);
  }
  template <typename Enum>
  static std::enable_if_t<std::is_enum_v<Enum>, std::string> Value(Enum value) {
    return std::string(ToString(value));
  }
  template <typename T>
  static std::string Pair(T first, T second) {
    return "[" + Value(first) + ", " + Value(second) + "]";
  }
  template <typename T>
  static std::string Value(const std::vector<T>& values) {
    std::string text;
    for (const T& value : values) text += (text.empty() ? "[" : ", ") + Value(value);
    return text.empty() ? "[]" : text + "]";
  }

 private:
  void Line(const char* key, const std::string& value);
  void Block(const char* key, const std::string& lines);

  std::string text_;
  bool old_names_;
  std::size_t depth_{0};
  bool dash_{false};
  bool used_{true};
};

}  // namespace aquafarm::internal
