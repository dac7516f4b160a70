// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <limits>

#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/scene/pairing.h"
#include "fixture.h"

namespace aquafarm_viz {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(CheckSpec, AcceptsARanch) { EXPECT_EQ(CheckSpec(test::MakeSpec()), ""); }

TEST(CheckSpec, NamesWhatIsWrong) {
  auto spec = test::MakeSpec();
  spec.width = 0;
  EXPECT_EQ(CheckSpec(spec), "spec.width: got 0, expected [1, 4096]");
  spec = test::MakeSpec();
  spec.height = 2000000000;
  EXPECT_EQ(CheckSpec(spec), "spec.height: got 2000000000, expected [1, 4096]");
  spec = test::MakeSpec();
  spec.cell_size_m = 0.0;
  EXPECT_EQ(CheckSpec(spec), "spec.cell_size_m: got 0, expected [0.001, 1e+06]");
  spec.cell_size_m = static_cast<double>(kNan);
  EXPECT_NE(CheckSpec(spec), "");
  spec = test::MakeSpec();
  spec.ports.resize(626);
  EXPECT_EQ(CheckSpec(spec), "spec.ports.size: got 626, expected [0, 625]");
}

TEST(CheckState, AcceptsAState) { EXPECT_EQ(CheckState(test::MakeState()), ""); }

TEST(CheckState, NamesWhatIsWrong) {
  auto state = test::MakeState();
  state.disasters.front().risks.pop_back();
  EXPECT_EQ(CheckState(state),
            "state.disasters[0].risks.size: got 2, expected as many as radii, 3");
  state = test::MakeState();
  state.disasters.front().radii.assign(1000, 1.0F);
  state.disasters.front().risks.assign(1000, -5.0F);
  EXPECT_EQ(CheckState(state), "state.disasters[0].radii.size: got 1000, expected [0, 4]");
  state = test::MakeState();
  state.disasters.front().x = kNan;
  EXPECT_EQ(CheckState(state), "state.disasters[0].x: got nan, expected [-1e+06, 1e+06]");
  state = test::MakeState();
  state.disasters.front().radii[1] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(CheckState(state), "state.disasters[0].radii: got inf, expected [0, 1e+06]");
  state = test::MakeState();
  state.devices[2].health = kNan;
  EXPECT_EQ(CheckState(state), "state.devices[2].health: got a number that is not finite");
  state = test::MakeState();
  state.ships.resize(5000);
  EXPECT_EQ(CheckState(state), "state.ships.size: got 5000, expected [0, 4096]");
}

TEST(CheckState, LooksPastADisasterThatIsNotKnown) {
  auto state = test::MakeState();
  state.disasters.front().known = false;
  state.disasters.front().x = kNan;
  EXPECT_EQ(CheckState(state), "");
}

TEST(Pairing, ShowsNothingBeforeTheSpec) {
  Pairing pairing;
  const auto state = boost::make_shared<aquafarm_msgs::FarmState>(test::MakeState());
  EXPECT_EQ(pairing.AddState(state), "");
  EXPECT_EQ(pairing.shown().state, nullptr);
  EXPECT_EQ(pairing.Waiting(),
            "got a state of episode 12 with seed 7, but no spec; nothing is drawn until its spec "
            "arrives");
  EXPECT_EQ(pairing.AddSpec(boost::make_shared<aquafarm_msgs::FarmSpec>(test::MakeSpec())), "");
  EXPECT_EQ(pairing.shown().state, state);
  EXPECT_EQ(pairing.Waiting(), "");
}

TEST(Pairing, NeverShowsAStateWithTheSpecOfAnotherEpisode) {
  Pairing pairing;
  pairing.AddSpec(boost::make_shared<aquafarm_msgs::FarmSpec>(test::MakeSpec()));
  const auto first = boost::make_shared<aquafarm_msgs::FarmState>(test::MakeState());
  pairing.AddState(first);
  auto later = boost::make_shared<aquafarm_msgs::FarmState>(test::MakeState());
  later->episode = 13;
  pairing.AddState(later);
  EXPECT_EQ(pairing.shown().state, first);
  EXPECT_EQ(
      pairing.Waiting(),
      "got a state of episode 13 with seed 7, but the last spec is of episode 12 with seed 7; "
      "waiting for the matching spec");
}

TEST(Pairing, FindsTheSpecOfAStateThatCameLate) {
  Pairing pairing;
  for (std::uint64_t episode = 10; episode < 16; ++episode) {
    auto spec = boost::make_shared<aquafarm_msgs::FarmSpec>(test::MakeSpec());
    spec->episode = episode;
    pairing.AddSpec(spec);
  }
  pairing.AddState(boost::make_shared<aquafarm_msgs::FarmState>(test::MakeState()));
  ASSERT_NE(pairing.shown().spec, nullptr);
  EXPECT_EQ(pairing.shown().spec->episode, 12U);
}

TEST(Pairing, RefusesBadMessagesAndKeepsWhatItHas) {
  Pairing pairing;
  pairing.AddSpec(boost::make_shared<aquafarm_msgs::FarmSpec>(test::MakeSpec()));
  const auto good = boost::make_shared<aquafarm_msgs::FarmState>(test::MakeState());
  pairing.AddState(good);
  auto bad = boost::make_shared<aquafarm_msgs::FarmState>(test::MakeState());
  bad->disasters.front().y = kNan;
  EXPECT_NE(pairing.AddState(bad), "");
  EXPECT_EQ(pairing.shown().state, good);
  auto huge = boost::make_shared<aquafarm_msgs::FarmSpec>(test::MakeSpec());
  huge->width = huge->height = 100000;
  EXPECT_NE(pairing.AddSpec(huge), "");
  EXPECT_EQ(pairing.shown().spec->width, 25);
}

}  // namespace
}  // namespace aquafarm_viz
