// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/algorithms.h"

#include "aquafarm/agents/options.h"
#include "aquafarm/agents/random_policy.h"
#include "aquafarm/agents/tabular.h"
#include "aquafarm/check.h"

namespace aquafarm::agents {
namespace {

template <typename T>
std::unique_ptr<Learner> Make(const EnvironmentSpec& spec, std::uint64_t seed,
                              const std::string& options) {
  return std::make_unique<T>(spec, seed, options);
}

}  // namespace

const std::vector<Algorithm>& Algorithms() {
  static const std::vector<Algorithm> algorithms{
      {"random", "any action at any time; the yardstick (§4)", 0, 100000, Make<RandomLearner>,
       [](const Checkpoint&, const EnvironmentSpec& spec) -> std::unique_ptr<Policy> {
         return std::make_unique<RandomPolicy>(spec.agents);
       }},
      {"q_learning", "tabular Q-learning (Eq. 12)", kIndexBit, 4000000,
       Make<TabularLearner<QLearningRule>>, MakeTabularPolicy},
      {"sarsa", "tabular SARSA (Eq. 14)", kIndexBit, 8000000, Make<TabularLearner<SarsaRule>>,
       MakeTabularPolicy},
  };
  return algorithms;
}

const Algorithm& FindAlgorithm(const std::string& name) {
  std::vector<std::string> names;
  for (const Algorithm& algorithm : Algorithms()) {
    if (name == algorithm.name) return algorithm;
    names.emplace_back(algorithm.name);
  }
  throw InputError("algorithm: got '" + name + "', expected one of: " + Join(names));
}

}  // namespace aquafarm::agents
