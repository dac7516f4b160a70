// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Derivatives by complex steps: f'(x) is the imaginary part of f(x + ih) / h.

#include <complex>
#include <vector>

namespace aquafarm::agents::test {

using Complex = std::complex<double>;
using Vector = std::vector<Complex>;

inline Complex Relu(Complex x) { return x.real() > 0.0 ? x : Complex(0.0); }

}  // namespace aquafarm::agents::test
