// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/base/hash.h"

#include <gtest/gtest.h>

#include <string>

namespace aquafarm {
namespace {

TEST(HashBytes, OfPartsEqualsThatOfTheWhole) {
  const std::string text = "twenty-nine bytes of any text";
  const std::string_view view = text;
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    for (std::size_t end = cut; end <= text.size(); ++end) {
      EXPECT_EQ(HashBytes({view.substr(0, cut), view.substr(cut, end - cut), view.substr(end)}),
                HashBytes(view))
          << cut << " " << end;
    }
  }
}

// Checkpoints of version 0.1.0 contain such checksums.
TEST(HashBytes, StaysAsItWas) {
  Hasher expected;
  expected.Add(std::uint64_t{9});
  expected.Add(std::uint64_t{0x3837363534333231});  // "12345678" as a little-endian word
  expected.Add(std::uint64_t{0x39});                // "9"
  EXPECT_EQ(HashBytes("123456789"), expected.value());
}

}  // namespace
}  // namespace aquafarm
