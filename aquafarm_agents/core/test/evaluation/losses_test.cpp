// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/evaluation/losses.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "agents_fixture.h"
#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/agents/training/saved_policy.h"

namespace aquafarm::agents::test {
namespace {

Losses Summary(const std::vector<Cents>& cents, std::vector<std::size_t> starts = {}) {
  std::vector<Accounts> accounts(cents.size());
  for (std::size_t i = 0; i < cents.size(); ++i) {
    accounts[i].by_kind[1] = {100'000'000, 100'000'000 - cents[i], 0, cents[i]};
  }
  if (starts.empty()) {
    starts.resize(cents.size());
    std::iota(starts.begin(), starts.end(), 0);
  }
  return SummariseLosses(std::move(accounts), std::move(starts), "CNY", 1);
}

// Slow oracles: the definitions, tried on every loss of the sample.
double Exceeded(const std::vector<Cents>& cents, double x) {
  const auto above = std::count_if(cents.begin(), cents.end(), [x](Cents loss) {
    return static_cast<double>(loss) / 100.0 > x;
  });
  return static_cast<double>(above) / static_cast<double>(cents.size());
}

double SlowVar(const std::vector<Cents>& cents) {
  double smallest = 1e18;
  for (const Cents loss : cents) {
    const double x = static_cast<double>(loss) / 100.0;
    if (Exceeded(cents, x) <= 0.05 + 1e-12) smallest = std::min(smallest, x);
  }
  return smallest;
}

// Rockafellar and Uryasev: CVaR = min over c of c + E[max(0, loss - c)] / 5 %, attained at a loss.
double SlowCvar(const std::vector<Cents>& cents) {
  double best = 1e18;
  for (const Cents candidate : cents) {
    const double c = static_cast<double>(candidate) / 100.0;
    double excess = 0.0;
    for (const Cents loss : cents) excess += std::max(0.0, static_cast<double>(loss) / 100.0 - c);
    best = std::min(best, c + excess / static_cast<double>(cents.size()) / 0.05);
  }
  return best;
}

TEST(Losses, OfTwentyEpisodesTheWorstIsTheTail) {
  std::vector<Cents> cents;
  for (Cents i = 1; i <= 20; ++i) cents.push_back(100 * i);
  const Losses losses = Summary(cents);
  EXPECT_DOUBLE_EQ(losses.mean_loss, 10.5);
  EXPECT_DOUBLE_EQ(losses.var.value, 19.0);   // 1 of 20 is larger
  EXPECT_DOUBLE_EQ(losses.cvar.value, 20.0);  // the worst 5 % are one episode
  EXPECT_NEAR(losses.standard_error, std::sqrt(35.0 / 20.0), 1e-12);  // s² of 1 … 20 is 35
  ASSERT_EQ(losses.exceedance.size(), 20U);
  EXPECT_EQ(losses.exceedance.front(), (std::pair<double, double>{1.0, 0.95}));
  EXPECT_EQ(losses.exceedance.back(), (std::pair<double, double>{20.0, 0.0}));
}

TEST(Losses, AgreeWithTheDefinitionsOnRandomSamples) {
  RandomStream rng({5, 0, RngStream::kExploration, 3});
  for (int round = 0; round < 200; ++round) {
    std::vector<Cents> cents(1 + rng.Below(90));
    const std::uint32_t range = 1 + rng.Below(3000);  // small ranges have equal losses
    for (Cents& loss : cents) loss = rng.Below(range);
    const Losses losses = Summary(cents);
    EXPECT_DOUBLE_EQ(losses.var.value, SlowVar(cents)) << "round " << round;
    EXPECT_NEAR(losses.cvar.value, SlowCvar(cents), 1e-9) << "round " << round;
    for (const auto& [x, probability] : losses.exceedance) {
      EXPECT_DOUBLE_EQ(probability, Exceeded(cents, x)) << "round " << round;
    }
    EXPECT_LE(losses.var.value, losses.cvar.value + 1e-9);
  }
}

// Losses that are exponential with mean 1000: VaR is 1000 ln 20, CVaR is 1000 more.
TEST(Losses, IntervalsContainTheTruthAlmostAsOftenAsTheySay) {
  RandomStream rng({6, 0, RngStream::kExploration, 3});
  const double var = 1000.0 * std::log(20.0);
  int with_mean = 0;
  int with_var = 0;
  int with_cvar = 0;
  constexpr int kRounds = 100;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Cents> cents(400);
    for (Cents& loss : cents) {
      loss = std::llround(-1e5 * std::log(1.0 - static_cast<double>(rng.Unit())));
    }
    const Losses losses = Summary(cents);
    with_mean += std::abs(losses.mean_loss - 1000.0) <= 1.96 * losses.standard_error ? 1 : 0;
    with_var += losses.var.low <= var && var <= losses.var.high ? 1 : 0;
    with_cvar += losses.cvar.low <= var + 1000.0 && var + 1000.0 <= losses.cvar.high ? 1 : 0;
  }
  EXPECT_GE(with_mean, 88);
  EXPECT_GE(with_var, 84);
  EXPECT_GE(with_cvar, 78);  // percentile intervals of 20 losses in the tail are somewhat short
}

// Ten equal episodes of each start are as uncertain as one episode of each.
TEST(Losses, RepeatedStartsMakeNothingMoreCertain) {
  RandomStream rng({7, 0, RngStream::kExploration, 3});
  std::vector<Cents> once(60);
  for (Cents& loss : once) loss = rng.Below(100000);
  std::vector<Cents> often;
  std::vector<std::size_t> starts;
  for (int k = 0; k < 10; ++k) {
    for (std::size_t i = 0; i < once.size(); ++i) {
      often.push_back(once[i]);
      starts.push_back(i);
    }
  }
  const Losses alone = Summary(once);
  const Losses repeated = Summary(often, starts);
  EXPECT_EQ(repeated.episodes, 600U);
  EXPECT_EQ(repeated.distinct, 60U);
  EXPECT_NEAR(repeated.standard_error, alone.standard_error, 1e-9);
  EXPECT_DOUBLE_EQ(repeated.cvar.low, alone.cvar.low);
  EXPECT_DOUBLE_EQ(repeated.cvar.high, alone.cvar.high);
}

TEST(Losses, OneStartHasNoInterval) {
  const Losses losses = Summary({100, 100, 100}, {0, 0, 0});
  EXPECT_EQ(losses.distinct, 1U);
  EXPECT_DOUBLE_EQ(losses.var.value, 1.0);
  EXPECT_TRUE(std::isnan(losses.standard_error));
  EXPECT_TRUE(std::isnan(losses.var.low) && std::isnan(losses.cvar.high));
}

TEST(Losses, AmountsAreWrittenToTheCent) {
  EXPECT_EQ(FormatCents(0), "0.00");
  EXPECT_EQ(FormatCents(5), "0.05");
  EXPECT_EQ(FormatCents(-123), "-1.23");
  EXPECT_EQ(FormatCents(400'000'000'000'001), "4000000000000.01");
}

using LossFiles = FolderTest;

std::shared_ptr<const Scenario> InsuredFarm() {
  Scenario scenario = aquafarm::test::CrowdedScenario(2);
  scenario.money = MoneySpec{"CNY", {1000.01, 2000.02, 3000.03, 4000.04}, 50.0, 0.0, 1.0};
  return Share(scenario);
}

Evaluation EvaluationOf(const char* name, std::shared_ptr<const Scenario> scenario) {
  const SavedPolicy saved = FindPolicy(name);
  LocalEnvironment environment(std::move(scenario), {4, saved.observation_types, false, 1});
  return Evaluate(environment, *MakePolicy(saved, environment.spec()), 3, 40, nullptr, {}, {},
                  [&environment](std::int32_t farm) {
                    return environment.batch().farm(farm).SettleAccounts();
                  });
}

// Cells of a CSV file, without the header.
std::vector<std::vector<std::string>> Rows(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

TEST_F(LossFiles, BalanceToTheCentInEachRow) {
  const Evaluation evaluation = EvaluationOf("random", InsuredFarm());
  WriteEvaluation(folder_ + "/e", evaluation, {});
  const auto rows = Rows(ReadFile(folder_ + "/e.csv"));
  ASSERT_EQ(rows.size(), 41U);
  const std::vector<std::string>& names = rows[0];
  const auto cents = [&](const std::vector<std::string>& row, const std::string& name) {
    const auto column = std::find(names.begin(), names.end(), name) - names.begin();
    std::string digits = row.at(static_cast<std::size_t>(column));
    EXPECT_EQ(digits.at(digits.size() - 3), '.');
    digits.erase(digits.size() - 3, 1);
    return std::stoll(digits);
  };
  Cents sum = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    Cents insured = 0;
    for (const char* kind :
         {"temporary_breeding", "monitoring", "breeding_release", "deep_water_breeding"}) {
      const std::string prefix = std::string(kind) + '_';
      insured += cents(rows[i], prefix + "insured");
      EXPECT_EQ(cents(rows[i], prefix + "insured"), cents(rows[i], prefix + "saved") +
                                                        cents(rows[i], prefix + "damaged") +
                                                        cents(rows[i], prefix + "lost"));
    }
    EXPECT_EQ(cents(rows[i], "insured"), insured);
    EXPECT_EQ(insured,
              cents(rows[i], "saved") + cents(rows[i], "damaged") + cents(rows[i], "lost"));
    EXPECT_GT(cents(rows[i], "operating_cost"), 0);
    sum += insured - cents(rows[i], "saved");
  }
  const auto json = nlohmann::json::parse(ReadFile(folder_ + "/e.json")).at("money");
  EXPECT_NEAR(json.at("loss_per_episode").get<double>(), static_cast<double>(sum) / 4000.0, 1e-6);
  EXPECT_EQ(json.at("distinct_episodes"), 40);
  EXPECT_EQ(json.at("currency"), "CNY");
  EXPECT_EQ(json.at("by_kind").size(), 4U);
  EXPECT_GE(json.at("cvar").at("value"), json.at("var").at("value"));
}

TEST_F(LossFiles, HaveNoMoneyWithoutIt) {
  const Evaluation evaluation = EvaluationOf("random", TinyFarm());
  EXPECT_FALSE(evaluation.losses);
  EXPECT_EQ(DescribeLosses(evaluation), "");
  WriteEvaluation(folder_ + "/e", evaluation, {});
  EXPECT_EQ(ReadFile(folder_ + "/e.csv").find("insured"), std::string::npos);
  EXPECT_FALSE(nlohmann::json::parse(ReadFile(folder_ + "/e.json")).contains("money"));
}

TEST(Losses, ARescueLosesLessThanDoingNothing) {
  const auto scenario = InsuredFarm();
  const Evaluation nothing = EvaluationOf("do_nothing", scenario);
  const Evaluation fetched = EvaluationOf("fetch_by_value", scenario);
  const Losses& all = nothing.losses.value();
  EXPECT_DOUBLE_EQ(all.mean_loss, all.Mean(all.Total().insured)) << "all of it is at sea";
  EXPECT_EQ(all.operating_cost, 0) << "the ships stay in port";
  EXPECT_LT(fetched.losses->mean_loss, 0.9 * all.mean_loss);
  EXPECT_GT(fetched.losses->operating_cost, 0);
  EXPECT_CONTAINS(DescribeLosses(fetched), " CNY of ");
  Evaluation one = fetched;  // as with one distinct start
  one.losses->standard_error = one.losses->var.low = one.losses->cvar.low = std::nan("");
  EXPECT_EQ(DescribeLosses(one).find("nan"), std::string::npos);
  EXPECT_EQ(DescribeLosses(one).find('['), std::string::npos);
}

}  // namespace
}  // namespace aquafarm::agents::test
