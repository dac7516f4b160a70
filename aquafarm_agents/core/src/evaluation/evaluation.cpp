// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/evaluation/evaluation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/environment/family_environment.h"
#include "aquafarm/agents/evaluation/metrics_file.h"
#include "aquafarm/base/check.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "base/constants.h"

namespace aquafarm::agents {
namespace {

constexpr std::chrono::seconds kProgressPeriod{5};

void Summarise(Evaluation& evaluation) {
  const auto count = static_cast<double>(evaluation.episodes.size());
  double steps = 0.0;
  double returns = 0.0;
  double delivering = 0.0;
  for (const EpisodeSummary& result : evaluation.episodes) {
    returns += static_cast<double>(result.episode_return);
    steps += result.steps;
    evaluation.success_rate += result.Success() ? 1.0 : 0.0;
    evaluation.mean_crashes += result.crashes;
    evaluation.mean_steps_in_disaster += result.steps_in_disaster;
    evaluation.mean_energy += result.energy;
    evaluation.mean_distance += result.distance;
    evaluation.mean_delivered_health += static_cast<double>(result.delivered_health);
    delivering += result.delivered > 0 ? 1.0 : 0.0;
  }
  if (count == 0.0) return;
  evaluation.mean_return = returns / count;
  evaluation.mean_steps = steps / count;
  evaluation.return_per_step = steps > 0.0 ? returns / steps : 0.0;
  evaluation.success_rate /= count;
  evaluation.mean_crashes /= count;
  evaluation.mean_steps_in_disaster /= count;
  evaluation.mean_energy /= count;
  evaluation.mean_distance /= count;
  if (delivering > 0.0) evaluation.mean_delivered_health /= delivering;
}

// Returns null for NaN and infinity, which JSON does not have.
nlohmann::json NumberOrNull(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::json ToJson(const Losses& losses, const Ledger& sums) {
  return {{"insured", losses.Mean(sums.insured)},
          {"saved", losses.Mean(sums.saved)},
          {"damaged", losses.Mean(sums.damaged)},
          {"lost", losses.Mean(sums.lost)}};
}

nlohmann::json ToJson(const Losses& losses) {
  const auto estimate = [](const Estimate& of) -> nlohmann::json {
    return {{"value", of.value}, {"low", NumberOrNull(of.low)}, {"high", NumberOrNull(of.high)}};
  };
  nlohmann::json json = {{"currency", losses.currency},
                         {"episodes", losses.episodes},
                         {"distinct_episodes", losses.distinct},
                         {"per_episode", ToJson(losses, losses.Total())},
                         {"loss_per_episode", losses.mean_loss},
                         {"loss_standard_error", NumberOrNull(losses.standard_error)},
                         {"operating_cost_per_episode", losses.Mean(losses.operating_cost)},
                         {"tail", 1.0 / static_cast<double>(kTailInverse)},
                         {"var", estimate(losses.var)},
                         {"cvar", estimate(losses.cvar)},
                         {"exceedance", losses.exceedance}};
  for (std::size_t kind = 0; kind < losses.by_kind.size(); ++kind) {
    if (losses.by_kind[kind].insured == 0) continue;
    json["by_kind"][std::string(ToString(static_cast<DeviceKind>(kind)))] =
        ToJson(losses, losses.by_kind[kind]);
  }
  return json;
}

nlohmann::json ToJson(const DeviceTally& one) {
  nlohmann::json json = {{"kind", ToString(one.kind)},
                         {"delivered", one.delivered},
                         {"aboard", one.aboard},
                         {"left", one.Left()}};
  if (one.delivered > 0) {
    json["delivered_health"] = one.delivered_health / static_cast<double>(one.delivered);
  }
  return json;
}

// Writes the outcomes by id, or by kind if the episodes have different devices.
void WriteDevices(const DeviceOutcomes& outcomes, nlohmann::json& json) {
  if (outcomes.empty()) return;
  if (!outcomes.are_same) {
    for (const DeviceTally& one : outcomes.by_kind) {
      if (one.devices == 0) continue;
      json["devices_by_kind"].push_back(ToJson(one));
      json["devices_by_kind"].back()["devices"] = one.devices;
    }
    return;
  }
  for (std::size_t id = 0; id < outcomes.by_id.size(); ++id) {
    json["devices"].push_back(ToJson(outcomes.by_id[id]));
    json["devices"].back()["id"] = id;
    json["devices"].back()["episodes"] = outcomes.by_id[id].devices;
  }
}

// Returns half the width of the 95 % interval of the mean return: kNormal95 standard errors. The
// sample size is the number of distinct starts. Returns NaN if there are fewer than two.
double ReturnMargin(const Evaluation& evaluation) {
  const auto count = static_cast<double>(evaluation.episodes.size());
  if (evaluation.distinct < 2) return std::numeric_limits<double>::quiet_NaN();
  double squares = 0.0;
  for (const EpisodeSummary& episode : evaluation.episodes) {
    const double away = double(episode.episode_return) - evaluation.mean_return;
    squares += away * away;
  }
  return kNormal95 * std::sqrt(squares / (count - 1.0) / static_cast<double>(evaluation.distinct));
}

nlohmann::json ToJson(const Evaluation& evaluation, const EvaluationContext& context) {
  nlohmann::json json = {{"policy", context.policy},
                         {"algorithm", context.algorithm},
                         {"training_steps", context.training_steps},
                         {"scenario", context.scenario_name},
                         {"scenario_hash", context.scenario_hash},
                         {"version", context.version},
                         {"farms", context.farms},
                         {"seed", evaluation.seed & ~kEvaluationSeedBit},
                         {"farm_seed", evaluation.seed},
                         {"episodes", evaluation.episodes.size()},
                         {"distinct_episodes", evaluation.distinct},
                         {"complete", evaluation.complete},
                         {"return_per_episode", evaluation.mean_return},
                         {"return_per_step", evaluation.return_per_step},
                         {"success_rate", evaluation.success_rate},
                         {"steps_per_episode", evaluation.mean_steps},
                         {"delivered_health", evaluation.mean_delivered_health},
                         {"crashes_per_episode", evaluation.mean_crashes},
                         {"steps_in_disaster_per_episode", evaluation.mean_steps_in_disaster},
                         {"energy_kwh_per_episode", evaluation.mean_energy},
                         {"distance_km_per_episode", evaluation.mean_distance},
                         {"wall_s", evaluation.wall_s}};
  if (const double margin = ReturnMargin(evaluation); std::isfinite(margin)) {
    json["return_interval_95"] = {evaluation.mean_return - margin, evaluation.mean_return + margin};
  }
  WriteDevices(evaluation.devices, json);
  if (evaluation.losses) json["money"] = ToJson(*evaluation.losses);
  if (evaluation.mean_bound) json["upper_bound_per_episode"] = *evaluation.mean_bound;
  return json;
}

// Sets `distinct` and `losses`. To compare the starts of the episodes, it starts the episodes again
// in this process. This is possible because a start depends only on the scenario, the seed and the
// episode number, even if the episode was played through ROS services.
// @param accounts [episodes]; empty if they are unknown
void CompareStarts(const EnvironmentSpec& spec, std::vector<Accounts> accounts,
                   Evaluation& evaluation) {
  const auto scenario =
      std::make_shared<const Scenario>(ParseScenario(spec.scenario_yaml, "scenario"));
  Farm farm(scenario);
  std::unordered_map<std::uint64_t, std::size_t> index;  // of a start, by its hash
  std::vector<std::size_t> starts;
  for (const EpisodeSummary& result : evaluation.episodes) {
    if (scenario->family) {
      farm = MakeRanch(*scenario, result.seed, result.episode);
    } else {
      farm.Reset(result.seed, result.episode);
    }
    starts.push_back(index.emplace(farm.StartHash(), index.size()).first->second);
  }
  evaluation.distinct = index.size();
  if (!farm.scenario().money || accounts.empty()) return;
  evaluation.losses = SummariseLosses(std::move(accounts), std::move(starts),
                                      farm.scenario().money->currency, evaluation.seed);
}

}  // namespace

Evaluation Evaluate(Environment& environment, Policy& policy, std::uint64_t seed,
                    std::int32_t episodes, const std::atomic<bool>* stop,
                    const std::function<void(std::size_t done)>& on_progress,
                    std::optional<std::uint64_t> policy_seed, const AccountsOf& accounts_of) {
  AQUAFARM_CHECK_GE(episodes, 1);
  const auto start = std::chrono::steady_clock::now();
  auto reported = start;
  const auto count = static_cast<std::size_t>(episodes);
  Evaluation evaluation;
  evaluation.seed = EvaluationSeed(seed);
  const std::uint64_t rng = policy_seed.value_or(evaluation.seed);
  std::vector<EpisodeSummary> results(count);
  std::vector<std::uint8_t> is_done(count);
  std::vector<std::optional<Accounts>> accounts(count);
  std::size_t done = 0;
  policy.Begin(rng, environment.spec().farms);
  std::vector<std::uint8_t> actions;
  const StepResults* now = &environment.Reset(evaluation.seed);
  while (done < count && (stop == nullptr || !*stop)) {
    policy.Act(*now, actions);
    now = &environment.Step(actions);
    for (const EpisodeSummary& result : now->finished) {
      if (result.episode >= count || is_done[result.episode] != 0) continue;
      results[result.episode] = result;
      is_done[result.episode] = 1;
      if (accounts_of) accounts[result.episode] = accounts_of(result.farm);
      ++done;
    }
    const auto present = std::chrono::steady_clock::now();
    if (on_progress && present - reported >= kProgressPeriod) {
      reported = present;
      on_progress(done);
    }
    if (environment.ConsumeRestart()) {  // the farms are new; finished episodes are kept
      policy.Begin(rng, environment.spec().farms);
      now = &environment.Reset(evaluation.seed);
    }
  }
  std::vector<Accounts> known;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_done[i] == 0) continue;
    evaluation.episodes.push_back(results[i]);
    if (accounts[i]) known.push_back(*accounts[i]);
  }
  evaluation.complete = done == count;
  CompareStarts(environment.spec(), std::move(known), evaluation);
  Summarise(evaluation);
  evaluation.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return evaluation;
}

