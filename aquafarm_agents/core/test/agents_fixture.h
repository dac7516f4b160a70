// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "tiny_farms.h"

namespace aquafarm::agents::test {

inline std::shared_ptr<const Scenario> Share(Scenario scenario) {
  // Parsed from its text like a file, so that the hash is that of the text.
  return std::make_shared<const Scenario>(ParseScenario(ToYaml(scenario), scenario.name));
}

/// One device two steps from a port, with a step limit that RANDOM rarely meets.
inline std::shared_ptr<const Scenario> TinyFarm(std::int32_t step_limit = 60) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.step_limit = step_limit;
  return Share(scenario);
}

inline std::shared_ptr<const Scenario> Paper() {
  return std::make_shared<const Scenario>(
      LoadScenario(std::string(AQUAFARM_SCENARIO_DIR) + "/paper.yaml"));
}

/// Provides a temporary folder, removed at the end of each test.
class FolderTest : public ::testing::Test {
 protected:
  FolderTest() {
    char name[] = "/tmp/aquafarm_agents_XXXXXX";
    folder_ = mkdtemp(name);
  }
  ~FolderTest() override { std::filesystem::remove_all(folder_); }
  std::string folder_;
};

/// Message of the exception that `act` throws; empty if it does not throw.
template <typename Exception, typename Act>
std::string MessageOf(Act&& act) {
  try {
    act();
  } catch (const Exception& error) {
    return error.what();
  }
  return "";
}

#define EXPECT_CONTAINS(text, words) \
  EXPECT_NE(std::string(text).find(words), std::string::npos) << "got: " << (text)

}  // namespace aquafarm::agents::test
