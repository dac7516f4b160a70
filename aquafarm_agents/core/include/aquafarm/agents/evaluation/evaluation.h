// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Evaluation of a policy on episodes that are never used in training: training seeds are less than
/// 2^63, evaluation seeds are not.

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/agents/evaluation/device_outcomes.h"
#include "aquafarm/agents/evaluation/losses.h"
#include "aquafarm/base/rng.h"

namespace aquafarm::agents {

/// The bit that distinguishes the seeds of training and of evaluation (base/rng.h).
using aquafarm::kEvaluationSeedBit;
/// Returns the seed of the farms for an evaluation with `seed`.
constexpr std::uint64_t EvaluationSeed(std::uint64_t seed) { return seed | kEvaluationSeedBit; }

/// Aggregate results of evaluating one policy.
struct Evaluation {
  std::uint64_t seed{};                  ///< seed of the farms, with kEvaluationSeedBit
  std::vector<EpisodeSummary> episodes;  ///< finished episodes of the seed, in order
  double mean_return{};                  ///< per episode
  double return_per_step{};  ///< sum of returns / sum of steps (paper §4.2, see docs/model.md)
  double success_rate{};     ///< fraction of episodes in which every device was delivered
  double mean_steps{};       ///< per episode
  /// Health of the delivered devices, averaged over the episodes with a delivery; 0 if no device
  /// was delivered.
  double mean_delivered_health{};
  double mean_crashes{};            ///< per episode
  double mean_steps_in_disaster{};  ///< steps of all ships in cells with a risk, per episode
  double mean_energy{};             ///< of all ships per episode [kWh]
  double mean_distance{};           ///< of all ships per episode [km]
  double wall_s{};                  ///< duration of the evaluation [s]
  bool complete{};                  ///< false if the evaluation was stopped early
  /// Number of distinct starts of the episodes (layout, ships, devices and disasters). Under a
  /// deterministic policy, episodes with equal starts differ only by later random draws.
  std::size_t distinct{};
  /// Losses over the episodes; unset if the scenario has no `money`, or if accounts are unknown.
  std::optional<Losses> losses;
  /// Mean upper bound of the return (team_bound.h). Evaluate leaves it unset.
  std::optional<double> mean_bound;
  /// Outcomes of the devices. Evaluate leaves them empty.
  DeviceOutcomes devices;
};

/// Returns the accounts of a farm whose episode has just ended; nullopt if its scenario has no
/// `money`.
using AccountsOf = std::function<std::optional<Accounts>(std::int32_t farm)>;

/// Plays episodes 0 … episodes − 1 of EvaluationSeed(seed). For a deterministic policy, the result
/// does not depend on the number of farms, apart from `wall_s`. (A network may round differently in
/// batches of another size.)
/// @param stop may be set by a signal handler; null if the evaluation cannot be stopped
/// @param episodes at least 1
/// @param on_progress called about every 5 s with the number of finished episodes; may be empty
/// @param policy_seed seed of the policy's random numbers; by default that of the episodes
/// @param accounts_of called once for each finished episode. If it is empty, `losses` is unset.
///        Farms behind ROS services do not provide accounts
Evaluation Evaluate(Environment& environment, Policy& policy, std::uint64_t seed,
                    std::int32_t episodes, const std::atomic<bool>* stop = nullptr,
                    const std::function<void(std::size_t done)>& on_progress = {},
                    std::optional<std::uint64_t> policy_seed = std::nullopt,
                    const AccountsOf& accounts_of = {});

/// Inputs of an evaluation. WriteEvaluation stores them, so that the evaluation can be repeated.
struct EvaluationContext {
  std::string policy;  ///< path of the policy file, or name of a built-in policy
  std::string algorithm;
  std::uint64_t training_steps{};
  std::string scenario_name;
  std::uint64_t scenario_hash{};
  std::string version;
  std::int32_t farms{};
};

/// Writes `<prefix>.csv` and `<prefix>.json`. The CSV file has the columns EpisodeColumns,
/// AddedColumns and, if losses are known, AccountColumns. @throws StorageError
void WriteEvaluation(const std::string& prefix, const Evaluation& evaluation,
                     const EvaluationContext& context);

/// Returns one line: "success 100.0 %, return 243.1 [95 %: 241.0, 245.2] per episode, 4.02 per
/// step, 60.4 steps (1000 episodes, 998 distinct)"
std::string Describe(const Evaluation& evaluation);
/// Returns one line: "loss 1234.50 ± 8.10 CNY of 5000.00 insured, operating cost 310.00, VaR 5 %
/// 2000.00 [95 %: 1900.00, 2100.00], CVaR 5 % …"; empty if the evaluation has no losses.
std::string DescribeLosses(const Evaluation& evaluation);

}  // namespace aquafarm::agents
