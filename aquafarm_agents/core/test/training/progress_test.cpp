// SPDX-License-Identifier: BSD-3-Clause
// The progress line of a training.
#include <gtest/gtest.h>

#include <cmath>

#include "aquafarm/agents/training/progress_text.h"

namespace aquafarm::agents::test {
namespace {

TrainingProgress Midway() {
  TrainingProgress progress;
  progress.steps = 812'000;
  progress.step_limit = 3'000'000;
  progress.episodes = 1'240;
  progress.mean_return = 81.24F;
  progress.success_rate = 0.62F;
  progress.learner.exploration = 0.25F;
  progress.steps_per_second = 250'400.7;
  progress.time_left_s = 8.74;
  return progress;
}

std::string Left(double seconds) {
  TrainingProgress progress;
  progress.time_left_s = seconds;
  const std::string line = DescribeProgress(progress);
  const std::size_t at = line.find("  left ");
  return at == std::string::npos ? "" : line.substr(at);
}

TEST(Progress, ALineHasReturnSuccessSpeedAndTimeLeft) {
  EXPECT_EQ(DescribeProgress(Midway()),
            "steps 812,000 / 3,000,000  episodes 1,240  return 81.2  success 0.62  "
            "exploration 0.25  250,400 steps/s  left 8.7 s");
}

TEST(Progress, BeforeTheFirstEpisodeEndsThereIsNoReturn) {
  TrainingProgress progress;
  progress.steps = 64;
  progress.episode_limit = 50;
  EXPECT_EQ(DescribeProgress(progress), "steps 64  episodes 0 / 50  exploration 0  0 steps/s");
}

TEST(Progress, ReturnsOfAShortTrainingHaveItsNumberOfEpisodesAndNoBestMean) {
  TrainingProgress progress = Midway();
  progress.best_mean_return = 85.0F;
  EXPECT_EQ(DescribeReturns(progress),
            "last 50    return 81.2, success 62.0 % (exploring); best mean return 85.0");
  progress.episodes = 3;
  progress.best_mean_return = std::nanf("");
  EXPECT_EQ(DescribeReturns(progress), "last 3     return 81.2, success 62.0 % (exploring)");
}

TEST(Progress, TimeLeftIsInTheUnitsThatPeopleSay) {
  EXPECT_EQ(Left(-1.0), "");
  EXPECT_EQ(Left(0.0), "  left 0.0 s");
  EXPECT_EQ(Left(59.4), "  left 59.4 s");
  EXPECT_EQ(Left(62.0), "  left 1 min 02 s");
  EXPECT_EQ(Left(3660.0), "  left 1 h 01 min");
}

}  // namespace
}  // namespace aquafarm::agents::test
