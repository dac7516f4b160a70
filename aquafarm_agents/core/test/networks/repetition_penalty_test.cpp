// SPDX-License-Identifier: BSD-3-Clause
#include "networks/repetition_penalty.h"

#include <algorithm>

#include "agents_fixture.h"
#include "aquafarm/agents/dqn/dqn.h"
#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/networks/deep_options.h"

namespace aquafarm::agents::test {
namespace {

using Values = std::array<float, kActionCount>;

// self.x, self.y, time_left, free_capacity, device0.deployed, device0.aboard
using Features = std::array<float, 6>;
constexpr Features kHere{0.5F, -0.25F, 0.9F, 1.0F, 1.0F, 0.0F};
constexpr Features kHereLater{0.5F, -0.25F, 0.1F, 1.0F, 1.0F, 0.0F};
constexpr Features kHereLaden{0.5F, -0.25F, 0.9F, 0.0F, 1.0F, 0.0F};
constexpr Features kHereWhenItIsHome{0.5F, -0.25F, 0.9F, 1.0F, 0.0F, 0.0F};
constexpr Features kNextToIt{0.5F, -0.24F, 0.9F, 1.0F, 1.0F, 0.0F};

EnvironmentSpec Spec(std::int32_t farms, std::int32_t agents) {
  EnvironmentSpec spec;
  spec.farms = farms;
  spec.agents = agents;
  spec.feature_names = {"self.x",        "self.y",           "time_left",
                        "free_capacity", "device0.deployed", "device0.aboard"};
  return spec;
}

const EnvironmentSpec kTwoFarmsOfTwo = Spec(2, 2);

Values Discouraged(RepetitionPenalty& repetitions, const Features& features, std::size_t slot) {
  const Values plain{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  Values values{};
  std::copy_n(repetitions.Penalize(plain.data(), features.data(), slot), kActionCount,
              values.begin());
  for (std::size_t a = 0; a < kActionCount; ++a) values[a] -= plain[a];
  return values;
}

void Do(RepetitionPenalty& repetitions, const Features& features, std::uint8_t action,
        std::size_t slot) {
  Discouraged(repetitions, features, slot);
  repetitions.Add(action, slot);
}

StepResults Started(std::vector<std::uint8_t> farms) {
  StepResults results;
  results.is_first = std::move(farms);
  return results;
}

TEST(RepetitionPenalty, CountAnActionLessForEachTimeItWasTakenFromThere) {
  RepetitionPenalty repetitions(kTwoFarmsOfTwo, 0.5);
  Do(repetitions, kHere, 3, 1);
  Do(repetitions, kNextToIt, 9, 1);
  Do(repetitions, kHereLater, 3, 1);
  EXPECT_EQ(Discouraged(repetitions, kHere, 1), (Values{0, 0, 0, -1.0F}));
  EXPECT_EQ(Discouraged(repetitions, kNextToIt, 1), (Values{0, 0, 0, 0, 0, 0, 0, 0, 0, -0.5F}));
  EXPECT_EQ(Discouraged(repetitions, kHereLaden, 1), Values{}) << "with another load";
  EXPECT_EQ(Discouraged(repetitions, kHereWhenItIsHome, 1), Values{}) << "with another to fetch";
  EXPECT_EQ(Discouraged(repetitions, kHere, 0), Values{}) << "another agent";
}

TEST(RepetitionPenalty, AreForgottenWithTheEpisode) {
  RepetitionPenalty repetitions(kTwoFarmsOfTwo, 0.5);
  for (std::size_t slot = 0; slot < 4; ++slot) Do(repetitions, kHere, 3, slot);
  repetitions.Begin(Started({0, 1}));
  EXPECT_EQ(Discouraged(repetitions, kHere, 1), (Values{0, 0, 0, -0.5F}));
  EXPECT_EQ(Discouraged(repetitions, kHere, 2), Values{});
  EXPECT_EQ(Discouraged(repetitions, kHere, 3), Values{});
}

TEST(RepetitionPenalty, AreForgottenAfterAThousandSteps) {
  RepetitionPenalty repetitions(Spec(1, 1), 0.5);
  Do(repetitions, kHere, 3, 0);
  for (int step = 0; step < 1023; ++step) Do(repetitions, kNextToIt, 2, 0);
  EXPECT_EQ(Discouraged(repetitions, kHere, 0), (Values{0, 0, 0, -0.5F}));
  Do(repetitions, kNextToIt, 2, 0);
  EXPECT_EQ(Discouraged(repetitions, kHere, 0), Values{});
}

TEST(RepetitionPenalty, EndGoingToAndFro) {
  // Values of a network with an error of 3: it prefers to step away and back over the pickup.
  constexpr std::uint8_t kAside = 1;
  constexpr std::uint8_t kBack = 5;
  constexpr auto kPickup = static_cast<std::uint8_t>(Action::kPickup);
  const auto steps_until_pickup = [](double penalty) {
    RepetitionPenalty repetitions(Spec(1, 1), penalty);
    bool is_there = true;
    for (int step = 0; step < 100; ++step) {
      Values values{};
      values[is_there ? kAside : kBack] = 10.0F;
      if (is_there) values[kPickup] = 7.0F;
      const auto& features = is_there ? kHere : kNextToIt;
      const float* const penalized = repetitions.Penalize(values.data(), features.data(), 0);
      const auto action = static_cast<std::uint8_t>(
          std::max_element(penalized, penalized + kActionCount) - penalized);
      if (action == kPickup) return step;
      repetitions.Add(action, 0);
      is_there = !is_there;
    }
    return 100;
  };
  EXPECT_EQ(steps_until_pickup(0.0), 100) << "for ever";
  EXPECT_EQ(steps_until_pickup(0.5), 14) << "after seven times aside and back";
}

TEST(RepetitionPenalty, ContinueFromACheckpoint) {
  RepetitionPenalty repetitions(kTwoFarmsOfTwo, 0.5);
  for (std::uint8_t step = 0; step < 200; ++step) Do(repetitions, kHere, step % 7, step % 2);
  Checkpoint checkpoint;
  repetitions.Save(checkpoint);
  RepetitionPenalty loaded(kTwoFarmsOfTwo, 0.5);
  loaded.Load(checkpoint);
  for (RepetitionPenalty* one : {&repetitions, &loaded}) Do(*one, kHere, 8, 1);
  EXPECT_EQ(Discouraged(loaded, kHere, 1), Discouraged(repetitions, kHere, 1));
  EXPECT_LT(Discouraged(loaded, kHere, 1)[8], 0.0F);
  RepetitionPenalty of_fewer(Spec(1, 2), 0.5);
  EXPECT_THROW(of_fewer.Load(checkpoint), InputError);
}

TEST(RepetitionPenalty, KnowASituationByFeaturesThatEveryFarmHas) {
  const LocalEnvironment environment(TinyFarm(), {1, kFeaturesBit, false, 1});
  const std::vector<std::string>& names = environment.spec().feature_names;
  for (const std::string& name : kTwoFarmsOfTwo.feature_names) {
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  }
}

// Entity tokens have no position of the ship, but those of the ports relative to it.
TEST(RepetitionPenalty, KnowASituationOfTokensByThePorts) {
  EnvironmentSpec spec = Spec(1, 1);
  spec.feature_names = {"ship.time_left", "ship.free_capacity", "device0.east", "device0.deployed",
                        "device0.aboard", "port0.east",         "port0.north"};
  RepetitionPenalty repetitions(spec, 2.0);
  const std::array<float, 7> here{0.5F, 1.0F, 0.3F, 1.0F, 0.0F, 0.25F, -0.5F};
  const Values plain{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  repetitions.Penalize(plain.data(), here.data(), 0);
  repetitions.Add(3, 0);
  for (std::size_t i = 0; i < here.size(); ++i) {
    std::array<float, 7> other = here;
    other[i] += 0.0625F;
    const bool is_same = i == 0 || i == 2;  // the time, and a device next to the ports
    EXPECT_EQ(repetitions.Penalize(plain.data(), other.data(), 0)[3], is_same ? 1.0F : 3.0F) << i;
  }
}

TEST(RepetitionPenalty, NeedFeatures) {
  EXPECT_CONTAINS(
      MessageOf<InputError>([] { DqnObservationTypes("network=cnn repetition_penalty=0.5"); }),
      "repetition_penalty: got 0.5, expected 0 with network=cnn, which reads no features");
}

}  // namespace
}  // namespace aquafarm::agents::test
