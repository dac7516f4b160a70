// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/algorithms.h"

#include "aquafarm/agents/dqn.h"
#include "aquafarm/agents/options.h"
#include "aquafarm/agents/planner_policy.h"
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

template <Foresight foresight>
std::unique_ptr<Policy> MakePlannerPolicy(const Checkpoint&, const EnvironmentSpec& spec) {
  return std::make_unique<PlannerPolicy>(spec, foresight);
}

std::unique_ptr<Policy> MakeRandomPolicy(const Checkpoint&, const EnvironmentSpec& spec) {
  return std::make_unique<RandomPolicy>(spec.agents);
}

template <std::uint8_t bits>
std::uint8_t WithoutOptions(const std::string& options) {
  OptionReader(options).Finish();
  return bits;
}

std::uint8_t Tabular(const std::string& options) {
  std::string resolved;
  TabularOptions::Parse(options, resolved);
  return kIndexBit;
}

}  // namespace

const std::vector<Algorithm>& Algorithms() {
  static const std::vector<Algorithm> algorithms{
      {"random", "any action at any time; the yardstick (§4)", false, 100000, WithoutOptions<0>,
       Make<RandomLearner>, MakeRandomPolicy},
      {"q_learning", "tabular Q-learning (Eq. 12)", true, 4000000, Tabular,
       Make<TabularLearner<QLearningRule>>, MakeTabularPolicy},
      {"sarsa", "tabular SARSA (Eq. 14)", true, 8000000, Tabular, Make<TabularLearner<SarsaRule>>,
       MakeTabularPolicy},
      {"dqn", "deep Q-network on features or planes (Eq. 15)", true, 400000, DqnEncodings, MakeDqn,
       MakeDqnPolicy},
      {"lstm_dqn", "deep Q-network with a memory (Algorithm 2)", true, 400000,
       RecurrentDqnEncodings, MakeRecurrentDqn, MakeRecurrentDqnPolicy},
      {"planner", "plans anew each step, trusting that disasters hold their heading", false, 0,
       WithoutOptions<kStatesBit>, nullptr, MakePlannerPolicy<Foresight::kHeadingHolds>},
      {"clairvoyant", "plans with the disasters' true future: the best there can be", false, 0,
       WithoutOptions<kStatesBit>, nullptr, MakePlannerPolicy<Foresight::kClairvoyant>},
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
