// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/curiosity/curiosity.h"

#include <algorithm>

#include "agents_fixture.h"
#include "curiosity/curiosity_module.h"

namespace aquafarm::agents::test {
namespace {

/// Action 0 sets the first feature to 1, action 1 to −1; the other features are unchanged.
struct Transitions {
  std::vector<float> from;
  std::vector<float> to;
  std::vector<std::int64_t> actions;
};

Transitions Draw(RandomStream& rng, std::size_t count, float second) {
  Transitions drawn;
  for (std::size_t i = 0; i < count; ++i) {
    const auto action = static_cast<std::int64_t>(rng.Below(2));
    const float third = rng.Uniform(-1.0F, 1.0F);
    drawn.from.insert(drawn.from.end(), {0.0F, second, third});
    drawn.to.insert(drawn.to.end(), {action == 0 ? 1.0F : -1.0F, second, third});
    drawn.actions.push_back(action);
  }
  return drawn;
}

float MeanError(CuriosityModule& module, Transitions transitions) {
  std::vector<float> errors;
  module.Step(transitions.from, transitions.to, transitions.actions, 0, errors);
  float sum = 0.0F;
  for (const float error : errors) sum += error;
  return sum / static_cast<float>(errors.size());
}

TEST(Curiosity, WhatIsWellKnownSurprisesLessThanWhatIsNew) {
  CuriosityModule module(3, 1);
  RandomStream rng({4, 0, RngStream::kLearner, 0});
  float known = 0.0F;
  for (int i = 0; i < 1500; ++i) known = MeanError(module, Draw(rng, 16, 0.0F));
  const float fresh = MeanError(module, Draw(rng, 16, 3.0F));  // unseen features
  EXPECT_GT(known, 0.0F);
  EXPECT_GT(fresh, 20.0F * known);
}

TEST(Curiosity, TheForwardModelDoesNotTeachWhatIsSeen) {
  const auto network = std::make_shared<CuriosityNetwork>(4);
  DrawWeights(*network, 1, 2);
  const torch::Tensor from = torch::linspace(-1.0, 1.0, 12).view({3, 4});
  const torch::Tensor to = torch::linspace(0.5, -2.0, 12).view({3, 4});
  const torch::Tensor actions = torch::tensor({0, 9, 4}, torch::kInt64);
  network->Forward(from, to, actions).error.sum().backward();
  for (const auto& item : network->named_parameters()) {
    const bool has_gradient =
        item.value().grad().defined() && item.value().grad().abs().sum().item<float>() > 0.0F;
    EXPECT_EQ(has_gradient, item.key().rfind("forward", 0) == 0) << item.key();
  }
}

/// Records its rewards and always moves north.
class Purse final : public Learner {
 public:
  explicit Purse(std::vector<float>& rewards) : rewards_(rewards) {}
  std::uint8_t observation_types() const override { return kIndexBit; }
  std::string options() const override { return ""; }
  void Step(const StepResults& results, double, std::vector<std::uint8_t>& actions) override {
    rewards_ = results.rewards;
    actions.assign(results.legal.size(), 0);
  }
  LearnerStatus status() const override { return {}; }
  std::unique_ptr<Policy> GreedyPolicy() const override { return nullptr; }
  void SavePolicy(Checkpoint&) const override {}
  void Save(Checkpoint&) const override {}
  void Load(const Checkpoint&) override {}

 private:
  std::vector<float>& rewards_;
};

TEST(Curiosity, PaysForTransitionsAloneAndNothingOnceItsWeightIsGone) {
  LocalEnvironment environment(TinyFarm(4), {3, kIndexBit | kFeaturesBit, false, 1});
  std::vector<float> intrinsic;
  const auto learner = WithCuriosity(std::make_unique<Purse>(intrinsic), environment.spec(), 1,
                                     ParseExploration("icm:linear:2:0:0.5"));
  EXPECT_EQ(learner->observation_types(), kIndexBit | kFeaturesBit);
  std::vector<std::uint8_t> actions;
  const StepResults* results = &environment.Reset(1);
  int starts = 0;
  for (int i = 0; i < 30; ++i) {
    const double progress = i < 20 ? 0.1 : 0.5;
    learner->Step(*results, progress, actions);
    for (std::size_t farm = 0; farm < 3; ++farm) {
      const bool is_transition = results->is_first[farm] == 0;
      starts += is_transition ? 0 : 1;
      const float extra = intrinsic[farm] - results->rewards[farm];
      if (is_transition && progress < 0.5) {
        EXPECT_GT(extra, 0.0F);
        EXPECT_LE(extra, 5.0F * 2.0F);
      } else {
        EXPECT_EQ(extra, 0.0F);
      }
    }
    results = &environment.Step(actions);
  }
  EXPECT_GT(starts, 3);  // in addition to the first
}

TEST(Curiosity, ANonFiniteLossNamesTheStepAndTheSeed) {
  LocalEnvironment environment(TinyFarm(), {3, kIndexBit | kFeaturesBit, false, 1});
  std::vector<float> intrinsic;
  const auto learner = WithCuriosity(std::make_unique<Purse>(intrinsic), environment.spec(), 7,
                                     ParseExploration("icm:1"));
  Checkpoint checkpoint;
  learner->Save(checkpoint);
  std::fill_n(checkpoint.sections["curiosity.weights"].begin() + 40, 4, '\xff');  // a NaN
  checkpoint.SetArray("curiosity.steps", std::vector<std::uint64_t>{1000});
  learner->Load(checkpoint);
  std::vector<std::uint8_t> actions;
  const StepResults* results = &environment.Reset(1);
  std::int64_t steps = 1000;
  std::string message;
  for (int i = 0; i < 100 && message.empty(); ++i) {
    steps += std::count(results->is_first.begin(), results->is_first.end(), std::uint8_t{0});
    message = MessageOf<LearnerFailed>([&] { learner->Step(*results, 0.1, actions); });
    results = &environment.Step(actions);
  }
  EXPECT_CONTAINS(message, "is not finite after " + std::to_string(steps) + " farm steps, on the ");
  EXPECT_CONTAINS(message, " transitions of seed 7; expected a number");
}

}  // namespace
}  // namespace aquafarm::agents::test
