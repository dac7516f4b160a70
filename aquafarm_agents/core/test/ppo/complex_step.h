// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Complex numbers for the complex-step derivative: f'(x) ≈ Im f(x + ih) / h for a small h. Its
// error is of the order of h² and contains no rounding error of a difference (Squire and Trapp
// 1998).

#include <complex>
#include <vector>

namespace aquafarm::agents::test {

using Complex = std::complex<double>;
using Vector = std::vector<Complex>;

inline Complex Relu(Complex x) { return x.real() > 0.0 ? x : Complex(0.0); }

}  // namespace aquafarm::agents::test
