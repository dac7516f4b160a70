// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/algorithms.h"

#include <algorithm>
#include <cstdlib>

#include "aquafarm/agents/base/options.h"
#include "aquafarm/agents/curiosity/curiosity.h"
#include "aquafarm/agents/dqn/dqn.h"
#include "aquafarm/agents/learning/do_nothing.h"
#include "aquafarm/agents/learning/independent.h"
#include "aquafarm/agents/learning/random_policy.h"
#include "aquafarm/agents/learning/tabular.h"
#include "aquafarm/agents/maddpg/maddpg.h"
#include "aquafarm/agents/networks/torch_runtime.h"
#include "aquafarm/agents/planning/fetch_by_value.h"
#include "aquafarm/agents/planning/planner_policy.h"
#include "aquafarm/agents/planning/team_planner.h"
#include "aquafarm/agents/ppo/ppo.h"
#include "aquafarm/agents/training/register_learner.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/suggest.h"
#include "aquafarm/scenario/scenario_yaml.h"

namespace aquafarm::agents {
namespace {

template <typename T>
std::unique_ptr<Learner> Make(const EnvironmentSpec& spec, std::uint64_t seed,
                              const std::string& options) {
  return std::make_unique<T>(spec, seed, options);
}

template <Foresight foresight>
std::unique_ptr<Policy> MakePlannerPolicy(const Checkpoint&, const EnvironmentSpec& spec) {
  if (spec.agents > 1) return std::make_unique<TeamPlannerPolicy>(spec, foresight);
  return std::make_unique<PlannerPolicy>(spec, foresight);
}

std::unique_ptr<Policy> MakePlanner(const EnvironmentSpec& spec) {
  return MakePlannerPolicy<Foresight::kPersistence>({}, spec);
}

// Makes a learner that may imitate the planner.
template <auto make>
std::unique_ptr<Learner> WithPlanner(const EnvironmentSpec& spec, std::uint64_t seed,
                                     const std::string& options) {
  return make(spec, seed, options, MakePlanner);
}
template <auto make>
std::unique_ptr<ShardedLearner> WithPlannerOfRanks(const EnvironmentSpec& spec, std::uint64_t seed,
                                                   const std::string& options,
                                                   ProcessGroup& group) {
  return make(spec, seed, options, group, MakePlanner);
}

// Makes a policy that needs only the spec of the farms.
template <typename T>
std::unique_ptr<Policy> MakeBuiltIn(const Checkpoint&, const EnvironmentSpec& spec) {
  return std::make_unique<T>(spec);
}

std::unique_ptr<Policy> MakeRandomPolicy(const Checkpoint& checkpoint,
                                         const EnvironmentSpec& spec) {
  return std::make_unique<RandomPolicy>(spec, ParseRandomActions(checkpoint.options));
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

using ObservationTypes = std::uint8_t (*)(const std::string&);
using MakeLearner = std::unique_ptr<Learner> (*)(const EnvironmentSpec&, std::uint64_t,
                                                 const std::string&);

// Returns the exploration in the options of a learner, and ignores all other options.
ExplorationOptions ExplorationIn(const std::string& options) {
  return ParseExploration(OptionReader(options).Text("exploration", "epsilon_greedy"),
                          ExplorationOf::kAny);
}

template <ObservationTypes observation_types>
std::uint8_t WithCuriosityToo(const std::string& options) {
  const std::uint8_t bits = observation_types(options);
  return ExplorationIn(options).is_curious() ? bits | kFeaturesBit : bits;
}

template <MakeLearner make>
std::unique_ptr<Learner> MakeExplorer(const EnvironmentSpec& spec, std::uint64_t seed,
                                      const std::string& options) {
  const ExplorationOptions exploration = ExplorationIn(options);
  if (!exploration.is_curious()) return make(spec, seed, options);
  PrepareTorch(1);  // a deep learner sets its own number of threads
  return WithCuriosity(make(spec, seed, options), spec, seed, exploration);
}

template <MakeLearner make>
std::unique_ptr<Learner> MakeEach(const EnvironmentSpec& spec, std::uint64_t seed,
                                  const std::string& options) {
  return MakeIndependent(spec, seed,
                         [&options](const EnvironmentSpec& one, std::uint64_t own_seed) {
                           return make(one, own_seed, options);
                         });
}

using MakeSavedPolicy = std::unique_ptr<Policy> (*)(const Checkpoint&, const EnvironmentSpec&);

template <MakeSavedPolicy make>
std::unique_ptr<Policy> MakeEachPolicy(const Checkpoint& checkpoint, const EnvironmentSpec& spec) {
  return MakeIndependentPolicy(checkpoint, spec, make);
}

// Returns a text such as "one rescue squad decides" or "4 networked self-propelled devices decide".
std::string DescribeDeciders(std::int32_t ships, std::int32_t devices, bool networked) {
  const auto count = [](std::int32_t n, const std::string& one) {
    return n == 1 ? "one " + one : std::to_string(n) + " " + one + "s";
  };
  std::string text = ships > 0 ? count(ships, "rescue squad") : "";
  const std::string kind = networked ? "networked self-propelled device" : "self-propelled device";
  if (devices > 0) text += (text.empty() ? "" : " and ") + count(devices, kind);
  return text + (ships + devices == 1 ? " decides" : " decide");
}

std::vector<Algorithm> OwnAlgorithms() {
  return {
      {"random", "draws from all or from reachable actions; the baseline (§4.2)", false, 100000,
       RandomObservationTypes, Make<RandomLearner>, MakeRandomPolicy},
      {"q_learning", "tabular Q-learning (Eq. 12)", true, 4000000, WithCuriosityToo<Tabular>,
       MakeExplorer<Make<TabularLearner<QLearningRule>>>, MakeTabularPolicy},
      {"sarsa", "tabular SARSA (Eq. 14)", true, 8000000, WithCuriosityToo<Tabular>,
       MakeExplorer<Make<TabularLearner<SarsaRule>>>, MakeTabularPolicy},
      {"dqn", "deep Q-network on features or planes (Eq. 15)", true, 200000,
       WithCuriosityToo<DqnObservationTypes>, MakeExplorer<MakeDqn>, MakeDqnPolicy},
      {"lstm_dqn", "deep Q-network with a memory (Algorithm 2)", true, 150000,
       WithCuriosityToo<RecurrentDqnObservationTypes>, MakeExplorer<MakeRecurrentDqn>,
       MakeRecurrentDqnPolicy},
      {"independent_dqn", "a DQN for each agent", true, 400000,
       WithCuriosityToo<DqnObservationTypes>, MakeEach<MakeExplorer<MakeDqn>>,
       MakeEachPolicy<MakeDqnPolicy>},
      {"independent_lstm_dqn", "an LSTM-DQN for each agent", true, 400000,
       WithCuriosityToo<RecurrentDqnObservationTypes>, MakeEach<MakeExplorer<MakeRecurrentDqn>>,
       MakeEachPolicy<MakeRecurrentDqnPolicy>},
      {"vdn", "value decomposition: one DQN plays all agents, and their values are summed", true,
       400000, WithCuriosityToo<DqnObservationTypes>, MakeExplorer<MakeVdn>, MakeDqnPolicy},
      {"maddpg", "an actor for each agent, a critic that sees all of them (§3.3)", true, 800000,
       WithCuriosityToo<MaddpgObservationTypes>, MakeExplorer<MakeMaddpg>, MakeMaddpgPolicy},
      {"ppo", "proximal policy optimization: an actor-critic that learns from its own steps", true,
       2500000, WithCuriosityToo<PpoObservationTypes>, MakeExplorer<WithPlanner<MakePpo>>,
       MakePpoPolicy,
       /*default_farms=*/256, WithPlannerOfRanks<MakePpoOfRanks>,
       /*only_for_training=*/kStatesBit},  // for teacher_policy=planner
      {"mappo", "PPO for several agents: one policy, and a critic that sees all of them", true,
       10000000, WithCuriosityToo<MappoObservationTypes>, MakeExplorer<WithPlanner<MakeMappo>>,
       MakePpoPolicy,
       /*default_farms=*/256, WithPlannerOfRanks<MakeMappoOfRanks>,
       /*only_for_training=*/kStatesBit},
      {"planner",
       "plans on the issued forecast, or else on the present headings; several agents cooperate",
       false, 0, WithoutOptions<kStatesBit>, nullptr, MakePlannerPolicy<Foresight::kPersistence>},
      {"clairvoyant", "plans with the disasters' true future: for one ship the optimum", false, 0,
       WithoutOptions<kStatesBit>, nullptr, MakePlannerPolicy<Foresight::kOracle>},
      {"do_nothing", "every ship holds its cell; the reference for what a rescue saves", false, 0,
       WithoutOptions<0>, nullptr, MakeBuiltIn<DoNothingPolicy>},
      {"fetch_by_value", "each ship fetches the most valuable device that it can still bring home",
       false, 0, WithoutOptions<kStatesBit>, nullptr, MakeBuiltIn<FetchByValuePolicy>},
  };
}

// Returns the algorithms of this package, then the registered ones.
std::vector<Algorithm> AllAlgorithms() {
  std::vector<Algorithm> all = OwnAlgorithms();
  const char* const libraries = std::getenv(kLearnersVariable);
  for (const Algorithm& one : LoadLearners(libraries == nullptr ? "" : libraries)) {
    const auto has_its_name = [&one](const Algorithm& other) {
      return std::string_view(other.name) == one.name;
    };
    if (std::any_of(all.begin(), all.end(), has_its_name)) {
      throw InputError(std::string("learner ") + one.name +
                       ": got a name that another learner has, expected a name of its own");
    }
    all.push_back(one);
  }
  return all;
}

}  // namespace

const std::vector<Algorithm>& Algorithms() {
  static const std::vector<Algorithm> algorithms = AllAlgorithms();
  return algorithms;
}

const Algorithm& FindAlgorithm(const std::string& name) {
  std::vector<std::string> names;
  for (const Algorithm& algorithm : Algorithms()) {
    if (name == algorithm.name) return algorithm;
    names.emplace_back(algorithm.name);
  }
  throw InputError("algorithm: got '" + name + "'" + DidYouMean(name, names) +
                   ", expected one of: " + Join(names));
}

std::uint64_t DefaultSteps(const Algorithm& algorithm, const EnvironmentSpec& spec,
                           const std::string& options) {
  if ((algorithm.observation_types(options) & kIndexBit) == 0) return algorithm.default_steps;
  // Measured on a ranch with 17.9 million states: half as many steps are not enough
  // (docs/real_ranches.md).
  constexpr std::uint64_t kStepsPerState = 8;
  constexpr std::uint64_t kMillion = 1'000'000;
  const std::uint64_t enough = (kStepsPerState * spec.state_count / kMillion + 1) * kMillion;
  return std::max(algorithm.default_steps, enough);
}

std::string LargeTableNote(const Algorithm& algorithm, const EnvironmentSpec& spec,
                           const std::string& options) {
  constexpr std::uint64_t kMegabyte = 1'000'000;
  constexpr std::uint64_t kLarge = 256 * kMegabyte;
  if ((algorithm.observation_types(options) & kIndexBit) == 0) return "";
  const std::uint64_t bytes = QTable::BytesOf(spec);
  if (bytes < kLarge) return "";
  return std::string("algorithm ") + algorithm.name + ": the table of " +
         std::to_string(spec.state_count) + " states needs " + std::to_string(bytes / kMegabyte) +
         " MB of memory, and each checkpoint as much on disk; algorithm:=auto chooses a network, "
         "which needs a few MB";
}

Choice ChooseAlgorithm(const EnvironmentSpec& spec) {
  const Scenario scenario = ParseScenario(spec.scenario_yaml, spec.scenario_name);
  const std::int32_t squads = scenario.ships.count;
  const std::int32_t devices = spec.agents - squads;
  const bool networked = devices > 0 && scenario.view.shared_sight;
  const std::string deciders = DescribeDeciders(squads, devices, networked);
  if (spec.agents == 1) return {"lstm_dqn", deciders + ", so a single-agent learner"};
  if (squads > 1 || networked) {
    return {"vdn", deciders + " and need coordination, so a multi-agent learner"};
  }
  return {"independent_dqn", deciders + ", so a single-agent learner for each"};
}

}  // namespace aquafarm::agents
