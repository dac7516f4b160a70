// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Functions that read one option of a learner. If the option is not given, `value` does not change
/// and ReadWord returns `fallback`.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "aquafarm/agents/base/options.h"
#include "aquafarm/base/check.h"

namespace aquafarm::agents {

/// Reads an option whose value is one of `words`.
/// @param words names of the values of the enum Kind, in the order of the enum
/// @throws InputError "loss: got 'l1', expected one of: huber, mse"
template <typename Kind, std::size_t size>
Kind ReadWord(OptionReader& reader, const std::string& key, Kind fallback,
              const std::array<std::string_view, size>& words) {
  const std::string text = reader.Text(key, std::string(words[static_cast<std::size_t>(fallback)]));
  std::vector<std::string> names;
  for (std::size_t i = 0; i < size; ++i) {
    if (text == words[i]) return static_cast<Kind>(i);
    names.emplace_back(words[i]);
  }
  throw InputError(key + ": got '" + text + "', expected one of: " + Join(names));
}

/// Reads a whole number in [min, max].
/// @throws InputError if the value is out of range or not a whole number
template <typename Whole>
void ReadWhole(OptionReader& reader, const std::string& key, double min, double max, Whole& value) {
  const double got = reader.Number(key, static_cast<double>(value), min, max);
  value = static_cast<Whole>(got);
  if (static_cast<double>(value) == got) return;
  throw InputError(key + ": got " + FormatNumber(got) + ", expected a whole number");
}

/// Reads a number in [min, max]. @throws InputError in the same cases as OptionReader::Number
inline void ReadNumber(OptionReader& reader, const std::string& key, double min, double max,
                       double& value) {
  value = reader.Number(key, value, min, max);
}

/// Reads true or false. @throws InputError in the same cases as OptionReader::Flag
inline void ReadFlag(OptionReader& reader, const std::string& key, bool& value) {
  value = reader.Flag(key, value);
}

/// Reads a schedule of numbers in [min, max]. @throws InputError in the same cases as ParseSchedule
inline void ReadSchedule(OptionReader& reader, const std::string& key, double min, double max,
                         Schedule& value) {
  value = reader.GetSchedule(key, value, min, max);
}

/// Reads the option `device`: auto (the default), cpu or cuda.
/// @throws InputError if it has another value
inline std::string ReadDevice(OptionReader& reader) {
  constexpr std::array<std::string_view, 3> kDevices{"auto", "cpu", "cuda"};
  enum class Device : std::uint8_t { kAuto, kCpu, kCuda };
  const auto device = ReadWord(reader, "device", Device::kAuto, kDevices);
  return std::string(kDevices[static_cast<std::size_t>(device)]);
}

}  // namespace aquafarm::agents
