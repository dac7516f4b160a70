// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What LSTM-DQN learns from at a time (R2D2: Kapturowski et al. 2019).

#include <cstdint>
#include <vector>

#include "aquafarm/agents/learning/replay.h"
#include "aquafarm/agents/networks/deep_options.h"
#include "networks/replay_sampler.h"

namespace aquafarm::agents {

/// A minibatch of B runs of moments, time first. A run has burn_in moments that warm up the state,
/// then the moments 0 … T whose first T are learnt from while their episode lasts.
struct SequenceBatch {
  std::vector<float> warm_up;         ///< [burn_in, B, F]
  std::vector<float> observations;    ///< [T + 1, B, F]
  std::vector<float> carry;           ///< [B, 2, hidden] before the first moment of warm_up
  std::vector<float> warms_up;        ///< [B] 0: carry is the state before moment 0 already
  std::vector<std::int64_t> actions;  ///< [T, B]
  std::vector<float> rewards;         ///< [T, B] summed over the steps to `next`
  std::vector<float> discounts;       ///< [T, B] of the value at `next`
  std::vector<std::int64_t> next;     ///< [T, B] moment that the target looks at
  std::vector<float> forbidden;       ///< [T + 1, B, kActionCount]
  std::vector<float> weights;         ///< [T, B] 1: learnt, 0: not
  std::vector<std::size_t> rows;      ///< [T, B] of the replay

  /// @param features F
  /// @param carry_size 2 · hidden
  SequenceBatch(const DeepOptions& options, std::size_t features, std::size_t carry_size);

  std::size_t size() const { return warms_up.size(); }

  /// Makes the moment the first that run b learns from, or the nearest before it whose state is
  /// known: the state is warmed up from burn_in moments back, with the state stored there. A run
  /// never crosses an episode: near its beginning it starts there, with the empty state that is
  /// exact. Where the ring has dropped what is before, the state stored at its oldest moment has
  /// to do.
  void Fill(std::size_t b, const Replay<float>& replay, const Moment& moment,
            const DeepOptions& options);

 private:
  void FillRun(std::size_t b, const Replay<float>& replay, const Moment& first,
               const DeepOptions& options);
  std::size_t burn_in_;
  std::size_t steps_;
  std::size_t features_;
  std::size_t carry_size_;
};

}  // namespace aquafarm::agents
