// SPDX-License-Identifier: BSD-3-Clause
// Compares how well a trained network avoids a disaster that is announced in mid-episode with how
// well it avoids one that is announced at the start.
//
// One ship fetches three devices on 12 × 12 cells, with a new layout in each episode. A storm
// crosses the farm around step 48. It is announced (SetDisaster) at step 0, or later, at a step in
// [8, 20]. PPO trains on episodes of both kinds, then plays pairs of episodes that differ only in
// the step of the announcement. The result "unseen" is from the episodes with the late
// announcement, played with the disaster slots of the observation set to 0.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/ppo/ppo.h"
#include "aquafarm/base/rng.h"
#include "aquafarm/farm/disaster.h"
#include "aquafarm/observation/farm_batch.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm/scenario/validate.h"

namespace aquafarm::agents {
namespace {

constexpr std::int32_t kSteps = 80;
constexpr float kSpeed = 0.5F;

std::shared_ptr<const Scenario> MakeScenario() {
  Scenario scenario;
  scenario.name = "arrivals";
  scenario.width = scenario.height = 12;
  scenario.layout = LayoutMode::kPerEpisode;
  scenario.rocks.count = {4, 8};
  scenario.ports.count = 2;
  scenario.devices.count = 3;
  scenario.step_limit = kSteps;
  scenario.view.routes = true;
  scenario.view.disaster_slots = 1;
  scenario.view.forecast_leads_h = {0.25F, 0.5F};  // 5 and 10 steps
  scenario.hash = HashScenario(scenario);
  ValidateScenario(scenario);
  return std::make_shared<const Scenario>(std::move(scenario));
}

/// When the storm of an episode is announced.
enum class Arrival : std::uint8_t { kStart, kLater, kMixed };

/// Farms whose storms are announced by SetDisaster.
class Farms {
 public:
  Farms(const std::shared_ptr<const Scenario>& scenario, std::int32_t farms, Arrival arrival)
      : batch_(scenario, farms), arrival_(arrival) {
    const auto n = static_cast<std::size_t>(farms);
    results_.rewards.resize(n);
    results_.outcomes.resize(n);
    results_.legal.resize(n);
    results_.active.resize(n);
    results_.end_reasons.resize(n);
    results_.is_first.resize(n);
    results_.features.resize(n * static_cast<std::size_t>(batch_.encoder().feature_count()));
    output_.rewards = results_.rewards.data();
    output_.outcomes = results_.outcomes.data();
    output_.legal = results_.legal.data();
    output_.active = results_.active.data();
    output_.end_reasons = results_.end_reasons.data();
    output_.is_first = results_.is_first.data();
    output_.features = results_.features.data();
  }
  EnvironmentSpec spec() const {
    return MakeSpec(batch_.scenario(), batch_.encoder(), batch_.farms());
  }
  const FarmBatch& batch() const { return batch_; }
  StepResults& Reset(std::uint64_t seed, std::uint64_t first) {
    batch_.Reset(seed, first, output_);
    Arrive();
    return results_;
  }
  StepResults& Step(const std::vector<std::uint8_t>& actions) {
    batch_.Step(actions.data(), output_);
    Arrive();
    return results_;
  }

 private:
  std::int32_t ArrivalOf(RandomStream& rng) const {
    const auto later = 8 + static_cast<std::int32_t>(rng.Below(13));
    const bool at_start = rng.Below(2) == 0;
    if (arrival_ == Arrival::kMixed) return at_start ? 0 : later;
    return arrival_ == Arrival::kStart ? 0 : later;
  }

  // Announces the storms that are due at this step. If any are due, writes the observations again.
  void Arrive() {
    for (std::int32_t i = 0; i < batch_.farms(); ++i) {
      Farm& farm = batch_.farm(i);
      if (farm.over() || !farm.disasters().empty()) continue;
      RandomStream rng({farm.seed(), farm.episode(), RngStream::kExploration, 77});
      if (farm.step() != ArrivalOf(rng)) continue;
      DisasterSpec storm;
      storm.radii = {2.0F, 4.0F};
      storm.risks = {-20.0F, -10.0F};
      storm.speed = kSpeed;
      storm.turn_probability = 0.0F;
      storm.border = Border::kLeave;
      storm.heading_deg = static_cast<std::int32_t>(rng.Below(360));
      storm.duration = kSteps - farm.step();
      const auto heading = HeadingVector(*storm.heading_deg);
      const float to_go = kSpeed * (48.0F - static_cast<float>(farm.step()));
      storm.start = {{rng.Uniform(2.5F, 8.5F) - heading[0] * to_go,
                      rng.Uniform(2.5F, 8.5F) - heading[1] * to_go}};
      farm.SetDisaster(0, storm);
      changed_ = true;
    }
    if (!changed_) return;
    changed_ = false;
    const std::vector<std::uint8_t> is_first = results_.is_first;
    batch_.Write(output_);
    results_.is_first = is_first;
  }

