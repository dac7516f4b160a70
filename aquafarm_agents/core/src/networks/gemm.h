// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Products of row-major float matrices by BLAS (cblas_sgemm), which selects its kernels for the
/// processor at run time. docs/decisions/ppo.md has the measurements. With AQUAFARM_GEMM_BY_EIGEN,
/// for a Python package that must not depend on BLAS, Eigen computes them; the last bits then
/// differ.

#include <cstddef>

#ifdef AQUAFARM_GEMM_BY_EIGEN
#include <Eigen/Core>

namespace aquafarm::agents {

using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Views a row-major matrix [rows, columns].
inline auto AsMatrix(const float* values, std::size_t rows, std::size_t columns) {
  return Eigen::Map<const RowMajor>(values, static_cast<Eigen::Index>(rows),
                                    static_cast<Eigen::Index>(columns));
}

/// c [m, n] = product + beta · c. With beta = 0 the old values of c are not read.
template <typename Product>
void AddProduct(const Product& product, float beta, float* c) {
  Eigen::Map<RowMajor> sum(c, product.rows(), product.cols());
  if (beta == 0.0F) {
    sum.noalias() = product;
    return;
  }
  if (beta != 1.0F) sum *= beta;
  sum.noalias() += product;
}

inline void Multiply(std::size_t m, std::size_t n, std::size_t k, const float* a, const float* b,
                     float beta, float* c) {
  AddProduct(AsMatrix(a, m, k) * AsMatrix(b, k, n), beta, c);
}

inline void MultiplyByTransposed(std::size_t m, std::size_t n, std::size_t k, const float* a,
                                 const float* b, float beta, float* c) {
  AddProduct(AsMatrix(a, m, k) * AsMatrix(b, n, k).transpose(), beta, c);
}

inline void MultiplyTransposed(std::size_t m, std::size_t n, std::size_t k, const float* a,
                               const float* b, float beta, float* c) {
  AddProduct(AsMatrix(a, k, m).transpose() * AsMatrix(b, k, n), beta, c);
}

}  // namespace aquafarm::agents
#else
#include <cblas.h>

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
#endif
