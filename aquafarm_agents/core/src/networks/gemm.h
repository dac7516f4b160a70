// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Products of row-major float matrices. If GCC 12 or later compiled this code for x86-64, the
/// program selects code for AVX-512 or AVX2 when it runs; both give the same bits. With other
/// compilers and on other processors, BLAS computes the products. The environment variable
/// AQUAFARM_PRODUCTS (avx512, avx2 or blas) overrides this choice. All functions of this file
/// except Transpose throw InputError if the variable has another value, or one that the processor
/// does not support. An empty variable is ignored. Code that another compiler made, or that is not
/// for x86-64, ignores the variable. docs/decisions/fused_updates.md has measurements. If
/// AQUAFARM_GEMM_BY_EIGEN is defined, Eigen replaces BLAS, and the variable accepts eigen instead
/// of blas. A Python package that must not depend on BLAS is built this way.
///
/// In each product, c = product + beta · c. If beta is 0, the old values of c are not read.

#include <cstddef>

namespace aquafarm::agents {

/// Computes c [m, n] = a [m, k] · b [k, n] + beta · c.
void Multiply(std::size_t m, std::size_t n, std::size_t k, const float* a, const float* b,
              float beta, float* c);

/// Computes c [m, n] = a [m, k] · bᵀ + beta · c with b [n, k]. If several matrices with few rows
/// are multiplied by the same bᵀ, it is faster to call Transpose once and Multiply for each matrix.
void MultiplyByTransposed(std::size_t m, std::size_t n, std::size_t k, const float* a,
                          const float* b, float beta, float* c);

/// Computes c [m, n] = aᵀ · b + beta · c with a [k, m], b [k, n].
void MultiplyTransposed(std::size_t m, std::size_t n, std::size_t k, const float* a, const float* b,
                        float beta, float* c);

/// Computes out [columns, rows] = inᵀ with in [rows, columns].
void Transpose(std::size_t rows, std::size_t columns, const float* in, float* out);

/// Returns the name of the code that computes the products: "avx512", "avx2", "blas" or "eigen".
const char* ProductsBy();

}  // namespace aquafarm::agents
