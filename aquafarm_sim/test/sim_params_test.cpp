// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/node/sim_params.h"

#include <gtest/gtest.h>

#include "aquafarm/base/check.h"

namespace aquafarm_sim {
namespace {

const std::string kData = AQUAFARM_SIM_TEST_DATA;

TEST(SimParams, AScenarioIsFoundByNameOrPath) {
  EXPECT_EQ(kData + "/lone.yaml", ResolveScenario("lone", kData));
  EXPECT_EQ(kData + "/lone.yaml", ResolveScenario(kData + "/lone.yaml", "/nowhere"));
}

TEST(SimParams, AnUnknownScenarioIsAnsweredWithThoseThereAre) {
  try {
    ResolveScenario("papr", kData);
    FAIL() << "accepted";
  } catch (const aquafarm::InputError& error) {
    EXPECT_STREQ("scenario: got 'papr', expected the path of a file or one of lone, pair",
                 error.what());
  }
}

TEST(SimParams, AnotherPathThanAFileIsRefused) {
  EXPECT_THROW(ResolveScenario(kData, kData), aquafarm::InputError);
  EXPECT_THROW(ResolveScenario("./gone.yaml", kData), aquafarm::InputError);
}

}  // namespace
}  // namespace aquafarm_sim
