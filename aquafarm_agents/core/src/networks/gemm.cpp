// SPDX-License-Identifier: BSD-3-Clause
#include "networks/gemm.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#ifdef AQUAFARM_GEMM_BY_EIGEN
#include <Eigen/Core>
#else
#include <cblas.h>
#endif

#include "aquafarm/base/check.h"

// The products for AVX need target attributes and builtin functions of GCC 12.
#if defined(__x86_64__) && defined(__GNUC__) && __GNUC__ >= 12 && !defined(__clang__)
#define AQUAFARM_OWN_PRODUCTS
#define AQUAFARM_INLINE inline __attribute__((always_inline))
#endif

namespace aquafarm::agents {
namespace {

#ifdef AQUAFARM_GEMM_BY_EIGEN
constexpr const char* kLibrary = "eigen";
#else
constexpr const char* kLibrary = "blas";
#endif

#ifdef AQUAFARM_OWN_PRODUCTS

template <std::size_t kLanes>
struct VectorOf {
  using Type __attribute__((vector_size(kLanes * sizeof(float)), aligned(4), may_alias)) = float;
};

template <std::size_t kLanes>
AQUAFARM_INLINE const typename VectorOf<kLanes>::Type& Load(const float* values) {
  return *reinterpret_cast<const typename VectorOf<kLanes>::Type*>(values);
}

// Transposes 4 × 4 numbers.
void TransposeSquare(const float* in, std::size_t in_step, float* out, std::size_t out_step) {
  using Vector = VectorOf<4>::Type;
  const Vector a = Load<4>(in);
  const Vector b = Load<4>(in + in_step);
  const Vector c = Load<4>(in + 2 * in_step);
  const Vector d = Load<4>(in + 3 * in_step);
  const Vector low_ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Vector low_cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Vector high_ab = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Vector high_cd = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  const Vector rows[4] = {__builtin_shufflevector(low_ab, low_cd, 0, 1, 4, 5),
                          __builtin_shufflevector(low_ab, low_cd, 2, 3, 6, 7),
                          __builtin_shufflevector(high_ab, high_cd, 0, 1, 4, 5),
                          __builtin_shufflevector(high_ab, high_cd, 2, 3, 6, 7)};
  for (std::size_t row = 0; row < 4; ++row) std::memcpy(out + row * out_step, &rows[row], 16);
}

#endif

// Computes out [columns, rows] = inᵀ. Rows of `in` are in_step apart, rows of `out` out_step.
void TransposeBlock(std::size_t rows, std::size_t columns, const float* in, std::size_t in_step,
                    float* out, std::size_t out_step) {
  constexpr std::size_t kLine = 16;  // floats of a cache line
  for (std::size_t first = 0; first < columns; first += kLine) {
    const std::size_t end = std::min(first + kLine, columns);
    std::size_t row = 0;
#ifdef AQUAFARM_OWN_PRODUCTS
    for (; end == first + kLine && row + 4 <= rows; row += 4) {
      for (std::size_t column = first; column < end; column += 4) {
        TransposeSquare(in + row * in_step + column, in_step, out + column * out_step + row,
                        out_step);
      }
    }
#endif
    for (; row < rows; ++row) {
      for (std::size_t column = first; column < end; ++column) {
        out[column * out_step + row] = in[row * in_step + column];
      }
    }
  }
}

#ifdef AQUAFARM_OWN_PRODUCTS

/// The left factor, possibly stored transposed: element (i, p) is values[i · row_step + p · step].
struct Left {
  const float* values;
  std::size_t row_step;
  std::size_t step;
};

/// Some adjacent columns of the right factor, and the same columns of the result.
struct Panel {
  const float* values;   // the first row of the right factor
  std::size_t step;      // distance to the next row of the right factor
  float* result;         // the first row of the result
  std::size_t row_step;  // distance to the next row of the result
  std::size_t columns;   // number of columns; `values` has zeros up to the full width
};

// Computes kRows rows of a panel's result, which stay in registers: kRows × (kVectors · kLanes)
// floats.
template <std::size_t kLanes, std::size_t kVectors, std::size_t kRows>
AQUAFARM_INLINE void AddTile(std::size_t k, const Left& left, std::size_t row, const Panel& panel,
                             float beta) {
  using Vector = typename VectorOf<kLanes>::Type;
  constexpr std::size_t kWidth = kVectors * kLanes;
  const bool is_full = panel.columns == kWidth;
  Vector sums[kRows][kVectors] = {};
  float* const result = panel.result + row * panel.row_step;
  if (beta != 0.0F) {
    for (std::size_t r = 0; r < kRows; ++r) {
      std::array<float, kWidth> old{};
      std::copy_n(result + r * panel.row_step, panel.columns, old.data());
      for (std::size_t v = 0; v < kVectors; ++v) {
        sums[r][v] = beta * Load<kLanes>(old.data() + v * kLanes);
      }
    }
  }
  const float* a = left.values + row * left.row_step;
  const float* b = panel.values;
  for (std::size_t p = 0; p < k; ++p, a += left.step, b += panel.step) {
    Vector of_panel[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) {
      of_panel[v] = Load<kLanes>(b + v * kLanes);
    }
    for (std::size_t r = 0; r < kRows; ++r) {
      const float factor = a[r * left.row_step];
      for (std::size_t v = 0; v < kVectors; ++v) sums[r][v] += factor * of_panel[v];
    }
  }
  for (std::size_t r = 0; r < kRows; ++r) {
    float* const out = result + r * panel.row_step;
    if (is_full) {
      for (std::size_t v = 0; v < kVectors; ++v) {
        *reinterpret_cast<Vector*>(out + v * kLanes) = sums[r][v];
      }
    } else {
      std::memcpy(out, sums[r], panel.columns * sizeof(float));
    }
  }
}

template <std::size_t kLanes, std::size_t kRows>
AQUAFARM_INLINE void MultiplyPanel(std::size_t m, std::size_t k, const Left& left,
                                   const Panel& panel, float beta) {
  constexpr std::size_t kVectors = 2;
  std::size_t row = 0;
  for (; row + kRows <= m; row += kRows) {
    AddTile<kLanes, kVectors, kRows>(k, left, row, panel, beta);
  }
  for (; row + 4 <= m; row += 4) AddTile<kLanes, kVectors, 4>(k, left, row, panel, beta);
  for (; row + 2 <= m; row += 2) AddTile<kLanes, kVectors, 2>(k, left, row, panel, beta);
  for (; row < m; ++row) AddTile<kLanes, kVectors, 1>(k, left, row, panel, beta);
}

// Computes one row of MultiplyByTransposed, whose elements are scalar products. The 64 partial sums
// and their order do not depend on the number of lanes, so the results are equal in all bits.
template <std::size_t kLanes>
AQUAFARM_INLINE void MultiplyRow(std::size_t n, std::size_t k, const float* a, const float* b,
                                 float beta, float* c) {
  using Vector = typename VectorOf<kLanes>::Type;
  constexpr std::size_t kGroup = 16;
  constexpr std::size_t kGroups = 4;
  constexpr std::size_t kVectors = kGroup / kLanes;  // vectors per group
  for (std::size_t j = 0; j < n; ++j, b += k) {
    Vector sums[kGroups * kVectors] = {};
    std::size_t p = 0;
    for (; p + kGroups * kGroup <= k; p += kGroups * kGroup) {
      for (std::size_t v = 0; v < kGroups * kVectors; ++v) {
        sums[v] += Load<kLanes>(a + p + v * kLanes) * Load<kLanes>(b + p + v * kLanes);
      }
    }
    for (; p + kGroup <= k; p += kGroup) {
      for (std::size_t v = 0; v < kVectors; ++v) {
        sums[v] += Load<kLanes>(a + p + v * kLanes) * Load<kLanes>(b + p + v * kLanes);
      }
    }
    float sum = beta == 0.0F ? 0.0F : beta * c[j];
    for (; p < k; ++p) sum = __builtin_fmaf(a[p], b[p], sum);
    for (std::size_t v = 0; v < kVectors; ++v) {
      const Vector all =
          (sums[v] + sums[v + kVectors]) + (sums[v + 2 * kVectors] + sums[v + 3 * kVectors]);
      for (std::size_t lane = 0; lane < kLanes; ++lane) sum += all[lane];
    }
    c[j] = sum;
  }
}

#define AQUAFARM_AVX512 __attribute__((target("arch=x86-64-v4,prefer-vector-width=512")))
#define AQUAFARM_AVX2 __attribute__((target("arch=x86-64-v3")))

// AVX-512 has 32 registers of 16 floats.
AQUAFARM_AVX512 void MultiplyPanel512(std::size_t m, std::size_t k, const Left& left,
                                      const Panel& panel, float beta) {
  MultiplyPanel<16, 8>(m, k, left, panel, beta);
}
AQUAFARM_AVX512 void MultiplyRow512(std::size_t n, std::size_t k, const float* a, const float* b,
                                    float beta, float* c) {
  MultiplyRow<16>(n, k, a, b, beta, c);
}

// AVX2 has 16 registers of 8 floats.
AQUAFARM_AVX2 void MultiplyPanel256(std::size_t m, std::size_t k, const Left& left,
                                    const Panel& panel, float beta) {
  MultiplyPanel<8, 6>(m, k, left, panel, beta);
}
AQUAFARM_AVX2 void MultiplyRow256(std::size_t n, std::size_t k, const float* a, const float* b,
                                  float beta, float* c) {
  MultiplyRow<8>(n, k, a, b, beta, c);
}

struct Code {
  void (*multiply)(std::size_t m, std::size_t k, const Left&, const Panel&, float beta);
  void (*multiply_row)(std::size_t n, std::size_t k, const float* a, const float* b, float beta,
                       float* c);
  std::size_t width;  // columns of a panel
  const char* name;
};

// Returns the code that the environment variable AQUAFARM_PRODUCTS names, else the fastest that the
// processor supports. For BLAS or Eigen, the functions are null.
const Code& Selected() {
  static const Code code = [] {
    __builtin_cpu_init();
    const char* const wanted = std::getenv("AQUAFARM_PRODUCTS");
    const std::string name = wanted == nullptr ? "" : wanted;
    const auto takes = [&](const char* one) { return name.empty() || name == one; };
    if (takes("avx512") && __builtin_cpu_supports("x86-64-v4") != 0) {
      return Code{MultiplyPanel512, MultiplyRow512, 32, "avx512"};
    }
    if (takes("avx2") && __builtin_cpu_supports("x86-64-v3") != 0) {
      return Code{MultiplyPanel256, MultiplyRow256, 16, "avx2"};
    }
    if (takes(kLibrary)) return Code{nullptr, nullptr, 0, kLibrary};
    throw InputError("AQUAFARM_PRODUCTS: got '" + name + "', expected avx512 or avx2, if this " +
                     "processor has it, or " + kLibrary + "; or unset the variable");
  }();
  return code;
}

/// The right factor, possibly stored transposed: element (p, j) is
/// values[p · step + j · column_step].
struct Right {
  const float* values;
  std::size_t step;
  std::size_t column_step;
};

// Copies `columns` columns to `out` [k, width] and appends zeros up to `width`. The copy is
// contiguous, which suits the first-level cache.
void Pack(const Right& right, std::size_t k, std::size_t columns, std::size_t width, float* out) {
  if (right.column_step == 1) {
    for (std::size_t p = 0; p < k; ++p, out += width) {
      std::copy_n(right.values + p * right.step, columns, out);
      std::fill(out + columns, out + width, 0.0F);
    }
    return;
  }
  TransposeBlock(columns, k, right.values, right.column_step, out, width);
  for (std::size_t p = 0; p < k; ++p) {
    std::fill(out + p * width + columns, out + (p + 1) * width, 0.0F);
  }
}

// Computes c = left · right + beta · c. Returns false, without a result, if BLAS or Eigen is
// selected.
bool MultiplyOwn(std::size_t m, std::size_t n, std::size_t k, const Left& left, Right right,
                 float beta, float* c) {
  const Code& code = Selected();
  if (code.multiply == nullptr) return false;
  // With at most kFewRows rows, copying a panel costs more time than it saves.
  constexpr std::size_t kFewRows = 16;
  constexpr std::size_t kFewTransposedRows = 4;
  if (right.column_step != 1 && m <= kFewTransposedRows) {
    for (std::size_t i = 0; i < m; ++i) {
      code.multiply_row(n, k, left.values + i * left.row_step, right.values, beta, c + i * n);
    }
    return true;
  }
  thread_local std::vector<float> packed;
  for (std::size_t j = 0; j < n; j += code.width, right.values += code.width * right.column_step) {
    const std::size_t columns = std::min(code.width, n - j);
    Panel panel{right.values, right.step, c + j, n, columns};
    if (columns < code.width || right.column_step != 1 || m > kFewRows) {
      packed.resize(std::max(packed.size(), k * code.width));
      Pack(right, k, columns, code.width, packed.data());
      panel.values = packed.data();
      panel.step = code.width;
    }
    code.multiply(m, k, left, panel, beta);
  }
  return true;
}

#endif  // AQUAFARM_OWN_PRODUCTS

#ifdef AQUAFARM_GEMM_BY_EIGEN

using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Returns a view of a row-major matrix [rows, columns].
auto AsMatrix(const float* values, std::size_t rows, std::size_t columns) {
  return Eigen::Map<const RowMajor>(values, static_cast<Eigen::Index>(rows),
                                    static_cast<Eigen::Index>(columns));
}

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

#endif

}  // namespace

void Multiply(std::size_t m, std::size_t n, std::size_t k, const float* a, const float* b,
              float beta, float* c) {
#ifdef AQUAFARM_OWN_PRODUCTS
  if (MultiplyOwn(m, n, k, {a, k, 1}, {b, n, 1}, beta, c)) return;
#endif
#ifdef AQUAFARM_GEMM_BY_EIGEN
  AddProduct(AsMatrix(a, m, k) * AsMatrix(b, k, n), beta, c);
#else
  cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, static_cast<int>(m), static_cast<int>(n),
              static_cast<int>(k), 1.0F, a, static_cast<int>(k), b, static_cast<int>(n), beta, c,
              static_cast<int>(n));
#endif
}

