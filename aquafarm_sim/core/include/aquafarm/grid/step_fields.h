// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The list of the fields of a step's results. Every struct with such results has one member for
/// each field, with the name of the field. The members of BatchOutput are pointers. Those of the
/// learners' StepResults and of the message StepResult are arrays. Every array is flat and
/// row-major.

#include <cstddef>
#include <cstdint>

#include "aquafarm/grid/reward.h"

namespace aquafarm {

/// Bits with which a request selects optional fields; equal to the constants of the message
/// StepResult.
enum StepFieldBits : std::uint8_t {
  kIndexField = 1,
  kFeaturesField = 2,
  kPlanesField = 4,
  kHashesField = 8,
  kTermsField = 16,
};

/// Sizes of the results of one step.
struct StepShape {
  std::size_t farms{};     ///< N
  std::size_t agents{};    ///< S, per farm
  std::size_t features{};  ///< F, per agent
  std::size_t planes{};    ///< P · H · W values, per agent
};

/// One field of a step's results.
struct StepField {
  enum class Rows : std::uint8_t { kFarms, kAgents };  ///< N rows, or N · S
  enum class Columns : std::uint8_t { kOne, kTerms, kFeatures, kPlanes };

  const char* name;  ///< name of the member
  Rows rows;
  Columns columns;   ///< values per row
  std::uint8_t bit;  ///< one of StepFieldBits; 0: never optional

  /// Returns whether the results of a request with `bits` contain this field.
  bool IsIn(std::uint8_t bits) const { return bit == 0 || (bits & bit) != 0; }
  /// Returns the number of values of the whole field.
  std::size_t Size(const StepShape& shape) const {
    const std::size_t count = shape.farms * (rows == Rows::kAgents ? shape.agents : 1);
    switch (columns) {
      case Columns::kTerms:
        return count * kRewardTermCount;
      case Columns::kFeatures:
        return count * shape.features;
      case Columns::kPlanes:
        return count * shape.planes;
      default:
        return count;
    }
  }
};

/// Calls visit(field, member…) for every field. `member…` are the members called field.name in the
/// given structs.
template <typename Visit, typename... Results>
void VisitStepFields(const Visit& visit, Results&... results) {
  using Columns = StepField::Columns;
  constexpr auto kFarms = StepField::Rows::kFarms;
  constexpr auto kAgents = StepField::Rows::kAgents;
  visit(StepField{"rewards", kAgents, Columns::kOne, 0}, results.rewards...);
  visit(StepField{"terms", kAgents, Columns::kTerms, kTermsField}, results.terms...);
  visit(StepField{"energy", kAgents, Columns::kOne, 0}, results.energy...);
  visit(StepField{"distance", kAgents, Columns::kOne, 0}, results.distance...);
  visit(StepField{"outcomes", kAgents, Columns::kOne, 0}, results.outcomes...);
  visit(StepField{"legal", kAgents, Columns::kOne, 0}, results.legal...);
  visit(StepField{"active", kAgents, Columns::kOne, 0}, results.active...);
  visit(StepField{"end_reasons", kFarms, Columns::kOne, 0}, results.end_reasons...);
  visit(StepField{"is_first", kFarms, Columns::kOne, 0}, results.is_first...);
  visit(StepField{"hashes", kFarms, Columns::kOne, kHashesField}, results.hashes...);
  visit(StepField{"index", kAgents, Columns::kOne, kIndexField}, results.index...);
  visit(StepField{"features", kAgents, Columns::kFeatures, kFeaturesField}, results.features...);
  visit(StepField{"planes", kAgents, Columns::kPlanes, kPlanesField}, results.planes...);
}

}  // namespace aquafarm
