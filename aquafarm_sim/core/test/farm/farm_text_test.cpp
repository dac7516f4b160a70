// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/farm_text.h"

#include <gtest/gtest.h>

#include "aquafarm/scenario/validate.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

TEST(FarmText, ShowsShipsDevicesChartAndRisk) {
  Scenario scenario = test::TinyScenario();
  scenario.devices.sites.push_back({{4, 0}, DeviceKind::kMonitoring, 50.0F, false});
  DisasterSpec storm;
  storm.radii = {1.0F};
  storm.risks = {-5.0F};
  storm.start = {{4.0F, 4.0F}};
  storm.speed = 0.0F;
  storm.duration = 100;
  scenario.disasters = {storm};
  ValidateScenario(scenario);
  Farm farm(std::make_shared<const Scenario>(scenario));
  farm.PlaceShip(0, {0, 4});
  EXPECT_EQ(RenderText(farm),
            "tiny  step 0 of 5000  return 0.0  delivered 0 of 2\n"
            "0..~~\n"
            "...o~\n"
            "..d..\n"
            "##...\n"
            "##P.d\n");
}

TEST(FarmText, SaysWhyTheEpisodeEnded) {
  Scenario scenario = test::TinyScenario();
  scenario.step_limit = 1;
  ValidateScenario(scenario);
  Farm farm(std::make_shared<const Scenario>(scenario));
  const std::uint8_t hold = test::Act(Action::kHold);
  farm.Step(&hold);
  const std::string text = RenderText(farm);
  EXPECT_NE(text.find("step 1 of 1  return "), std::string::npos) << text;
  EXPECT_NE(text.find("  ended: " + std::string(ToString(EndReason::kStepLimit)) + "\n"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace aquafarm
