// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "aquafarm/sea/sea_field.h"

namespace aquafarm {

/// An input of an expression.
struct NamedLayer {
  std::string name;  ///< letters, digits and _; must not start with a digit
  Layer layer;
};

/// Evaluates an expression in muParser syntax (+ - * / ^, comparisons, ?:, min, max, exp …) at
/// every cell. Each layer is a variable with the layer's name. The result is NaN in a cell where a
/// layer that the expression uses is NaN.
/// @param layers at least one; all of the same shape, which the result also has
/// @throws InputError without layers, or for an invalid expression, for example "got 'sal * ',
///   expected an expression: …"
/// @throws LogicError for layers of different sizes
Layer Evaluate(const std::string& expression, const std::vector<NamedLayer>& layers);

}  // namespace aquafarm
