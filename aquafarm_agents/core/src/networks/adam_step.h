// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace aquafarm::agents {

/// Returns the Euclidean norm of a gradient [size]. It is infinite or NaN if an element is, or if
/// the sum of squares overflows a float.
double GradientNorm(const float* gradient, std::size_t size);

/// Takes one step of Adam (Kingma and Ba 2015) against scale · gradient.
/// @param gradient [size]
/// @param step number of this step, from 1
/// @param epsilon added to the root of the mean square
/// @param mean, square [size] moving averages of the gradient and of its square, updated
/// @param weights [size] updated
void AdamStep(std::size_t size, const float* gradient, double scale, double learning_rate,
              std::uint64_t step, float epsilon, float* mean, float* square, float* weights);

/// Adds rate · (towards − values) to `values` [size]. With rate 1, copies `towards`.
void AdvanceTowards(std::size_t size, const float* towards, float rate, float* values);

}  // namespace aquafarm::agents