  FarmBatch batch_;
  Arrival arrival_;
  StepResults results_;
  BatchOutput output_;
  bool changed_{};
};

struct Played {
  std::vector<double> in_disaster;  // steps in the disaster, by episode
  std::vector<double> delivered;    // delivered devices, by episode
};

// Plays `episodes` episodes, rounded up to a multiple of kFarms. @param unseen whether to set the
// disaster slots of the observation to 0
Played Play(const std::shared_ptr<const Scenario>& scenario, Policy& policy, Arrival arrival,
            std::int32_t episodes, bool unseen) {
  constexpr std::int32_t kFarms = 256;
  Farms farms(scenario, kFarms, arrival);
  const std::vector<std::string> names = farms.batch().encoder().feature_names();
  Played played;
  std::vector<std::uint8_t> actions;
  for (std::int32_t first = 0; first < episodes; first += kFarms) {
    policy.Begin(1, kFarms);
    StepResults* results = &farms.Reset(kEvaluationSeedBit | 5U, static_cast<std::uint64_t>(first));
    std::vector<bool> over(kFarms, false);
    std::vector<EpisodeRecord> records(kFarms);
    while (std::find(over.begin(), over.end(), false) != over.end()) {
      for (std::size_t k = 0; unseen && k < results->features.size(); ++k) {
        if (names[k % names.size()].compare(0, 4, "slot") == 0) results->features[k] = 0.0F;
      }
      policy.Act(*results, actions);
      results = &farms.Step(actions);
      for (std::size_t i = 0; i < over.size(); ++i) {
        if (over[i] || results->end_reasons[i] == 0) continue;
        over[i] = true;
        records[i] = farms.batch().farm(static_cast<std::int32_t>(i)).record();
      }
    }
    for (const EpisodeRecord& record : records) {
      played.in_disaster.push_back(record.steps_in_disaster);
      played.delivered.push_back(record.delivered);
    }
  }
  return played;
}

double Mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// Prints the ratio of two paired means with its 95 % interval (by linearization, Cochran 1977).
void PrintRatio(const char* what, const Played& known, const Played& other) {
  const double of_known = Mean(known.in_disaster);
  const double ratio = Mean(other.in_disaster) / of_known;
  double squares = 0.0;
  const auto n = static_cast<double>(known.in_disaster.size());
  for (std::size_t i = 0; i < known.in_disaster.size(); ++i) {
    const double rest = other.in_disaster[i] - ratio * known.in_disaster[i];
    squares += rest * rest;
  }
  const double error = std::sqrt(squares / (n - 1.0) / n) / of_known;
  std::printf(
      "%s: %.3f steps in the disaster (known from the start: %.3f), ratio %.3f [%.3f, "
      "%.3f], delivered %.3f (known: %.3f), %zu pairs\n",
      what, Mean(other.in_disaster), of_known, ratio, ratio - 1.96 * error, ratio + 1.96 * error,
      Mean(other.delivered), Mean(known.delivered), known.in_disaster.size());
}

void Measure(std::uint64_t seed, std::int64_t steps, std::int32_t pairs,
             const std::string& options) {
  constexpr std::int32_t kFarms = 128;
  const auto scenario = MakeScenario();
  Farms farms(scenario, kFarms, Arrival::kMixed);
  const std::unique_ptr<Learner> learner = MakePpo(farms.spec(), seed, options);
  const StepResults* results = &farms.Reset(seed, 0);
  std::vector<std::uint8_t> actions;
  for (std::int64_t done = 0; done < steps; done += kFarms) {
    learner->Step(*results, static_cast<double>(done) / static_cast<double>(steps), actions);
    results = &farms.Step(actions);
  }
  const std::unique_ptr<Policy> policy = learner->GreedyPolicy();
  std::printf("seed %llu, %lld steps\n", static_cast<unsigned long long>(seed),
              static_cast<long long>(steps));
  const Played known = Play(scenario, *policy, Arrival::kStart, pairs, false);
  PrintRatio("arrives in mid-episode", known,
             Play(scenario, *policy, Arrival::kLater, pairs, false));
  PrintRatio("unseen", known, Play(scenario, *policy, Arrival::kLater, pairs, true));
}

}  // namespace
}  // namespace aquafarm::agents

int main(int argc, char** argv) {
  CLI::App app{"Steps in a disaster that arrives in mid-episode, against one known from the start"};
  std::uint64_t seed = 1;
  std::int64_t steps = 2'000'000;
  std::int32_t pairs = 8192;
  std::string options = "batch_size=2048";
  app.add_option("--seed", seed, "seed of the training")->capture_default_str();
  app.add_option("--steps", steps, "farm steps of the training")->capture_default_str();
  app.add_option("--pairs", pairs, "pairs of episodes, a multiple of 256")->capture_default_str();
  app.add_option("--options", options, "options of PPO")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  aquafarm::agents::Measure(seed, steps, pairs, options);
  return 0;
}
