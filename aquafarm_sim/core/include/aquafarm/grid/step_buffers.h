// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "aquafarm/grid/step_fields.h"

namespace aquafarm {

/// Resizes the arrays of a step's results and sets the pointers of `output` to them. For a field
/// that `bits` excludes, the array becomes empty and the pointer null.
/// @param results arrays, with the members that VisitStepFields lists
/// @param output pointers, such as BatchOutput
template <typename Results, typename Output>
void SizeStepFields(const StepShape& shape, std::uint8_t bits, Results& results, Output& output) {
  VisitStepFields(
      [&](const StepField& field, auto& values, auto*& to) {
        values.resize(field.IsIn(bits) ? field.Size(shape) : 0);
        to = values.empty() ? nullptr : values.data();
      },
      results, output);
}

}  // namespace aquafarm
