// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/grid/action.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "aquafarm/base/check.h"
#include "aquafarm/grid/grid.h"
#include "aquafarm/scenario/enums.h"

namespace aquafarm {
namespace {

template <typename Enum>
void ExpectDistinctNames(int count) {
  std::set<std::string> names;
  for (int value = 0; value < count; ++value) {
    names.insert(std::string(ToString(static_cast<Enum>(value))));
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(count));
  EXPECT_EQ(names.count(""), 0U);
  EXPECT_THROW(ToString(static_cast<Enum>(count)), LogicError);
}

TEST(Types, EveryValueHasANameOfItsOwn) {
  ExpectDistinctNames<Action>(kActionCount + 1);
  ExpectDistinctNames<Outcome>(kOutcomeCount);
  ExpectDistinctNames<EndReason>(kEndReasonCount);
  ExpectDistinctNames<DeviceKind>(kDeviceKindCount);
  ExpectDistinctNames<DeviceStatus>(kDeviceStatusCount);
  ExpectDistinctNames<DisasterKind>(kDisasterKindCount);
}

TEST(Types, NorthIsUpAndEastIsRightAsInEquationOne) {
  const auto move = [](Action action) { return kMoves[static_cast<std::size_t>(action)]; };
  EXPECT_EQ(move(Action::kNorth), (Cell{0, 1}));
  EXPECT_EQ(move(Action::kSouth), (Cell{0, -1}));
  EXPECT_EQ(move(Action::kWest), (Cell{-1, 0}));
  EXPECT_EQ(move(Action::kEast), (Cell{1, 0}));
  EXPECT_EQ(move(Action::kSouthEast), (Cell{1, -1}));
}

TEST(Types, LinearIndexRunsEastFirst) {
  EXPECT_EQ(LinearIndex({3, 2}, 25), 53);
  Grid<int> grid = Grid<int>::Zero(4, 25);
  grid(2, 3) = 7;
  EXPECT_EQ(grid.data()[LinearIndex({3, 2}, 25)], 7);
}

TEST(Types, OnlyTruncationIsNotATermination) {
  EXPECT_TRUE(IsTerminated(EndReason::kAllRetrieved));
  EXPECT_TRUE(IsTerminated(EndReason::kDisasterEnded));
  EXPECT_FALSE(IsTerminated(EndReason::kStepLimit));
  EXPECT_FALSE(IsTerminated(EndReason::kNone));
  EXPECT_TRUE(IsTruncated(EndReason::kStepLimit));
}

TEST(Types, AChecksFailureNamesBothValues) {
  try {
    const int seven = 7;
    AQUAFARM_CHECK_LT(seven, 4);
    FAIL() << "7 < 4 was let through";
  } catch (const LogicError& error) {
    EXPECT_NE(std::string(error.what()).find("seven < 4 (7 vs. 4)"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace aquafarm
