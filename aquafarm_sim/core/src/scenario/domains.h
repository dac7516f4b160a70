// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Types of domains. A domain is the set of valid values of a scenario key. schema.h declares the
/// domain of each key once. The reader, the writer and the validation of scenarios created in code
/// use these declarations.

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "aquafarm/scenario/scenario.h"
#include "base/field_error.h"
#include "base/text.h"
#include "base/time.h"

namespace aquafarm::internal {

/// Numbers in [min, max], or in (min, max] if `open_min`.
template <typename T>
struct Interval {
  T min{};
  T max{};
  bool open_min{false};
};

/// UTF-8 text without control characters except line breaks.
struct TextOf {
  std::size_t min_bytes{};
  std::size_t max_bytes{};
};
/// Text of several lines, which the writer writes as a YAML block ("|").
struct LinesOf : TextOf {};
/// A cell of the largest possible map. ValidateScenario checks that it is on the scenario's map.
struct AnyCell {};
struct AnyFlag {};
/// A finite number or NaN (.nan in files).
struct NumberOrNone {};
/// One of the names of an enum.
struct OneOfNames {};
/// UTC seconds since 1970, written as YYYY-MM-DDTHH:MM:SSZ.
struct UtcTime {};

/// Lists of `min_size` to `max_size` entries.
template <typename Domain>
struct ListOf {
  Domain entry;
  std::size_t min_size{};
  std::size_t max_size{};
};

template <typename Enum>
inline constexpr std::size_t kNameCount = 0;
template <>
inline constexpr std::size_t kNameCount<LayoutMode> = kLayoutModeCount;
template <>
inline constexpr std::size_t kNameCount<DevicePlacement> = kDevicePlacementCount;
template <>
inline constexpr std::size_t kNameCount<Border> = kBorderCount;
template <>
inline constexpr std::size_t kNameCount<ViewMode> = kViewModeCount;
template <>
inline constexpr std::size_t kNameCount<RewardSharing> = kRewardSharingCount;
template <>
inline constexpr std::size_t kNameCount<DeviceKind> = kDeviceKindCount;
template <>
inline constexpr std::size_t kNameCount<DisasterKind> = kDisasterKindCount;

template <typename T>
std::string Describe(const Interval<T>& domain) {
  return (domain.open_min ? "(" : "[") + Format(domain.min) + ", " + Format(domain.max) + "]";
}

template <typename Enum>
std::vector<std::string> NamesOf() {
  static_assert(kNameCount<Enum> > 0);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kNameCount<Enum>; ++i) {
    names.emplace_back(ToString(static_cast<Enum>(i)));
  }
  return names;
}

// Check throws FieldError if a value is outside its domain.

template <typename T>
void Check(const std::string& path, T value, const Interval<T>& domain) {
  const bool above = domain.open_min ? value > domain.min : value >= domain.min;
  if (above && value <= domain.max) return;  // false for NaN
  throw FieldError(path, "got " + Format(value) + ", expected " + Describe(domain));
}

template <typename T, typename Domain>
void Check(const std::string& path, const std::optional<T>& value, const Domain& domain) {
  if (value) Check(path, *value, domain);
}

template <typename T>
void Check(const std::string& path, const Range<T>& value, const Interval<T>& domain) {
  Check(At(path, 0), value.min, domain);
  Check(At(path, 1), value.max, domain);
  if (value.min <= value.max) return;
  throw FieldError(path, "got [" + Format(value.min) + ", " + Format(value.max) +
                             "], expected the smaller number first");
}

inline void Check(const std::string& path, const std::array<float, 2>& value,
                  const Interval<float>& domain) {
  Check(At(path, 0), value[0], domain);
  Check(At(path, 1), value[1], domain);
}

inline void Check(const std::string& path, const QuadrantRadii& value,
                  const Interval<float>& domain) {
  for (std::size_t i = 0; i < value.size(); ++i) Check(At(path, i), value[i], domain);
}

void Check(const std::string& path, float value, NumberOrNone domain);

inline void Check(const std::string& path, Cell cell, AnyCell) {
  constexpr Interval<std::int32_t> kSide{0, kMaxSide - 1};
  Check(At(path, 0), cell.x, kSide);
  Check(At(path, 1), cell.y, kSide);
}

inline void Check(const std::string&, bool, AnyFlag) {}
void Check(const std::string& path, std::int64_t seconds, UtcTime domain);

void Check(const std::string& path, const std::string& value, const TextOf& domain);

template <typename Enum>
std::enable_if_t<std::is_enum_v<Enum>> Check(const std::string& path, Enum value, OneOfNames) {
  const auto code = static_cast<std::size_t>(value);
  if (code < kNameCount<Enum>) return;
  throw FieldError(path, "got code " + std::to_string(code) + ", expected [0, " +
                             std::to_string(kNameCount<Enum> - 1) + "]");
}

/// @param sizes min and max number of entries
inline void CheckSize(const std::string& path, std::size_t size,
                      const std::array<std::size_t, 2>& sizes) {
  if (size >= sizes[0] && size <= sizes[1]) return;
  throw FieldError(path, "got " + std::to_string(size) + " entries, expected [" +
                             std::to_string(sizes[0]) + ", " + std::to_string(sizes[1]) + "]");
}

template <typename T, typename Domain>
void Check(const std::string& path, const std::vector<T>& values, const ListOf<Domain>& domain) {
  CheckSize(path, values.size(), {domain.min_size, domain.max_size});
  for (std::size_t i = 0; i < values.size(); ++i) Check(At(path, i), values[i], domain.entry);
}

}  // namespace aquafarm::internal
