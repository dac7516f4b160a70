// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "aquafarm/sea/sea_field.h"

namespace aquafarm {

/// A named input layer of an expression.
struct NamedLayer {
  std::string name;  ///< letters, digits and _; must not start with a digit
  Layer layer;
};

/// Evaluates an expression in muParser syntax (+ - * / ^, comparisons, ?:, min, max, exp …) at
/// every cell. Each layer is a variable with the layer's name. NaN inputs give NaN.
/// @throws InputError "got 'sal * ', expected an expression: …"
Layer Evaluate(const std::string& expression, const std::vector<NamedLayer>& layers);

}  // namespace aquafarm
