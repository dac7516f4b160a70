// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/base/suggest.h"

#include <gtest/gtest.h>

namespace aquafarm {
namespace {

TEST(DidYouMean, NamesTheNearest) {
  const std::vector<std::string> names{"algorithm", "farms", "seed"};
  EXPECT_EQ(DidYouMean("algorthm", names), " (did you mean 'algorithm'?)");
  EXPECT_EQ(DidYouMean("farm", names), " (did you mean 'farms'?)");
  EXPECT_EQ(DidYouMean("storms", names), "");
  EXPECT_EQ(DidYouMean("", names), "");
  EXPECT_EQ(DidYouMean("", {""}), "");
  EXPECT_EQ(DidYouMean("x", {""}), "");
  EXPECT_EQ(DidYouMean(std::string(200, 'x'), {std::string(200, 'x')}), "");
}

TEST(DidYouMean, PrefersANameThatDiffersOnlyInSeparators) {
  EXPECT_EQ(DidYouMean("INFA", {"LINFA", "IN-FA", "INFRA"}), " (did you mean 'IN-FA'?)");
  EXPECT_EQ(DidYouMean("learningrate", {"learning_rates", "learning_rate"}),
            " (did you mean 'learning_rate'?)");
}

// Kitten to sitting: two letters replaced and one inserted.
TEST(EditDistance, CountsInsertedRemovedAndReplacedLetters) {
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3U);
  EXPECT_EQ(EditDistance("", "abc"), 3U);
  EXPECT_EQ(EditDistance("abc", ""), 3U);
  EXPECT_EQ(EditDistance("abc", "abc"), 0U);
}

}  // namespace
}  // namespace aquafarm
