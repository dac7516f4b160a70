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

/// Returns the scenario as if it were read from a file, with the hash of its text.
inline std::shared_ptr<const Scenario> Share(Scenario scenario) {
  return std::make_shared<const Scenario>(ParseScenario(ToYaml(scenario), scenario.name));
}

/// Returns a farm of 5 × 5 cells with one device, two moves from the port. RANDOM rarely delivers
/// the device within the default step limit.
inline std::shared_ptr<const Scenario> TinyFarm(std::int32_t step_limit = 60) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.step_limit = step_limit;
  return Share(scenario);
}

/// Returns the scenario of the paper.
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

/// Returns the message of the `Exception` that `act` throws; empty if it throws nothing.
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
