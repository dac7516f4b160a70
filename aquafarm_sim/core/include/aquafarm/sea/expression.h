// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "aquafarm/sea/sea_field.h"

namespace aquafarm {

/// A named layer for an expression.
struct NamedLayer {
  std::string name;  ///< letters, digits and _, not first a digit
  Layer layer;
};

/// Evaluates an expression (muParser's: + - * / ^, comparisons, ?:, min, max, exp …) at every
/// cell, with each layer's value under its name. NaN in gives NaN out.
/// @throws InputError "got 'sal * ', expected an expression: …"
Layer Evaluate(const std::string& expression, const std::vector<NamedLayer>& layers);

}  // namespace aquafarm
