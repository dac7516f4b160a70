// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Saves and loads the numbers of a learner as a section of named numbers (Checkpoint::SetNumbers).
// One list of fields serves both directions: fields(visit) calls visit(name, number) for each
// number. A field may also be a random stream, which is saved as the number of draws taken from it.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/rng.h"

namespace aquafarm::agents {

template <typename Value>
Checkpoint::Number SavedNumber(const Value& value) {
  using Saved = std::conditional_t<std::is_floating_point_v<Value>, double, std::uint64_t>;
  return static_cast<Saved>(value);
}
inline Checkpoint::Number SavedNumber(const RandomStream& stream) { return stream.position(); }

// Converts a number.
// @throws InputError if the number does not fit into the type
template <typename Value, typename Number>
Value Converted(Number number) {
  if constexpr (std::is_floating_point_v<Number> && std::is_integral_v<Value>) {
    // Doubles contain all integers up to 2^53.
    const double high =
        std::min(9007199254740992.0, static_cast<double>(std::numeric_limits<Value>::max()));
    const double low = std::is_signed_v<Value> ? -high : 0.0;
    if (!(number >= low && number <= high)) {
      throw InputError("checkpoint: got " + std::to_string(number) + ", expected a number in [" +
                       std::to_string(low) + ", " + std::to_string(high) +
                       "]: damaged, use another checkpoint");
    }
  } else if constexpr (std::is_integral_v<Number> && std::is_integral_v<Value>) {
    if (static_cast<Number>(static_cast<Value>(number)) != number) {
      throw InputError("checkpoint: got " + std::to_string(number) +
                       ", which is too large: damaged, use another checkpoint");
    }
  }
  return static_cast<Value>(number);
}

template <typename Number, typename Value>
void LoadNumber(Number number, Value& value) {
  value = Converted<Value>(number);
}
template <typename Number>
void LoadNumber(Number number, RandomStream& stream) {
  stream.Seek(Converted<std::uint64_t>(number));
}

template <typename Fields>
void SaveNumbers(Checkpoint& checkpoint, const std::string& section, const Fields& fields) {
  std::map<std::string, Checkpoint::Number> numbers;
  fields([&numbers](const char* name, const auto& value) { numbers[name] = SavedNumber(value); });
  checkpoint.SetNumbers(section, numbers);
}

// Loads the numbers from `section`. Checkpoints of older versions have the array `positional`
// instead, with values of type `Positional` in the order of the fields.
// @throws InputError if a number or both sections are missing, or a number does not fit
template <typename Positional, typename Fields>
void LoadNumbers(const Checkpoint& checkpoint, const std::string& section,
                 const std::string& positional, const Fields& fields) {
  if (!checkpoint.Has(section) && checkpoint.Has(positional)) {
    std::size_t count = 0;
    fields([&count](const char*, const auto&) { ++count; });
    std::vector<Positional> values;
    checkpoint.GetArray(positional, count, values);
    auto next = values.begin();
    fields([&next](const char*, auto& value) { LoadNumber(*next++, value); });
    return;
  }
  const std::map<std::string, Checkpoint::Number> numbers = checkpoint.GetNumbers(section);
  fields([&](const char* name, auto& value) {
    const auto found = numbers.find(name);
    if (found == numbers.end()) {
      throw InputError("checkpoint: section '" + section + "': has no number '" + name +
                       "'; use another checkpoint");
    }
    std::visit([&](auto number) { LoadNumber(number, value); }, found->second);
  });
}

}  // namespace aquafarm::agents
