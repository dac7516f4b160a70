// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/python_policy.h"

#include <sys/types.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <numeric>

#include "agents_fixture.h"
#include "aquafarm/agents/training/saved_policy.h"

namespace aquafarm::agents::test {
namespace {

class PythonPolicies : public FolderTest {
 protected:
  PythonPolicies() { setenv("AQUAFARM_PYTHON", "/usr/bin/python3", 1); }

  std::string Write(const std::string& text) const {
    const std::string path = folder_ + "/mine.py";
    std::ofstream(path) << text;
    return path;
  }
  std::string Refusal(const std::string& where) const {
    return MessageOf<InputError>([&] { FindPolicy(where); });
  }
};

// Actions of the function in ten steps must equal those of `expected`.
template <typename Expected>
void ExpectSame(const std::string& where, std::uint8_t kind, const Expected& expected) {
  const SavedPolicy saved = FindPolicy(where);
  ASSERT_EQ(saved.observation_types, kind);
  LocalEnvironment environment(TinyFarm(), {3, saved.observation_types, false, 1});
  const auto policy = MakePolicy(saved, environment.spec());
  const StepResults* results = &environment.Reset(5);
  std::vector<std::uint8_t> actions;
  for (int step = 0; step < 10; ++step) {
    policy->Act(*results, actions);
    ASSERT_EQ(actions.size(), 3U);
    for (std::size_t i = 0; i < actions.size(); ++i) {
      ASSERT_EQ(actions[i], expected(*results, i, environment.spec())) << "step " << step;
    }
    results = &environment.Step(actions);
  }
}

TEST_F(PythonPolicies, AFunctionReceivesTheIndex) {
  const std::string path = Write(
      "OBSERVATION = 'index'\n"
      "def act(observations, masks):\n"
      "    return observations % 10\n");
  ExpectSame(path, kIndexBit,
             [](const StepResults& results, std::size_t i, const EnvironmentSpec&) {
               return results.index[i] % 10;
             });
}

TEST_F(PythonPolicies, AFunctionReceivesTheFeatures) {
  const std::string path = Write(
      "def best(observations, masks):\n"
      "    return observations.argmax(axis=1) % 10\n");
  ExpectSame(path + ":best", kFeaturesBit,
             [](const StepResults& results, std::size_t i, const EnvironmentSpec& spec) {
               const auto begin =
                   results.features.begin() + static_cast<std::ptrdiff_t>(i) * spec.feature_count;
               return (std::max_element(begin, begin + spec.feature_count) - begin) % 10;
             });
}

TEST_F(PythonPolicies, AFunctionReceivesPlanesAndMasks) {
  const std::string path = Write(
      "OBSERVATION = 'planes'\n"
      "def act(observations, masks):\n"
      "    assert observations.ndim == 4\n"
      "    return (observations.sum(axis=(1, 2, 3), dtype=int) + masks.sum(axis=1)) % 10\n");
  ExpectSame(path, kPlanesBit,
             [](const StepResults& results, std::size_t i, const EnvironmentSpec& spec) {
               const std::ptrdiff_t size =
                   static_cast<std::ptrdiff_t>(spec.plane_count) * spec.height * spec.width;
               const auto begin = results.planes.begin() + static_cast<std::ptrdiff_t>(i) * size;
               const int legal = __builtin_popcount(results.legal[i] & 0x3ffU);
               return std::accumulate(begin, begin + size, legal) % 10;
             });
}

TEST_F(PythonPolicies, WhatCannotBePlayedIsNamedInOneLine) {
  EXPECT_EQ(Refusal("/none/mine.py"),
            "policy /none/mine.py: got no file /none/mine.py, expected a Python file with "
            "act(observations, masks)");
  const auto refusal_of = [this](const std::string& text) {
    const std::string path = Write(text);
    const std::string words = Refusal(path);
    const std::string start = "policy " + path + ": ";
    return words.substr(0, start.size()) == start ? words.substr(start.size()) : words;
  };
  EXPECT_EQ(refusal_of("def play():\n    pass\n"),
            "has no function act, expected act(observations, masks)");
  EXPECT_EQ(refusal_of("import no_such_package\n"),
            "ModuleNotFoundError: No module named 'no_such_package'");
  EXPECT_EQ(refusal_of("OBSERVATION = 'smell'\ndef act(o, m):\n    pass\n"),
            "OBSERVATION: got 'smell', expected one of: features, planes, index");
  EXPECT_EQ(refusal_of("import os\nos._exit(4)\n"),
            "its Python process has ended, its last lines are above; AQUAFARM_PYTHON selects a "
            "Python");
  EXPECT_CONTAINS(Refusal("/none/model.zip"), "is not a model of Stable-Baselines3");
  setenv("AQUAFARM_PYTHON", "/none/python3", 1);
  EXPECT_EQ(Refusal("mine.py"),
            "policy mine.py: cannot start /none/python3: No such file or directory; set "
            "AQUAFARM_PYTHON to a Python");
}

TEST_F(PythonPolicies, AFunctionThatFailsIsNamedInOneLine) {
  const auto words = [this](const std::string& body) {
    const SavedPolicy saved = FindPolicy(Write("def act(observations, masks):\n    " + body));
    LocalEnvironment environment(TinyFarm(), {2, saved.observation_types, false, 1});
    const auto policy = MakePolicy(saved, environment.spec());
    std::vector<std::uint8_t> actions;
    return MessageOf<InputError>([&] { policy->Act(environment.Reset(1), actions); });
  };
  EXPECT_CONTAINS(words("return 1 / 0"), ": ZeroDivisionError: division by zero");
  EXPECT_CONTAINS(words("return [1.5, 2]"),
                  "act: got float64 of shape (2,), expected integers of shape (2,)");
  EXPECT_CONTAINS(words("return [10, 0]"), "act: got actions in [0, 10], expected [0, 9]");
}

// Starts the policy of a file and lets it act twice on the same farms.
class TwoActs {
 public:
  explicit TwoActs(const std::string& where, int limit_s = PolicyProcess::kAnswerLimit_s)
      : process_(where, limit_s),
        environment_(TinyFarm(), {2, process_.observation_types(), false, 1}) {
    const StepResults& results = environment_.Reset(1);
    for (std::string& words : words_) {
      words = MessageOf<InputError>([&] { process_.Act(environment_.spec(), results, actions_); });
    }
  }
  const std::string& first() const { return words_[0]; }
  const std::string& second() const { return words_[1]; }
  const std::vector<std::uint8_t>& actions() const { return actions_; }

