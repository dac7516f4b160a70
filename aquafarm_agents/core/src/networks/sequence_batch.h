// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Minibatch of sequences for LSTM-DQN (R2D2: Kapturowski et al. 2019).

#include <cstdint>
#include <vector>

#include "aquafarm/agents/learning/replay.h"
#include "aquafarm/agents/networks/deep_options.h"
#include "networks/replay_sampler.h"

namespace aquafarm::agents {

/// A minibatch of B runs of time steps, time-major. A run has burn_in time steps that only warm up
/// the recurrent state, followed by time steps 0 … T, where T is sequence_length. The network is
/// trained at those of the time steps 0 … T − 1 that lie before the end of the episode.
struct SequenceBatch {
  std::vector<float> warm_up;          ///< [burn_in, B, F]
  std::vector<float> observations;     ///< [T + 1, B, F]
  std::vector<float> recurrent_state;  ///< [B, 2, hidden] before the first time step of the run
  /// [B, 2, hidden] state stored at time step 1; empty unless paper_tuple is set
  std::vector<float> recurrent_state_after;
  /// [B] 1 if warm_up must be read before time step 0; 0 if recurrent_state is the state before
  /// time step 0
  std::vector<float> warms_up;
  std::vector<std::uint8_t> actions;  ///< [T, B]
  std::vector<float> rewards;         ///< [T, B] discounted sum of the scaled rewards until `next`
  std::vector<float> discounts;       ///< [T, B] factor of the value at `next`
  std::vector<std::int64_t> next;     ///< [T, B] time step of the bootstrap value
  std::vector<ActionMask> allowed;    ///< [T + 1, B] allowed actions
  std::vector<float> weights;     ///< [T, B] 1 if the network is trained at this time step, else 0
  std::vector<std::size_t> rows;  ///< [T, B] rows in the replay

  /// @param features F
  /// @param recurrent_size 2 · hidden
  SequenceBatch(const DeepOptions& options, std::size_t features, std::size_t recurrent_size);

  /// Returns the number of runs, B.
  std::size_t size() const { return warms_up.size(); }

  /// Fills run b. Usually, time step 0 is `moment`. The warm-up has the burn_in time steps before
  /// `moment`, and starts with the recurrent state stored at the first of them. There is no warm-up
  /// in two cases, which also change time step 0:
  ///
  ///   moment is within burn_in steps of     time step 0 is that first time step, whose state is
  ///   the first time step of its episode    zero
  ///   the replay has fewer than burn_in     time step 0 is the oldest stored time step; its stored
  ///   earlier time steps                    state is used
  void Fill(std::size_t b, const Replay<float>& replay, const TransitionIndex& moment,
            const DeepOptions& options);

 private:
  void FillRun(std::size_t b, const Replay<float>& replay, const TransitionIndex& first,
               const DeepOptions& options);
  std::size_t burn_in_;
  std::size_t steps_;
  std::size_t features_;
  std::size_t recurrent_size_;
};

}  // namespace aquafarm::agents
