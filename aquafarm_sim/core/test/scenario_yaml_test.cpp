// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/scenario_yaml.h"

#include <gtest/gtest.h>

#include <iostream>
TEST(A, B) {
  auto s = aquafarm::LoadScenario(AQUAFARM_CORE_DIR "/../scenarios/paper.yaml");
  std::cout << aquafarm::ToYaml(s) << s.hash << "\n";
  auto t = aquafarm::ParseScenario(aquafarm::ToYaml(s), "again");
  EXPECT_EQ(t.hash, s.hash);
}