 private:
  PolicyProcess process_;
  LocalEnvironment environment_;
  std::vector<std::uint8_t> actions_;
  std::array<std::string, 2> words_;
};

TEST_F(PythonPolicies, ALongErrorIsCutBetweenCharactersAndTheNextAnswerFollowsIt) {
  const std::string path = Write(
      "calls = []\n"
      "def act(observations, masks):\n"
      "    calls.append(1)\n"
      "    if len(calls) == 1:\n"
      "        raise ValueError(1400 * '\\u6d77')\n"
      "    return [7, 8]\n");
  std::string words = "policy " + path + ": ValueError: ";
  for (int i = 0; i < (4000 - 12) / 3; ++i) words += "\u6d77";
  const TwoActs acts(path);
  EXPECT_EQ(acts.first(), words);
  EXPECT_EQ(acts.second(), "");
  EXPECT_EQ(acts.actions(), (std::vector<std::uint8_t>{7, 8}));
}

TEST_F(PythonPolicies, AProcessThatDoesNotReadIsNamedInTime) {
  const std::string id = folder_ + "/id";
  const std::string path = Write(
      "import os\n"
      "OBSERVATION = 'planes'\n"
      "open('" +
      id +
      "', 'w').write(str(os.getpid()))\n"
      "def act(observations, masks):\n"
      "    return [9] * len(masks)\n");
  const auto process = std::make_shared<PolicyProcess>(path, 1);
  pid_t number = 0;
  std::ifstream(id) >> number;
  ASSERT_GT(number, 1);
  ASSERT_EQ(0, kill(number, SIGSTOP));
  // More observations than the socket keeps.
  LocalEnvironment environment(TinyFarm(), {8192, process->observation_types(), false, 1});
  const auto policy = MakePythonPolicy(process, environment.spec());
  const StepResults& results = environment.Reset(1);
  ASSERT_GT(results.planes.size(), 1U << 20U);
  std::vector<std::uint8_t> actions;
  EXPECT_EQ(MessageOf<InputError>([&] { policy->Act(results, actions); }),
            "policy " + path +
                ": got no answer within 1 s, expected its actions: make act faster, or play fewer "
                "farms at a time");
}

TEST_F(PythonPolicies, AfterNoAnswerInTimeALateAnswerIsNeverRead) {
  const std::string path = Write(
      "import time\n"
      "def act(observations, masks):\n"
      "    time.sleep(2)\n"
      "    return [7, 8]\n");
  const TwoActs acts(path, 1);
  EXPECT_EQ(acts.first(), "policy " + path +
                              ": got no answer within 1 s, expected its actions: make act faster, "
                              "or play fewer farms at a time");
  EXPECT_EQ(acts.second(), acts.first());
  EXPECT_TRUE(acts.actions().empty());
}

TEST_F(PythonPolicies, AfterAnAnswerThatCannotBeReadLaterCallsThrowTheSameLine) {
  const std::string path = Write(
      "import os\n"
      "def act(observations, masks):\n"
      "    os.write(3, (5000).to_bytes(4, 'little'))\n"
      "    return [7, 8]\n");
  const TwoActs acts(path);
  EXPECT_EQ(acts.first(), "policy " + path +
                              ": got an error of 5000 bytes, expected at most 4096: build again, "
                              "so that serve_policy.py fits this program");
  EXPECT_EQ(acts.second(), acts.first());
}

TEST_F(PythonPolicies, AProcessThatHasEndedIsNamedByEachCall) {
  const std::string path = Write(
      "import os\n"
      "def act(observations, masks):\n"
      "    os._exit(4)\n");
  const TwoActs acts(path);
  EXPECT_CONTAINS(acts.first(), ": its Python process has ended");
  EXPECT_EQ(acts.second(), acts.first());
}

}  // namespace
}  // namespace aquafarm::agents::test
