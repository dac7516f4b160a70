// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/base/rng.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace aquafarm {
namespace {

// Known answer of Philox4x32-10 for counter and key 0, from kat_vectors of Random123.
TEST(Rng, IsPhilox) {
  const auto draws = Draw({0, 0, RngStream::kLayout, 0}, 0);
  EXPECT_EQ(draws[0], 0x6627e8d5U);
  EXPECT_EQ(draws[1], 0xe169c58dU);
  EXPECT_EQ(draws[2], 0xbc57ac4cU);
  EXPECT_EQ(draws[3], 0x9b00dbd8U);
}

TEST(Rng, EveryPartOfTheKeyMatters) {
  std::set<std::uint32_t> firsts;
  firsts.insert(Draw({1, 2, RngStream::kStart, 3}, 4)[0]);
  firsts.insert(Draw({9, 2, RngStream::kStart, 3}, 4)[0]);
  firsts.insert(Draw({1ULL << 32U, 2, RngStream::kStart, 3}, 4)[0]);
  firsts.insert(Draw({1, 9, RngStream::kStart, 3}, 4)[0]);
  firsts.insert(Draw({1, 2ULL << 32U, RngStream::kStart, 3}, 4)[0]);
  firsts.insert(Draw({1, 2, RngStream::kDamage, 3}, 4)[0]);
  firsts.insert(Draw({1, 2, RngStream::kStart, 9}, 4)[0]);
  firsts.insert(Draw({1, 2, RngStream::kStart, 3}, 9)[0]);
  EXPECT_EQ(firsts.size(), 8U);
}

TEST(Rng, AStreamContinuesFromAnyPosition) {
  RandomStream stream({5, 6, RngStream::kExploration, 7});
  std::vector<std::uint32_t> all(23);
  std::generate(all.begin(), all.end(), [&] { return stream.Next(); });
  EXPECT_EQ(stream.position(), 23U);
  for (std::uint64_t from = 0; from < all.size(); ++from) {
    RandomStream again({5, 6, RngStream::kExploration, 7});
    again.Seek(from);
    EXPECT_EQ(again.position(), from);
    EXPECT_EQ(again.Next(), all[from]) << "from " << from;
  }
}

TEST(Rng, UnitStaysBelowOneAndBelowStaysBelow) {
  EXPECT_EQ(ToUnit(0), 0.0F);
  EXPECT_LT(ToUnit(0xffffffffU), 1.0F);
  EXPECT_EQ(ToBelow(0xffffffffU, 7), 6U);
  EXPECT_EQ(ToBelow(0, 7), 0U);
}

TEST(Rng, DrawsBelowTenAreEven) {
  RandomStream stream({1, 0, RngStream::kExploration, 0});
  std::vector<int> counts(10);
  constexpr int kDraws = 100000;
  for (int i = 0; i < kDraws; ++i) ++counts[stream.Below(10)];
  for (int count : counts) EXPECT_NEAR(count, kDraws / 10, 500);  // 5 standard deviations
}

}  // namespace
}  // namespace aquafarm
