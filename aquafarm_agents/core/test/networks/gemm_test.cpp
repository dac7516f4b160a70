// SPDX-License-Identifier: BSD-3-Clause
// Products, the LSTM cell and Adam against plain loops in double precision.
#include "networks/gemm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "networks/adam_step.h"
#include "networks/lstm_cell.h"
#include "networks/noise.h"

namespace aquafarm::agents {
namespace {

enum class Kind { kPlain, kByTransposed, kTransposed };

void ExpectProduct(Kind kind, std::size_t m, std::size_t n, std::size_t k, float beta) {
  const std::vector<float> a = Noise(m * k, 1);
  const std::vector<float> b = Noise(k * n, 2);
  const std::vector<float> old = Noise(m * n, 3);
  // Values that a beta of 0 must not read.
  std::vector<float> c =
      beta == 0.0F ? std::vector<float>(m * n, std::numeric_limits<float>::quiet_NaN()) : old;
  switch (kind) {
    case Kind::kPlain:
      Multiply(m, n, k, a.data(), b.data(), beta, c.data());
      break;
    case Kind::kByTransposed:
      MultiplyByTransposed(m, n, k, a.data(), b.data(), beta, c.data());
      break;
    case Kind::kTransposed:
      MultiplyTransposed(m, n, k, a.data(), b.data(), beta, c.data());
      break;
  }
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      double sum = static_cast<double>(beta) * static_cast<double>(old[i * n + j]);
      for (std::size_t p = 0; p < k; ++p) {
        const float left = kind == Kind::kTransposed ? a[p * m + i] : a[i * k + p];
        const float right = kind == Kind::kByTransposed ? b[j * k + p] : b[p * n + j];
        sum += static_cast<double>(left) * static_cast<double>(right);
      }
      ASSERT_NEAR(c[i * n + j], sum, 3e-6 * std::sqrt(static_cast<double>(k)))
          << "kind " << static_cast<int>(kind) << ", m " << m << ", n " << n << ", k " << k
          << ", beta " << beta << ", at " << i << ' ' << j;
    }
  }
}

// Sizes below, at and above those of the tiles (8 and 6 rows; 32 and 16 columns) and of the cases
// for few rows.
TEST(Products, AreThoseOfPlainLoops) {
  SCOPED_TRACE(ProductsBy());
  for (const std::size_t m : {1, 2, 3, 4, 5, 7, 8, 13, 16, 17, 43}) {
    for (const std::size_t n : {1, 10, 16, 31, 32, 43, 64}) {
      for (const std::size_t k : {1, 7, 16, 43, 64, 65, 130}) {
        for (const float beta : {0.0F, 1.0F, 0.5F}) {
          for (const Kind kind : {Kind::kPlain, Kind::kByTransposed, Kind::kTransposed}) {
            ExpectProduct(kind, m, n, k, beta);
            if (HasFatalFailure()) return;
          }
        }
      }
    }
  }
}

TEST(Products, ANumberThatIsNoneStaysSo) {
  std::vector<float> a = Noise(8 * 4, 1);
  a[5] = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> b = Noise(4 * 32, 2);
  std::vector<float> c(8 * 32);
  Multiply(8, 32, 4, a.data(), b.data(), 0.0F, c.data());
  for (std::size_t i = 0; i < c.size(); ++i) EXPECT_EQ(std::isnan(c[i]), i / 32 == 1) << i;
}

TEST(Transpose, ExchangesRowsAndColumns) {
  for (const std::size_t rows : {1, 16, 37}) {
    const std::vector<float> in = Noise(rows * 21, 1);
    std::vector<float> out(in.size());
    Transpose(rows, 21, in.data(), out.data());
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t column = 0; column < 21; ++column) {
        ASSERT_EQ(out[column * rows + row], in[row * 21 + column]);
      }
    }
  }
}

TEST(LstmCell, HasTheFunctionsOfItsEquations) {
  constexpr std::size_t kCells = 19;  // not a multiple of the vector width
  for (double x = -100.0; x < 100.0; x += 0.173) {
    std::vector<float> gates(4 * kCells, static_cast<float>(x));
    const std::vector<float> before(kCells, 0.7F);
    std::vector<float> cell(kCells);
    std::vector<float> cell_tanh(kCells);
    std::vector<float> output(kCells);
    LstmCellForward(kCells, gates.data(), before.data(), cell.data(), cell_tanh.data(),
                    output.data());
    const double input = static_cast<double>(static_cast<float>(x));
    const double sigmoid = 1.0 / (1.0 + std::exp(-input));
    const double c = sigmoid * 0.7 + sigmoid * std::tanh(input);
    for (std::size_t i = 0; i < kCells; ++i) {
      ASSERT_NEAR(gates[i], sigmoid, 2e-7) << x;
      ASSERT_NEAR(gates[2 * kCells + i], std::tanh(input), 2e-7) << x;
      ASSERT_NEAR(cell[i], c, 4e-7) << x;
      ASSERT_NEAR(output[i], sigmoid * std::tanh(c), 6e-7) << x;
    }
  }
}

TEST(LstmCell, ANumberThatIsNoneStaysSo) {
  constexpr std::size_t kCells = 19;
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::quiet_NaN()}) {
    std::vector<float> gates(4 * kCells, bad);
    std::vector<float> cell(kCells);
    std::vector<float> cell_tanh(kCells);
    std::vector<float> output(kCells);
    LstmCellForward(kCells, gates.data(), cell.data(), cell.data(), cell_tanh.data(),
                    output.data());
    for (const float one : output) EXPECT_TRUE(std::isnan(one));
  }
}

TEST(GradientNorm, IsTheRootOfTheSumOfSquares) {
  for (const std::size_t size : {1, 63, 64, 200}) {
    std::vector<float> gradient = Noise(size, 1);
    double sum = 0.0;
    for (const float one : gradient) sum += static_cast<double>(one) * static_cast<double>(one);
    EXPECT_NEAR(GradientNorm(gradient.data(), size), std::sqrt(sum), 1e-5 * std::sqrt(sum));
    for (const float bad :
         {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
      gradient[size / 2] = bad;
      EXPECT_FALSE(std::isfinite(GradientNorm(gradient.data(), size))) << size << ' ' << bad;
    }
  }
}

TEST(AdvanceTowards, MovesByTheRateAndCopiesWithOne) {
  const std::vector<float> towards = Noise(77, 1);
  const std::vector<float> before = Noise(77, 2);
  std::vector<float> values = before;
  AdvanceTowards(values.size(), towards.data(), 0.25F, values.data());
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(values[i], 0.25F * towards[i] + 0.75F * before[i], 1e-6F);
  }
  AdvanceTowards(values.size(), towards.data(), 1.0F, values.data());
  EXPECT_EQ(values, towards);
}

}  // namespace
}  // namespace aquafarm::agents
