// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Playing without learning, on episodes never trained on: training seeds lie below 2^63,
/// evaluation seeds above, so that no choice of numbers makes them meet.

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/environment/policy.h"

namespace aquafarm::agents {

/// Set in every seed of evaluation and in none of training.
inline constexpr std::uint64_t kEvaluationSeedBit = 1ULL << 63U;
/// The seed in which farms play when asked to evaluate with `seed`.
constexpr std::uint64_t EvaluationSeed(std::uint64_t seed) { return seed | kEvaluationSeedBit; }

/// What a policy came to.
struct Evaluation {
  std::uint64_t seed{};                 ///< of the farms, with kEvaluationSeedBit
  std::vector<EpisodeResult> episodes;  ///< 0, 1, 2, … of the seed, in order
  double mean_return{};                 ///< per episode
  double return_per_step{};             ///< all returns over all steps (§4.2)
  double success_rate{};                ///< share that ended with every device delivered
  double mean_steps{};
  double mean_delivered_health{};  ///< over episodes with a delivery; 0: none
  double mean_crashes{};
  double mean_steps_in_disaster{};
  double wall_s{};
  bool complete{};                   ///< false when it was stopped
  std::optional<double> mean_bound;  ///< of these episodes (team_bound.h), if asked for
};

/// Plays episodes 0 … episodes − 1 of EvaluationSeed(seed). The result does not depend on the
/// number of farms for a policy that uses no chance, but for the rounding of a network, which may
/// differ between numbers of rows.
/// @param stop may be set by a signal handler; null: never
/// @param on_progress is told now and then how many episodes are over
Evaluation Evaluate(Environment& environment, Policy& policy, std::uint64_t seed,
                    std::int32_t episodes, const std::atomic<bool>* stop = nullptr,
                    const std::function<void(std::size_t over)>& on_progress = {});

/// What an evaluation was of; goes into its JSON so that it can be done again.
struct EvaluationContext {
  std::string policy;  ///< path, or random
  std::string algorithm;
  std::uint64_t training_steps{};
  std::string scenario_name;
  std::uint64_t scenario_hash{};
  std::string version;
  std::int32_t farms{};
};

/// Writes `<prefix>.csv` (kEpisodeColumns) and `<prefix>.json`. @throws StorageError
void WriteEvaluation(const std::string& prefix, const Evaluation& evaluation,
                     const EvaluationContext& context);

/// "success 100.0 %, return 243.1 per episode, 4.02 per step, 60.4 steps (1000 episodes)"
std::string Describe(const Evaluation& evaluation);

}  // namespace aquafarm::agents
