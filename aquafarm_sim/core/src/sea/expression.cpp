// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/sea/expression.h"

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "aquafarm/base/check.h"

namespace aquafarm {

Layer Evaluate(const std::string& expression, const std::vector<NamedLayer>& layers) {
  if (layers.empty())
    throw InputError("got no sea layer, expected at least one for expression '" + expression + "'");
  Layer result(layers[0].layer.rows(), layers[0].layer.cols());
  std::vector<double> values(layers.size());
  try {
    mu::Parser parser;
    for (std::size_t i = 0; i < layers.size(); ++i) {
      AQUAFARM_CHECK_EQ(layers[i].layer.size(), result.size());
      parser.DefineVar(layers[i].name, &values[i]);
    }
    parser.SetExpr(expression);
    std::vector<const double*> used;  // layers in the expression; NaN in others has no effect
    for (const auto& [name, value] : parser.GetUsedVar()) {
      if (value != nullptr) used.push_back(value);  // null for an unknown name, which Eval rejects
    }
    for (Eigen::Index cell = 0; cell < result.size(); ++cell) {
      for (std::size_t i = 0; i < layers.size(); ++i) {
        values[i] = static_cast<double>(layers[i].layer.data()[cell]);
      }
      const bool known = std::none_of(used.begin(), used.end(),
                                      [](const double* value) { return std::isnan(*value); });
      // Eval is also called for NaN inputs, so that it always rejects an invalid expression.
      const double value = parser.Eval();
      result.data()[cell] =
          known ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN();
    }
  } catch (const mu::Parser::exception_type& error) {
    throw InputError("got '" + expression + "', expected an expression: " + error.GetMsg());
  }
  return result;
}

}  // namespace aquafarm
