// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/planning/planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "agents_fixture.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/agents/planning/team_bound.h"
#include "aquafarm/agents/training/saved_policy.h"
#include "aquafarm/base/check.h"
#include "aquafarm/farm/forecast.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm/scenario/validate.h"
#include "planning/brute_force.h"

namespace aquafarm::agents {
namespace {

using test::BruteForce;
using test::ExpectBruteForce;
using test::Play;
using test::TinyScenario;

TEST(Clairvoyant, EqualsBruteForceOnTinyFarms) {
  for (const std::int32_t duration : {3, 7, 11}) {
    for (const float exposure : {0.0F, 0.02F, 0.1F}) {
      for (std::uint64_t episode = 0; episode < 3; ++episode) {
        const std::int32_t capacity = episode == 2 ? 2 : 1;
        const auto scenario =
            std::make_shared<const Scenario>(TinyScenario(duration, exposure, capacity));
        Farm farm(scenario);
        farm.Reset(5, episode);
        std::map<std::string, double> seen;
        const double expected = BruteForce(farm, seen);
        Planner planner(*scenario);
        const Plan plan = planner.Solve(farm, Foresight::kOracle);
        const std::string where = "duration " + std::to_string(duration) + " exposure " +
                                  std::to_string(exposure) + " episode " + std::to_string(episode);
        EXPECT_NEAR(plan.expected_return, expected, 1e-3) << where;
        EXPECT_NEAR(Play(farm, plan), expected, 1e-3) << where;
      }
    }
  }
}

TEST(Clairvoyant, EqualsBruteForceWithQuadrantsAndARiskySea) {
  Scenario lopsided = TinyScenario(9, 0.02F, 1);
  DisasterSpec& storm = lopsided.disasters[0];
  storm.quadrants = {{0.8F, 0.0F, 0.5F, 0.8F}, {3.0F, 0.5F, 1.7F, 1.0F}};
  storm.radii = {0.8F, 3.0F};
  lopsided.seas = SeaSpec{{}, std::vector<float>(12, 0.0F), {}};
  lopsided.seas->risk[9] = -6.0F;  // position of a waiting device, (1, 2)
  lopsided.seas->risk[5] = -15.0F;
  ExpectBruteForce(lopsided, 6);
}

// A risk replaces the step reward, so ships pass through risks that are milder than a step.
TEST(Clairvoyant, EqualsBruteForceWhereAStepCostsMoreThanARisk) {
  for (const float step : {-10.0F, -19.0F}) {
    SCOPED_TRACE(step);
    Scenario dear = TinyScenario(9, 0.0F, 1);
    dear.rewards.step = step;
    dear.seas = SeaSpec{{}, std::vector<float>(12, -5.0F), {}};
    ExpectBruteForce(dear, 4);
  }
}

// Diagonals, loads, rough sea and waiting have prices of the order of the other rewards.
TEST(Clairvoyant, EqualsBruteForceWithEnergy) {
  const EnergyFigures light{0.7, 0.5, 1.0, 0.2};
  for (const double weight : {0.3, 2.0, 12.0}) {
    for (const std::int32_t capacity : {1, 2}) {
      SCOPED_TRACE(std::to_string(weight) + " capacity " + std::to_string(capacity));
      Scenario scenario = TinyScenario(9, 0.02F, capacity);
      scenario.energy = EnergySpec{weight, {1.0, 0.8, 0.6, 0.1}, light};
      ExpectBruteForce(scenario, 2);
      scenario.cell_size_m = 250.0;
      scenario.energy->ships = light;
      ExpectBruteForce(scenario, 1);
    }
  }
}

TEST(Clairvoyant, PrefersTheShorterOfTwoWaysWithEqualMoves) {
  Scenario scenario = TinyScenario(40, 0.0F, 1);
  scenario.islands.clear();
  scenario.rocks.cells = {{0, 2}};
  scenario.ports.cells = {{0, 0}};
  scenario.devices.sites = {{{3, 0}, DeviceKind::kMonitoring, 60.0F, false}};
  scenario.disasters.clear();
  scenario.step_limit = 40;
  scenario.energy = EnergySpec{0.01, {1.0, 0.0, 0.0, 0.0}, {}};
  const auto shared = test::Share(scenario);
  Farm farm(shared);
  farm.Reset(1, 0);
  Planner planner(*shared);
  Play(farm, planner.Solve(farm, Foresight::kOracle));
  EXPECT_EQ(farm.reason(), EndReason::kAllRetrieved);
  EXPECT_EQ(farm.record().steps, 8);
  EXPECT_DOUBLE_EQ(farm.record().distance, 6.0);  // any diagonal would be longer
}

// A self-propelled device waits next to a rock until the storm has left its port. A step costs 9.
Scenario WaitingScenario(float illegal, float rock) {
  Scenario scenario = TinyScenario(5, 0.0F, 1);
  scenario.ships.count = 0;
  scenario.devices.sites = {{{3, 2}, DeviceKind::kMonitoring, 60.0F, true}};
  scenario.damage.crash_probability = 0.0F;
  scenario.rewards.step = -9.0F;
  scenario.rewards.illegal = illegal;
  scenario.rocks.reward = {rock, rock};
  DisasterSpec over_port = aquafarm::test::StillDisaster(1.0F, 0.0F, {0.5F}, {-20.0F});
  over_port.duration = 5;
  DisasterSpec elsewhere = aquafarm::test::StillDisaster(0.0F, 2.0F, {0.5F}, {-5.0F});
  elsewhere.duration = 12;
  scenario.disasters = {over_port, elsewhere};
  return scenario;
}

// A crash or an illegal action replaces the step reward, even if its own reward is 0
// (Farm::Reward).
TEST(Clairvoyant, EqualsBruteForceWhereAnIllegalActionOrACrashIsFree) {
  ExpectBruteForce(WaitingScenario(0.0F, -5.0F), 1);
  ExpectBruteForce(WaitingScenario(-10.0F, 0.0F), 1);
  Scenario lenient = TinyScenario(6, 0.0F, 1);
  lenient.rewards.illegal = 0.0F;
  ExpectBruteForce(lenient, 3);
}

TEST(Clairvoyant, EqualsBruteForceWithTheEnergyOfASelfPropelledDevice) {
  Scenario scenario = WaitingScenario(-10.0F, -5.0F);
  scenario.energy = EnergySpec{2.0, {50.0, 0.0, 0.0, 0.0}, {1.0, 0.0, 0.6, 0.5}};
  ExpectBruteForce(scenario, 1);
}

TEST(TeamBound, HoldsWhereWaitingOnTheWayIsCheaperThanAStep) {
  for (const auto& [illegal, rock] : {std::pair{-10.0F, -1.0F}, std::pair{-0.5F, -5.0F}}) {
    SCOPED_TRACE(std::to_string(illegal) + " and " + std::to_string(rock));
    ExpectBruteForce(WaitingScenario(illegal, rock), 1);
  }
}

TEST(Planner, RefusesAScenarioThatPaysForWaiting) {
  Scenario generous = TinyScenario(9, 0.0F, 1);
  generous.rewards.illegal = 1.0F;
  EXPECT_EQ(test::MessageOf<InputError>([&] { Planner{generous}; }),
            "planner: rewards.illegal: got more than 0, expected at most 0, because a ship "
            "could earn it again and again; evaluate a learner instead");
}

TEST(Foresight, IsTheTrackOrTheForecastOrTheHeading) {
  Scenario tracked = TinyScenario(40, 0.0F, 1);
  DisasterSpec& storm = tracked.disasters[0];
  storm.track = {{0, -8, 1, 3, storm.radii, storm.risks, {}},
                 {20, 2, 1, 3, storm.radii, storm.risks, {}},
                 {40, 2, 9, 3, storm.radii, storm.risks, {}}};
  tracked.step_duration_s = 3600.0;
  tracked.view.forecast_error_km = {5.0F, 9.0F, 14.0F};
  const auto place = [](const Scenario& scenario, Foresight foresight) {
    Farm farm(std::make_shared<const Scenario>(scenario));
    farm.Reset(5, 1);
    std::vector<Disaster> disasters = farm.disasters();
    const std::vector<Track> tracks = Foresee(farm, foresight, disasters);
    for (std::int32_t step = 1; step <= 30; ++step) {
      MoveDisaster(disasters[0], tracks[0], {}, step, 4, 3);
    }
    return std::array<float, 2>{disasters[0].x, disasters[0].y};
  };
  EXPECT_EQ(place(tracked, Foresight::kOracle), (std::array<float, 2>{2.0F, 5.0F}));
  Farm farm(std::make_shared<const Scenario>(tracked));
  farm.Reset(5, 1);
  const auto forecast = ForecastAt(farm, 0, 0, 30);
  const auto told = place(tracked, Foresight::kPersistence);
  EXPECT_NEAR(told[0], forecast[0], 1e-3F);
  EXPECT_NEAR(told[1], forecast[1], 1e-3F);
  EXPECT_NE(told, (std::array<float, 2>{2.0F, 5.0F}));
  tracked.view.forecast_error_km.clear();
  const auto straight = place(tracked, Foresight::kPersistence);
  EXPECT_NEAR(straight[0], 7.0F, 1e-3F) << "on as it moves now";
  EXPECT_NEAR(straight[1], 1.0F, 1e-3F);
  tracked.disasters[0].forecasts = {{0.0F, {{20.0F, 9.0F, 8.0F}}}};
  const auto said = place(tracked, Foresight::kPersistence);
  // Where the authority said for step 20, then onward as it moves now, half a cell in each step.
  EXPECT_NEAR(said[0], 9.0F + 10.0F * 0.5F, 1e-3F);
  EXPECT_NEAR(said[1], 8.0F, 1e-3F);
  EXPECT_EQ(place(tracked, Foresight::kOracle), (std::array<float, 2>{2.0F, 5.0F}));
}

// A storm that stays away, and a forecast that puts it on the ship's way to the only device.
TEST(Foresight, MovingOneForecastPointChangesThePlanAndNotTheTruth) {
  Scenario open;
  open.name = "open";
  open.width = 7;
  open.height = 7;
  open.rocks.count = {0, 0};
  open.ports.cells = {{0, 3}};
  open.devices.placement = DevicePlacement::kExplicit;
  open.devices.sites = {{{6, 3}, DeviceKind::kMonitoring, 60.0F, false}};
  open.step_limit = 40;
  DisasterSpec storm;
  storm.radii = {2.5F};
  storm.risks = {-20.0F};
  storm.duration = 40;
  storm.track = {{0.0F, 3.0F, 30.0F, 3, storm.radii, storm.risks},
                 {40.0F, 3.0F, 31.0F, 3, storm.radii, storm.risks}};
  open.disasters = {storm};
  ValidateScenario(open);
  const auto scenario = std::make_shared<const Scenario>(open);
  Farm away(scenario);
  Farm near(scenario);
  away.IssueForecast(0, {0.0F, {{2.0F, 3.0F, 20.0F}, {40.0F, 3.0F, 20.0F}}});
  near.IssueForecast(0, {0.0F, {{2.0F, 3.0F, 3.0F}, {40.0F, 3.0F, 3.0F}}});
  Planner planner(*scenario);
  const Plan calm = planner.Solve(away, Foresight::kPersistence);
  const Plan wary = planner.Solve(near, Foresight::kPersistence);
  EXPECT_NE(calm.actions, wary.actions);
  EXPECT_LT(wary.expected_return, calm.expected_return);
  EXPECT_EQ(planner.Solve(away, Foresight::kOracle).actions,
            planner.Solve(near, Foresight::kOracle).actions);
  // The plan goes round the forecast rings: the ship is in them at no step.
  std::vector<Disaster> told = near.disasters();
  const std::vector<Track> tracks = Foresee(near, Foresight::kPersistence, told);
  for (const std::uint8_t action : wary.actions) {
    near.Step(&action);
    MoveDisaster(told[0], tracks[0], {}, near.step(), 7, 7);
    EXPECT_EQ(RiskAt(told, near.ships()[0].cell), 0.0F) << "step " << near.step();
    EXPECT_NEAR(near.disasters()[0].y, 30.0F + static_cast<float>(near.step()) / 40.0F, 1e-4);
  }
  EXPECT_TRUE(near.record().Success());
}

TEST(Clairvoyant, ContinuesFromTheMiddleOfAnEpisode) {
  const auto scenario = std::make_shared<const Scenario>(TinyScenario(9, 0.02F, 1));
  Planner planner(*scenario);
  Farm farm(scenario);
  farm.Reset(1, 0);
  double last = 1e9;
  while (!farm.over()) {
    std::map<std::string, double> seen;
    const Plan plan = planner.Solve(farm, Foresight::kOracle);
    EXPECT_NEAR(plan.expected_return, BruteForce(farm, seen), 1e-3) << "step " << farm.step();
    // Along the plan, the remaining return equals the expected one.
    if (last < 1e8) {
      EXPECT_NEAR(plan.expected_return, last, 1e-3);
    }
    farm.Step(&plan.actions.at(0));
    last = plan.expected_return - static_cast<double>(farm.ships()[0].reward);
  }
  EXPECT_NEAR(last, 0.0, 1e-3);
}

// Returns the layers of a farm's future: the risks, and the reward of a quiet step.
std::vector<RiskLayers> FutureOf(const Farm& farm) {
  DisasterRisk risks(farm, Foresight::kOracle);
  std::vector<RiskLayers> layers;
  for (std::int32_t step = farm.step() + 1; step <= risks.last_step(); ++step) {
    layers.push_back(risks.At(step));
  }
  return layers;
}

// Farms of one layout with different storms, as members of an ensemble.
std::vector<Farm> Members(const std::shared_ptr<const Scenario>& scenario, std::uint64_t count) {
  std::vector<Farm> members;
  for (std::uint64_t episode = 0; episode < count; ++episode) {
    members.emplace_back(scenario);
    members.back().Reset(5, episode);
  }
  return members;
}

// Returns the max mean return of one fixed action sequence over all members, by trying every one.
double BruteForceMean(const std::vector<Farm>& members, std::map<std::string, double>& seen) {
  if (members[0].over()) return 0.0;
  std::string name;
  for (const Farm& farm : members) {
    const Ship& ship = farm.ships()[0];
    name += std::to_string(farm.step()) + ' ' + std::to_string(ship.cell.x) + ' ' +
            std::to_string(ship.cell.y);
    for (const Device& device : farm.devices()) {
      name += ' ' + std::to_string(static_cast<int>(device.status)) + ' ' +
              std::to_string(device.health);
    }
  }
  const auto found = seen.find(name);
  if (found != seen.end()) return found->second;
  double best = -1e9;
  for (std::uint8_t action = 0; action < kActionCount; ++action) {
    std::vector<Farm> next;
    double reward = 0.0;
    for (const Farm& farm : members) {
      next.emplace_back(std::make_shared<const Scenario>(farm.scenario()), farm.shared_layout());
      next.back().Load(farm.Save());
      next.back().Step(&action);
      reward += static_cast<double>(next.back().ships()[0].reward);
    }
    best = std::max(best, reward / static_cast<double>(next.size()) + BruteForceMean(next, seen));
  }
  seen[name] = best;
  return best;
}

// No other fixed sequence of actions has a better mean return over the members.
TEST(RiskField, OfTheMeanGivesTheBestFixedPlanOfAnEnsemble) {
  for (const float exposure : {0.0F, 0.002F}) {  // too weak to clamp health at 0
    Scenario tiny = TinyScenario(7, exposure, 1);
    tiny.damage.crash_probability = 1.0F;  // all members crash alike
    const auto scenario = std::make_shared<const Scenario>(tiny);
    std::vector<Farm> members = Members(scenario, 3);
    // All members start alike: the start port of an episode is drawn, but this farm has one port.
    std::vector<RiskLayers> mean = FutureOf(members[0]);
    for (std::size_t i = 1; i < members.size(); ++i) {
      const std::vector<RiskLayers> more = FutureOf(members[i]);
      for (std::size_t k = 0; k < mean.size(); ++k) {
        mean[k].risk += more[k].risk;
        mean[k].quiet += more[k].quiet;
      }
    }
    const auto count = static_cast<float>(members.size());
    for (RiskLayers& layers : mean) {
      layers.risk /= count;
      layers.quiet /= count;
    }
    RiskField field(1, mean);
    Planner planner(*scenario);
    Task task;
    task.devices = {0, 1};
    const Plan plan = planner.Solve(members[0], field, task);
    std::map<std::string, double> seen;
    EXPECT_NEAR(plan.expected_return, BruteForceMean(members, seen), 1e-3) << exposure;
    double played = 0.0;
    for (Farm& farm : members) played += Play(farm, plan) / static_cast<double>(members.size());
    EXPECT_NEAR(plan.expected_return, played, 1e-3) << exposure;
  }
}

TEST(DisasterRisk, IsTheRiskOfTheFarmInAnyOrderOfSteps) {
  const auto scenario = std::make_shared<const Scenario>(TinyScenario(30, 0.0F, 1));
  Farm farm(scenario);
  farm.Reset(5, 2);
  DisasterRisk risks(farm, Foresight::kOracle);
  EXPECT_EQ(risks.last_step(), 30);
  std::vector<RiskLayers> layers;
  for (std::int32_t step = 1; step <= 30; ++step) layers.push_back(risks.At(step));
  for (std::int32_t step = 30; step >= 1; --step) {
    const auto k = static_cast<std::size_t>(step - 1);
    EXPECT_TRUE((risks.At(step).risk == layers[k].risk).all()) << step;
    EXPECT_TRUE((risks.At(step).quiet == layers[k].quiet).all()) << step;
  }
  Farm played(scenario);
  played.Reset(5, 2);
  constexpr auto kHold = static_cast<std::uint8_t>(Action::kHold);
  for (std::int32_t step = 1; step <= 20; ++step) {
    played.Step(&kHold);
    for (std::int32_t i = 0; i < scenario->CellCount(); ++i) {
      const float risk = played.RiskAt({i % 4, i / 4});
      const RiskLayers& one = layers[static_cast<std::size_t>(step - 1)];
      EXPECT_EQ(one.risk.data()[i], risk);
      EXPECT_EQ(one.quiet.data()[i], risk < 0.0F ? risk : scenario->rewards.step);
    }
  }
}

TEST(Clairvoyant, BringsEverythingHomeOnThePapersFarm) {
  const auto scenario =
      std::make_shared<const Scenario>(LoadScenario(AQUAFARM_SCENARIO_DIR "/paper.yaml"));
  Planner planner(*scenario);
  Farm farm(scenario);
  for (std::uint64_t episode = 0; episode < 20; ++episode) {
    farm.Reset(7, episode);
    const Plan plan = planner.Solve(farm, Foresight::kOracle);
    EXPECT_NEAR(Play(farm, plan), plan.expected_return, 1e-2);
    EXPECT_EQ(farm.reason(), EndReason::kAllRetrieved);
  }
}

TEST(RecedingHorizon, IsNeverBetterThanClairvoyant) {
  const auto scenario =
      std::make_shared<const Scenario>(LoadScenario(AQUAFARM_SCENARIO_DIR "/paper.yaml"));
  Planner planner(*scenario);
  Farm farm(scenario);
  double optimum = 0.0;
  double achieved = 0.0;
  for (std::uint64_t episode = 0; episode < 5; ++episode) {
    farm.Reset(11, episode);
    const double best = planner.Solve(farm, Foresight::kOracle).expected_return;
    while (!farm.over()) {
      const Plan plan = planner.Solve(farm, Foresight::kPersistence);
      farm.Step(&plan.actions.at(0));
    }
    EXPECT_LE(static_cast<double>(farm.ships()[0].episode_return), best + 1e-2);
    optimum += best;
    achieved += static_cast<double>(farm.ships()[0].episode_return);
  }
  EXPECT_GT(achieved, 0.8 * optimum);
}

TEST(Planner, SaysWhatItCannotPlanFor) {
  Scenario many;
  many.devices.count = 30;
  EXPECT_THROW(Planner{many}, InputError);
}

// Compares the results of both policies on the same episodes.
class PlannerPolicies : public ::testing::Test {
 protected:
  static Evaluation Evaluate(const std::string& policy, std::int32_t farms) {
    LocalEnvironment environment(test::Share(TinyScenario(40, 0.02F, 1)),
                                 {farms, kStatesBit, false, 1});
    const SavedPolicy saved = FindPolicy(policy);
    return agents::Evaluate(environment, *MakePolicy(saved, environment.spec()), 3, 60);
  }
};

TEST_F(PlannerPolicies, TheFutureIsWorthKnowing) {
  const Evaluation clairvoyant = Evaluate("clairvoyant", 4);
  const Evaluation planner = Evaluate("planner", 4);
  double gained = 0.0;
  for (std::size_t i = 0; i < clairvoyant.episodes.size(); ++i) {
    const auto best = static_cast<double>(clairvoyant.episodes[i].episode_return);
    const auto good = static_cast<double>(planner.episodes[i].episode_return);
    EXPECT_GE(best, good - 1e-3) << "episode " << i;
    gained += best - good;
  }
  EXPECT_GT(gained, 0.0);
  EXPECT_GT(planner.mean_return, 0.0);
}

TEST_F(PlannerPolicies, TheNumberOfFarmsChangesNothing) {
  for (const char* policy : {"planner", "clairvoyant"}) {
    EXPECT_EQ(Evaluate(policy, 1).mean_return, Evaluate(policy, 7).mean_return) << policy;
  }
}

TEST_F(PlannerPolicies, EarnWhatTheClairvoyantPlanPromises) {
  const Evaluation evaluation = Evaluate("clairvoyant", 1);
  const auto scenario = test::Share(TinyScenario(40, 0.02F, 1));
  Planner planner(*scenario);
  for (const EpisodeSummary& result : evaluation.episodes) {
    Farm farm(scenario);
    farm.Reset(result.seed, result.episode);
    EXPECT_NEAR(planner.Solve(farm, Foresight::kOracle).expected_return,
                static_cast<double>(result.episode_return), 1e-3)
        << "episode " << result.episode;
  }
}

TEST_F(PlannerPolicies, PlanForTheTeamOnAFarmOfTwoShips) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.ships.count = 2;
  scenario.step_limit = 60;
  for (const char* name : {"planner", "clairvoyant"}) {
    LocalEnvironment environment(test::Share(scenario), {4, kStatesBit, false, 1});
    const auto policy = MakePolicy(FindPolicy(name), environment.spec());
    const Evaluation evaluation = agents::Evaluate(environment, *policy, 3, 20);
    EXPECT_EQ(evaluation.success_rate, 1.0);
    EXPECT_EQ(evaluation.mean_steps, 6.0);  // two moves north, pickup, two moves south, drop-off
  }
}

}  // namespace
}  // namespace aquafarm::agents
