// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/learning/replay.h"

#include <set>

#include "agents_fixture.h"

namespace aquafarm::agents::test {
namespace {

// Two farms with one agent each. The observation of farm f at time step t is {t, f}.
class TwoFarms {
 public:
  explicit TwoFarms(std::size_t moments, std::size_t recurrent_state = 0)
      : replay_({moments * 2, 2, 1, 2, recurrent_state}) {}

  /// @param first, second end reasons of the two farms at this time step
  void Add(EndReason first, EndReason second, bool is_first = false) {
    StepResults results;
    const auto t = static_cast<float>(moment_);
    results.rewards = {t, 10 * t};
    results.active = {1, 1};
    results.legal = {static_cast<ActionMask>(moment_), 1};
    results.end_reasons = {static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(second)};
    results.is_first = {is_first ? std::uint8_t{1} : std::uint8_t{0}, 0};
    const std::vector<float> observations{t, 0, t, 1};
    const std::vector<float> recurrent_state{t, -t};
    replay_.Add(results, observations.data(), recurrent_state.data());
    replay_.SetActions({static_cast<std::uint8_t>(moment_ % 10), 7});
    ++moment_;
  }
  Replay<float>& replay() { return replay_; }

 private:
  Replay<float> replay_;
  int moment_{};
};

constexpr EndReason kNot = EndReason::kNone;

TEST(Replay, HandsOutWhatItWasGivenOldestFirst) {
  TwoFarms farms(4, 1);
  for (int t = 0; t < 6; ++t) farms.Add(kNot, kNot);
  const auto& replay = farms.replay();
  ASSERT_EQ(replay.size(), 4U);
  for (std::size_t age = 0; age < 4; ++age) {
    const std::size_t row = replay.Row(age, 1);
    EXPECT_EQ(replay.observation(row)[0], static_cast<float>(age + 2));
    EXPECT_EQ(replay.observation(row)[1], 1.0F);
    EXPECT_EQ(replay.recurrent_state(row)[0], -static_cast<float>(age + 2));
    EXPECT_EQ(replay.Age(row), age);
  }
}

TEST(Replay, SumsRewardsOverStepsWithDiscount) {
  TwoFarms farms(10);
  for (int t = 0; t < 6; ++t) farms.Add(kNot, kNot);
  const Transition one = farms.replay().At(1, 0, 3, 0.5F);
  EXPECT_EQ(one.action, 1);
  EXPECT_FLOAT_EQ(one.reward, 2.0F + 0.5F * 3.0F + 0.25F * 4.0F);
  EXPECT_FLOAT_EQ(one.discount, 0.125F);
  EXPECT_EQ(one.to, farms.replay().Row(4, 0));
}

TEST(Replay, TerminationEndsAReturnAndItsBootstrap) {
  TwoFarms farms(10);
  farms.Add(kNot, kNot);
  farms.Add(kNot, kNot);
  farms.Add(EndReason::kAllRetrieved, EndReason::kStepLimit);
  for (int t = 0; t < 4; ++t) farms.Add(kNot, kNot, t == 0);
  const Transition terminated = farms.replay().At(0, 0, 3, 0.5F);
  EXPECT_FLOAT_EQ(terminated.reward, 1.0F + 0.5F * 2.0F);
  EXPECT_EQ(terminated.discount, 0.0F);
  const Transition truncated = farms.replay().At(0, 1, 3, 0.5F);
  EXPECT_FLOAT_EQ(truncated.reward, 10.0F + 0.5F * 20.0F);
  EXPECT_FLOAT_EQ(truncated.discount, 0.25F) << "a cut-off episode is bootstrapped";
  EXPECT_EQ(truncated.to, farms.replay().Row(2, 1));
}

TEST(Replay, NothingBeginsAtAnEpisodesLastMomentOrWithoutASuccessor) {
  TwoFarms farms(10);
  farms.Add(kNot, kNot);
  farms.Add(EndReason::kAllRetrieved, kNot);
  farms.Add(kNot, kNot, true);
  const auto& replay = farms.replay();
  EXPECT_TRUE(replay.Begins(0, 0, 1));
  EXPECT_FALSE(replay.Begins(1, 0, 1)) << "over";
  EXPECT_TRUE(replay.Begins(1, 1, 1));
  EXPECT_FALSE(replay.Begins(1, 1, 2)) << "too new";
  EXPECT_FALSE(replay.Begins(2, 1, 1)) << "the newest";
}

// The farms were lost and came back with new episodes: the last action has no known outcome.
TEST(Replay, ALostEpisodeEndsAtItsLastKnownMoment) {
  TwoFarms farms(10);
  for (int t = 0; t < 3; ++t) farms.Add(kNot, kNot);
  farms.Add(kNot, kNot, true);
  farms.Add(kNot, kNot);
  const auto& replay = farms.replay();
  EXPECT_FALSE(replay.Begins(2, 0, 1));
  EXPECT_TRUE(replay.Begins(2, 1, 1)) << "the other farm continues";
  EXPECT_TRUE(replay.Begins(1, 0, 3));
  const Transition one = replay.At(1, 0, 3, 0.5F);
  EXPECT_FLOAT_EQ(one.reward, 2.0F) << "nothing of the next episode";
  EXPECT_FLOAT_EQ(one.discount, 0.5F);
  EXPECT_EQ(one.to, replay.Row(2, 0));
  float reward = 0.0F;
  const JointTransition all = replay.JointAt(1, 0, 3, 0.5F, &reward);
  EXPECT_FLOAT_EQ(reward, 2.0F);
  EXPECT_EQ(all.to, replay.Row(2, 0));
}

TEST(Replay, ContinuesFromACheckpoint) {
  TwoFarms farms(4, 1);
  for (int t = 0; t < 7; ++t) farms.Add(kNot, kNot);
  Checkpoint checkpoint;
  farms.replay().Save(checkpoint);
  TwoFarms other(4, 1);
  other.replay().Load(checkpoint);
  Checkpoint again;
  other.replay().Save(again);
  EXPECT_EQ(checkpoint.sections, again.sections);
  TwoFarms small(3, 1);
  EXPECT_THROW(small.replay().Load(checkpoint), InputError);

  // Version 0.1.0 saved the oldest time step and their number by position.
  const auto place = checkpoint.GetNumbers("replay");
  checkpoint.sections.erase("replay");
  checkpoint.SetArray("replay.place",
                      std::vector<std::uint64_t>{std::get<std::uint64_t>(place.at("oldest")),
                                                 std::get<std::uint64_t>(place.at("size"))});
  TwoFarms older(4, 1);
  older.replay().Load(checkpoint);
  Checkpoint newer;
  older.replay().Save(newer);
  EXPECT_EQ(newer.sections, again.sections);
}

TEST(Replay, AMillionTransitionsTakeLessThan300Mebibytes) {
  const Replay<float> replay({1000000, 16, 1, 36, 0});
  EXPECT_LE(replay.bytes(), std::size_t{300} << 20U);
}

TEST(SumTree, FindsLeavesByTheirShare) {
  SumTree tree(5);
  const std::vector<float> priorities{1, 0, 3, 0.5F, 2};
  for (std::size_t i = 0; i < priorities.size(); ++i) tree.Set(i, priorities[i]);
  EXPECT_FLOAT_EQ(tree.Total(), 6.5F);
  std::vector<int> counts(8);
  constexpr int kDraws = 6500;
  for (int k = 0; k < kDraws; ++k) {
    ++counts[tree.Find((static_cast<float>(k) + 0.5F) / kDraws * tree.Total())];
  }
  for (std::size_t i = 0; i < priorities.size(); ++i) {
    EXPECT_NEAR(counts[i], priorities[i] * 1000, 2) << "leaf " << i;
  }
  tree.Set(2, 0.0F);
  EXPECT_FLOAT_EQ(tree.Total(), 3.5F);
  EXPECT_NE(tree.Find(tree.Total()), 2U) << "a mass beyond the total by rounding";
}

}  // namespace
}  // namespace aquafarm::agents::test