void MultiplyByTransposed(std::size_t m, std::size_t n, std::size_t k, const float* a,
                          const float* b, float beta, float* c) {
#ifdef AQUAFARM_OWN_PRODUCTS
  if (MultiplyOwn(m, n, k, {a, k, 1}, {b, 1, k}, beta, c)) return;
#endif
#ifdef AQUAFARM_GEMM_BY_EIGEN
  AddProduct(AsMatrix(a, m, k) * AsMatrix(b, n, k).transpose(), beta, c);
#else
  cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasTrans, static_cast<int>(m), static_cast<int>(n),
              static_cast<int>(k), 1.0F, a, static_cast<int>(k), b, static_cast<int>(k), beta, c,
              static_cast<int>(n));
#endif
}

void MultiplyTransposed(std::size_t m, std::size_t n, std::size_t k, const float* a, const float* b,
                        float beta, float* c) {
#ifdef AQUAFARM_OWN_PRODUCTS
  if (MultiplyOwn(m, n, k, {a, 1, m}, {b, n, 1}, beta, c)) return;
#endif
#ifdef AQUAFARM_GEMM_BY_EIGEN
  AddProduct(AsMatrix(a, k, m).transpose() * AsMatrix(b, k, n), beta, c);
#else
  cblas_sgemm(CblasRowMajor, CblasTrans, CblasNoTrans, static_cast<int>(m), static_cast<int>(n),
              static_cast<int>(k), 1.0F, a, static_cast<int>(m), b, static_cast<int>(n), beta, c,
              static_cast<int>(n));
#endif
}

void Transpose(std::size_t rows, std::size_t columns, const float* in, float* out) {
  TransposeBlock(rows, columns, in, columns, out, rows);
}

const char* ProductsBy() {
#ifdef AQUAFARM_OWN_PRODUCTS
  return Selected().name;
#else
  return kLibrary;
#endif
}

}  // namespace aquafarm::agents
