// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/base/schedule.h"

#include "agents_fixture.h"
#include "aquafarm/agents/base/options.h"

namespace aquafarm::agents::test {
namespace {

TEST(Schedule, ConstantStays) {
  const Schedule schedule = ParseSchedule("0.25", "rate", 0, 1);
  EXPECT_EQ(schedule.At(0.0), 0.25);
  EXPECT_EQ(schedule.At(1.0), 0.25);
}

TEST(Schedule, LinearReachesItsEndAtItsShareAndStays) {
  const Schedule schedule = ParseSchedule("linear:1:0.2:0.5", "rate", 0, 1);
  EXPECT_DOUBLE_EQ(schedule.At(0.0), 1.0);
  EXPECT_DOUBLE_EQ(schedule.At(0.25), 0.6);
  EXPECT_DOUBLE_EQ(schedule.At(0.5), 0.2);
  EXPECT_DOUBLE_EQ(schedule.At(1.0), 0.2);
}

TEST(Schedule, ThatIsZeroAtBothEndsIsNeverPositive) {
  for (const char* text : {"0.1", "linear:0:1:0.3", "linear:1:0:0.1"}) {
    EXPECT_TRUE(ParseSchedule(text, "share", 0, 1).IsEverPositive()) << text;
  }
  for (const char* text : {"0", "linear:0:0:0.5"}) {
    EXPECT_FALSE(ParseSchedule(text, "share", 0, 1).IsEverPositive()) << text;
  }
}

TEST(Schedule, ExponentialHalvesInEqualTimes) {
  const Schedule schedule = ParseSchedule("exponential:8:2:1", "rate", 0, 10);
  EXPECT_DOUBLE_EQ(schedule.At(0.0), 8.0);
  EXPECT_DOUBLE_EQ(schedule.At(0.5), 4.0);
  EXPECT_DOUBLE_EQ(schedule.At(1.0), 2.0);
}

TEST(Schedule, HarmonicFallsAsOneOverTheTime) {
  const Schedule schedule = ParseSchedule("harmonic:8:2:0.6", "rate", 0, 10);
  EXPECT_DOUBLE_EQ(schedule.At(0.0), 8.0);
  EXPECT_DOUBLE_EQ(schedule.At(0.2), 4.0);  // the inverse grows linearly from 1/8 to 1/2
  EXPECT_DOUBLE_EQ(schedule.At(0.4), 8.0 / 3.0);
  EXPECT_DOUBLE_EQ(schedule.At(0.6), 2.0);
  EXPECT_DOUBLE_EQ(schedule.At(1.0), 2.0);
}

TEST(Schedule, TextReadsBackToTheSame) {
  for (const std::string text :
       {"0.1", "linear:1:0.05:0.5", "exponential:20:0.5:1", "harmonic:5e-04:1e-05:1"}) {
    EXPECT_EQ(ToString(ParseSchedule(text, "rate", 0, 100)), text);
  }
  EXPECT_EQ(ToString(ParseSchedule("constant:0.1", "rate", 0, 1)), "0.1");
}

TEST(Schedule, EachKindHasAName) {
  for (int i = 0; i < kScheduleKindCount; ++i)
    EXPECT_NE(ToString(static_cast<ScheduleKind>(i)), "?");
}

TEST(Schedule, RefusalsSayWhatIsAllowed) {
  const auto refuse = [](const std::string& text) {
    return MessageOf<InputError>([&] { ParseSchedule(text, "rate", 0, 1); });
  };
  EXPECT_CONTAINS(refuse("fast"), "rate: got 'fast', expected a number");
  EXPECT_CONTAINS(refuse("2"), "rate: got 2, expected [0, 1]");
  EXPECT_CONTAINS(refuse("nan"), "expected a number");
  EXPECT_CONTAINS(refuse("linear:1:0"), "expected a number or kind:start:end:fraction");
  EXPECT_CONTAINS(refuse("constant:1:0:1"), "kind is linear, exponential or harmonic");
  EXPECT_CONTAINS(refuse("linear:1:0:0"), "rate: fraction: got 0, expected (0, 1]");
  EXPECT_CONTAINS(refuse("exponential:1:0:1"), "above 0 for kind exponential");
  EXPECT_CONTAINS(refuse("harmonic:0:1:1"), "above 0 for kind harmonic");
}

TEST(OptionReader, UnknownKeysAreAnsweredWithThoseThereAre) {
  OptionReader reader("gamma=0.9 lerning_rate=0.1");
  reader.Number("gamma", 0.5, 0, 1);
  reader.Number("learning_rate", 0.5, 0, 1);
  EXPECT_CONTAINS(MessageOf<InputError>([&] { reader.Finish(); }),
                  "got 'lerning_rate', expected one of: gamma, learning_rate");
}

TEST(OptionReader, ResolvedNamesEveryOption) {
  OptionReader reader("flag=true,number=3");
  reader.Number("number", 1, 0, 10);
  reader.Flag("flag", false);
  reader.Number("other", 0.5, 0, 1);
  EXPECT_EQ(reader.Resolved(), "flag=true number=3 other=0.5");
}

TEST(OptionReader, RefusesWordsAndRepetitions) {
  EXPECT_CONTAINS(MessageOf<InputError>([] { OptionReader("fast"); }), "expected key=value");
  EXPECT_CONTAINS(MessageOf<InputError>([] { OptionReader("a=1 a=2"); }), "got a twice");
  OptionReader reader("a=yes b=11");
  EXPECT_CONTAINS(MessageOf<InputError>([&] { reader.Flag("a", true); }),
                  "a: got 'yes', expected true or false");
  EXPECT_CONTAINS(MessageOf<InputError>([&] { reader.Number("b", 1, 0, 10); }),
                  "b: got 11, expected [0, 10]");
}

TEST(OptionReader, OldNamesCountAsTheNewOnes) {
  OptionReader reader("batch=8 discount=0.5");
  EXPECT_EQ(reader.Number("batch_size", 1, 0, 10), 8.0);
  EXPECT_EQ(reader.Number("gamma", 1, 0, 1), 0.5);
  reader.Finish();
  EXPECT_EQ(reader.Resolved(), "batch_size=8 gamma=0.5");
  EXPECT_CONTAINS(MessageOf<InputError>([] { OptionReader("batch_size=8 batch=9"); }),
                  "options: got batch_size and batch, the old and the new name of one option, "
                  "expected it once");
  EXPECT_CONTAINS(MessageOf<InputError>([] { OptionReader("batch=8 batch=9"); }),
                  "options: got batch twice, expected it once");
}

TEST(OptionReader, OldNamesAreReported) {
  const std::vector<std::string> lines = RenamedOptions("start=5 loss=mse target_rate=0.1");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0], "option start is now called learning_starts");
  EXPECT_EQ(lines[1], "option target_rate is now called tau");
  EXPECT_TRUE(RenamedOptions("learning_starts=5 tau=0.1").empty());
}

TEST(OptionReader, RecordedOptionsGetTheCurrentNamesAndOrder) {
  EXPECT_EQ(CanonicalOptions("batch=8 discount=0.5 hidden=4 loss=mse"),
            "batch_size=8 gamma=0.5 hidden_size=4 loss=mse");
  EXPECT_EQ(CanonicalOptions("start=5 threads=1"), "learning_starts=5 threads=1");
  EXPECT_EQ(CanonicalOptions(""), "");
}

}  // namespace
}  // namespace aquafarm::agents::test
