// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/learning/independent.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

EnvironmentSpec SpecOfOne(EnvironmentSpec spec) {
  spec.agents = 1;
  return spec;
}

// Returns the seed of an agent's random streams. Agents of runs with nearby seeds have different
// seeds.
std::uint64_t SeedOf(std::uint64_t seed, std::size_t agent) {
  return seed ^ (static_cast<std::uint64_t>(agent) << 48U);
}

std::string PrefixOf(std::size_t agent) { return "agent" + std::to_string(agent) + "/"; }

Checkpoint PartOf(const Checkpoint& whole, std::size_t agent) {
  Checkpoint part = whole.Part(PrefixOf(agent));
  part.spec = SpecOfOne(whole.spec);
  return part;
}

/// Extracts the results of one agent of every farm. Reuses its buffers.
class Share {
 public:
  /// @param agents number of agents of one farm
  const StepResults& Of(const StepResults& all, std::size_t agent, std::size_t agents) {
    VisitStepFields(
        [&](const StepField& field, const auto& from, auto& to) {
          if (field.rows == StepField::Rows::kFarms) {
            to = from;
          } else {
            Take(from, agent, agents, all.end_reasons.size(), to);
          }
        },
        all, share_);
    return share_;
  }

 private:
  // Copies [farms, agents, size] to [farms, size].
  template <typename T>
  static void Take(const std::vector<T>& from, std::size_t agent, std::size_t agents,
                   std::size_t farms, std::vector<T>& to) {
    const std::size_t size = from.size() / (farms * agents);
    to.resize(farms * size);
    for (std::size_t farm = 0; farm < farms; ++farm) {
      std::copy_n(from.data() + (farm * agents + agent) * size, size, to.data() + farm * size);
    }
  }

  StepResults share_;
};

template <typename T>
void Spread(const std::vector<T>& own, std::size_t agent, std::size_t agents, std::vector<T>& all) {
  all.resize(own.size() * agents);
  for (std::size_t farm = 0; farm < own.size(); ++farm) {
    all[farm * agents + agent] = own[farm];
  }
}

class IndependentPolicy final : public Policy {
 public:
  explicit IndependentPolicy(std::vector<std::unique_ptr<Policy>> policies)
      : policies_(std::move(policies)) {}
  std::uint8_t observation_types() const override { return policies_[0]->observation_types(); }
  void Begin(std::uint64_t seed, std::int32_t farms) override {
    for (std::size_t i = 0; i < policies_.size(); ++i) policies_[i]->Begin(SeedOf(seed, i), farms);
  }
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override {
    for (std::size_t i = 0; i < policies_.size(); ++i) {
      policies_[i]->Act(share_.Of(results, i, policies_.size()), own_);
      Spread(own_, i, policies_.size(), actions);
      Spread(policies_[i]->values(), i, policies_.size(), values_);
    }
  }

 private:
  std::vector<std::unique_ptr<Policy>> policies_;
  Share share_;
  std::vector<std::uint8_t> own_;
};

class IndependentLearner final : public Learner {
 public:
  IndependentLearner(const EnvironmentSpec& spec, std::uint64_t seed,
                     const MakeAgentLearner& make) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(spec.agents); ++i) {
      learners_.push_back(make(SpecOfOne(spec), SeedOf(seed, i)));
    }
  }
  std::uint8_t observation_types() const override { return learners_[0]->observation_types(); }
  std::string options() const override { return learners_[0]->options(); }
  void Step(const StepResults& results, double progress,
            std::vector<std::uint8_t>& actions) override {
    for (std::size_t i = 0; i < learners_.size(); ++i) {
      learners_[i]->Step(share_.Of(results, i, learners_.size()), progress, own_);
      Spread(own_, i, learners_.size(), actions);
    }
  }
  LearnerStatus status() const override {
    LearnerStatus mean = learners_[0]->status();
    mean.loss = 0.0F;
    for (const auto& learner : learners_) {
      mean.loss += learner->status().loss / static_cast<float>(learners_.size());
    }
    return mean;
  }
  std::unique_ptr<Policy> GreedyPolicy() const override {
    std::vector<std::unique_ptr<Policy>> policies;
    for (const auto& learner : learners_) policies.push_back(learner->GreedyPolicy());
    return std::make_unique<IndependentPolicy>(std::move(policies));
  }
  void SavePolicy(Checkpoint& checkpoint) const override {
    for (std::size_t i = 0; i < learners_.size(); ++i) {
      Checkpoint part;
      learners_[i]->SavePolicy(part);
      checkpoint.AddPart(PrefixOf(i), std::move(part));
    }
  }
  void Save(Checkpoint& checkpoint) const override {
    for (std::size_t i = 0; i < learners_.size(); ++i) {
      Checkpoint part;
      part.lends = checkpoint.lends;
      learners_[i]->Save(part);
      checkpoint.AddPart(PrefixOf(i), std::move(part));
    }
  }
  void Load(const Checkpoint& checkpoint) override {
    for (std::size_t i = 0; i < learners_.size(); ++i) learners_[i]->Load(PartOf(checkpoint, i));
  }

 private:
  std::vector<std::unique_ptr<Learner>> learners_;
  Share share_;
  std::vector<std::uint8_t> own_;
};

}  // namespace

std::unique_ptr<Learner> MakeIndependent(const EnvironmentSpec& spec, std::uint64_t seed,
                                         const MakeAgentLearner& make) {
  return std::make_unique<IndependentLearner>(spec, seed, make);
}

std::unique_ptr<Policy> MakeIndependentPolicy(const Checkpoint& checkpoint,
                                              const EnvironmentSpec& spec,
                                              const MakeAgentPolicy& make) {
  CheckFit(checkpoint, spec, "agents", checkpoint.spec.agents, spec.agents);
  std::vector<std::unique_ptr<Policy>> policies;
  for (std::size_t i = 0; i < static_cast<std::size_t>(spec.agents); ++i) {
    policies.push_back(make(PartOf(checkpoint, i), SpecOfOne(spec)));
  }
  return std::make_unique<IndependentPolicy>(std::move(policies));
}

}  // namespace aquafarm::agents
