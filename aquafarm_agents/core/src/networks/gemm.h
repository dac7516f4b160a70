// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Products of row-major float matrices. Code for AVX-512 or AVX2, which give the same bits, is
/// selected at run time; a processor without them uses BLAS. The environment variable
/// AQUAFARM_PRODUCTS (avx512, avx2 or blas) selects another one. docs/decisions/fused_updates.md
/// has the measurements. With AQUAFARM_GEMM_BY_EIGEN, for a Python package that must not depend on
/// BLAS, Eigen replaces BLAS.
///
/// In each product, c = product + beta · c; with beta = 0 the old values of c are not read.

#include <cstddef>

namespace aquafarm::agents {

/// c [m, n] = a [m, k] · b [k, n]
void Multiply(std::size_t m, std::size_t n, std::size_t k, const float* a, const float* b,
              float beta, float* c);

/// c [m, n] = a [m, k] · bᵀ with b [n, k]. Where few rows are multiplied by the same b several
/// times, Transpose and Multiply are faster.
void MultiplyByTransposed(std::size_t m, std::size_t n, std::size_t k, const float* a,
                          const float* b, float beta, float* c);

/// c [m, n] = aᵀ · b with a [k, m], b [k, n]
void MultiplyTransposed(std::size_t m, std::size_t n, std::size_t k, const float* a, const float* b,
                        float beta, float* c);

/// out [columns, rows] = inᵀ with in [rows, columns]
void Transpose(std::size_t rows, std::size_t columns, const float* in, float* out);

/// Name of the code that computes the products: "avx512", "avx2", "blas" or "eigen".
const char* ProductsBy();

}  // namespace aquafarm::agents
