// SPDX-License-Identifier: BSD-3-Clause
// This client is compiled with AVX instructions, and the library is compiled without them. With
// AVX, Eigen would align memory to 32 bytes. The client and the library share Eigen members, so
// both must allocate memory in the same way.
#include <gtest/gtest.h>

#include <memory>

#include "aquafarm/farm/farm.h"
#include "aquafarm/farm/layout.h"
#include "aquafarm/observation/farm_batch.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

class ClientFlags : public ::testing::Test {
 protected:
  void SetUp() override {
#if defined(__x86_64__)
    if (!__builtin_cpu_supports("avx")) GTEST_SKIP() << "this processor has no AVX";
#endif
  }
};

TEST_F(ClientFlags, AlignMemoryAsTheLibraryDoes) {
#if defined(__AVX__)
  EXPECT_EQ(EIGEN_MAX_ALIGN_BYTES, 16);
#else
  GTEST_SKIP() << "not compiled with AVX";
#endif
}

TEST_F(ClientFlags, LayoutsOfTheLibraryAreFreedByTheClient) {
  const Scenario scenario = test::CrowdedScenario(2);
  for (std::uint64_t episode = 0; episode < 50; ++episode) {
    const auto generator = std::make_unique<LayoutGenerator>(scenario);
    const auto layout = std::make_unique<Layout>();
    generator->Generate(7, episode, *layout);
    const Layout copy = *layout;  // allocated by the client
    EXPECT_EQ(copy.cells.rows(), scenario.height);
  }
}

TEST_F(ClientFlags, ClientsLayoutsAreResizedByTheLibrary) {
  const Scenario small = test::TinyScenario();
  const Scenario large = test::CrowdedScenario(1);
  Layout layout;
  layout.cells.resize(3, 3);  // allocated by the client
  layout.crash_reward.resize(3, 3);
  layout.obstacle.resize(3, 3);
  for (std::uint64_t episode = 0; episode < 20; ++episode) {
    LayoutGenerator(small).Generate(1, episode, layout);
    LayoutGenerator(large).Generate(1, episode, layout);
  }
  EXPECT_EQ(layout.cells.cols(), large.width);
}

TEST_F(ClientFlags, BatchesAndFarmsAreMadeAndFreedByTheClient) {
  const auto scenario = std::make_shared<const Scenario>(test::CrowdedScenario(2));
  FarmBatch batch(scenario, 3);
  batch.Reset(5, 0, {});
  Farm farm(scenario);
  farm.Load(batch.farm(0).Save());
  EXPECT_EQ(farm.Hash(), batch.farm(0).Hash());
}

}  // namespace
}  // namespace aquafarm
