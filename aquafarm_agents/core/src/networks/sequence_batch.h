// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Minibatch of sequences for LSTM-DQN (R2D2: Kapturowski et al. 2019).

#include <cstdint>
#include <vector>

#include "aquafarm/agents/learning/replay.h"
#include "aquafarm/agents/networks/deep_options.h"
#include "networks/replay_sampler.h"

namespace aquafarm::agents {

/// A minibatch of B runs of time steps, time-major. A run has burn_in time steps that warm up the
/// state, followed by time steps 0 … T. The first T of these are trained on as far as their episode
/// lasts.
struct SequenceBatch {
  std::vector<float> warm_up;          ///< [burn_in, B, F]
  std::vector<float> observations;     ///< [T + 1, B, F]
  std::vector<float> recurrent_state;  ///< [B, 2, hidden] before the first time step of warm_up
  std::vector<float>
      recurrent_state_after;  ///< [B, 2, hidden] stored at time step 1; paper_tuple only
  std::vector<float>
      warms_up;  ///< [B] 0 if recurrent_state is already the state before time step 0
  std::vector<std::uint8_t> actions;  ///< [T, B]
  std::vector<float> rewards;         ///< [T, B] summed over the steps to `next`
  std::vector<float> discounts;       ///< [T, B] factor of the value at `next`
  std::vector<std::int64_t> next;     ///< [T, B] time step of the bootstrap value
  std::vector<ActionMask> allowed;    ///< [T + 1, B]
  std::vector<float> weights;         ///< [T, B] 1 if trained on, else 0
  std::vector<std::size_t> rows;      ///< [T, B] rows of the replay

  /// @param features F
  /// @param recurrent_size 2 · hidden
  SequenceBatch(const DeepOptions& options, std::size_t features, std::size_t recurrent_size);

  std::size_t size() const { return warms_up.size(); }

  /// Fills run b, which trains from `moment` on. The state is warmed up over the burn_in time steps
  /// before it, from the state stored at the first of them. A run never crosses an episode start:
  /// near it the run begins at the first time step of the episode, whose state is exactly zero.
  /// If earlier time steps are overwritten, it begins at the oldest one, with its stored state.
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
