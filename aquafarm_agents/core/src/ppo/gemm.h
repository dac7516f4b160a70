// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Products of row-major float matrices by BLAS (cblas_sgemm), which selects its kernels for the
/// processor at run time. docs/decisions/ppo.md has the measurements.

#include <cblas.h>

#include <cstddef>

namespace aquafarm::agents {

/// c [m, n] = a [m, k] · b [k, n] + beta · c
inline void Multiply(std::size_t m, std::size_t n, std::size_t k, const float* a, const float* b,
                     float beta, float* c) {
  cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, static_cast<int>(m), static_cast<int>(n),
              static_cast<int>(k), 1.0F, a, static_cast<int>(k), b, static_cast<int>(n), beta, c,
              static_cast<int>(n));
}

/// c [m, n] = a [m, k] · bᵀ + beta · c with b [n, k]
inline void MultiplyByTransposed(std::size_t m, std::size_t n, std::size_t k, const float* a,
                                 const float* b, float beta, float* c) {
  cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasTrans, static_cast<int>(m), static_cast<int>(n),
              static_cast<int>(k), 1.0F, a, static_cast<int>(k), b, static_cast<int>(k), beta, c,
              static_cast<int>(n));
}

/// c [m, n] = aᵀ · b + beta · c with a [k, m], b [k, n]
inline void MultiplyTransposed(std::size_t m, std::size_t n, std::size_t k, const float* a,
                               const float* b, float beta, float* c) {
  cblas_sgemm(CblasRowMajor, CblasTrans, CblasNoTrans, static_cast<int>(m), static_cast<int>(n),
              static_cast<int>(k), 1.0F, a, static_cast<int>(m), b, static_cast<int>(n), beta, c,
              static_cast<int>(n));
}

}  // namespace aquafarm::agents
