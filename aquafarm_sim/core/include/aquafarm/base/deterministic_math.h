// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm {

/// Returns e^x with a relative error below 1e-12 for |x| <= 8. It uses only +, * and /, so the
/// result is bit-identical on every machine; libm does not guarantee this.
constexpr double Exp(double x) {
  constexpr int kHalvings = 8;
  constexpr int kTerms = 9;  // degree of the Taylor polynomial of e^(x/256)
  const double small = x / (1 << kHalvings);
  double sum = 1.0;
  for (int n = kTerms; n > 0; --n) sum = 1.0 + small / n * sum;
  for (int i = 0; i < kHalvings; ++i) sum *= sum;
  return sum;
}

}  // namespace aquafarm