void WriteEvaluation(const std::string& prefix, const Evaluation& evaluation,
                     const EvaluationContext& context) {
  std::string rows = EpisodeColumns() + AddedColumns();
  if (evaluation.losses) rows += AccountColumns();
  rows += '\n';
  for (std::size_t i = 0; i < evaluation.episodes.size(); ++i) {
    AppendEpisode(evaluation.episodes[i], rows);
    AppendAdded(evaluation.episodes[i], rows);
    if (evaluation.losses) {
      AppendAccounts(evaluation.losses->starts[i], evaluation.losses->accounts[i], rows);
    }
    rows += '\n';
  }
  WriteFileAtomically(prefix + ".csv", rows);
  WriteFileAtomically(prefix + ".json", ToJson(evaluation, context).dump(2) + "\n");
}

std::string Describe(const Evaluation& evaluation) {
  char interval[48] = "";
  if (const double margin = ReturnMargin(evaluation); std::isfinite(margin)) {
    std::snprintf(interval, sizeof(interval), " [95 %%: %.1f, %.1f]",
                  evaluation.mean_return - margin, evaluation.mean_return + margin);
  }
  // 100.0 % means that all episodes succeed.
  const double percent =
      evaluation.success_rate >= 1.0 ? 100.0 : std::min(100.0 * evaluation.success_rate, 99.94);
  char text[250];
  std::snprintf(text, sizeof(text),
                "success %.1f %%, return %.1f%s per episode, %.2f per step, %.1f steps "
                "(%zu episodes, %zu distinct)",
                percent, evaluation.mean_return, interval, evaluation.return_per_step,
                evaluation.mean_steps, evaluation.episodes.size(), evaluation.distinct);
  return text;
}

std::string DescribeLosses(const Evaluation& evaluation) {
  if (!evaluation.losses) return "";
  const Losses& losses = *evaluation.losses;
  const auto number = [](double value) {
    char text[60];
    std::snprintf(text, sizeof(text), "%.2f", value);
    return std::string(text);
  };
  const auto interval = [&number](const auto& of) {  // NaN with fewer than two distinct starts
    return number(of.value) +
           (std::isnan(of.low) ? "" : " [95 %: " + number(of.low) + ", " + number(of.high) + "]");
  };
  return "loss " + number(losses.mean_loss) +
         (std::isnan(losses.standard_error) ? "" : " ± " + number(losses.standard_error)) + " " +
         losses.currency + " of " + number(losses.Mean(losses.Total().insured)) +
         " insured, operating cost " + number(losses.Mean(losses.operating_cost)) + ", VaR 5 % " +
         interval(losses.var) + ", CVaR 5 % " + interval(losses.cvar);
}

}  // namespace aquafarm::agents
