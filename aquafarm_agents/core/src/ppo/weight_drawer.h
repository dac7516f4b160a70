// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "aquafarm/base/rng.h"
#include "aquafarm/grid/action.h"
#include "ppo/linear.h"

namespace aquafarm::agents {

/// Position of a network's weights in a flat vector, and the random stream that draws them.
struct WeightOrigin {
  std::uint64_t seed{};
  std::uint32_t network{};  ///< index of the network in its learner; selects the random stream
  std::size_t begin{};      ///< index of the network's first weight
};

/// Draws initial weights uniformly in ±1/√fan_in, as PyTorch does. The random stream is (seed,
/// network, RngStream::kLearner, 0).
class WeightDrawer {
 public:
  explicit WeightDrawer(const WeightOrigin& origin)
      : rng_({origin.seed, origin.network, RngStream::kLearner, 0}) {}

  void Draw(const Linear& layer, std::vector<float>& weights) {
    const float limit = 1.0F / std::sqrt(static_cast<float>(layer.inputs));
    for (std::size_t i = layer.begin; i < layer.end(); ++i) {
      weights[i] = rng_.Uniform(-limit, limit);
    }
  }

  /// Draws the last layer. The weights of the logits are 100 times smaller, so that the initial
  /// policy is almost uniform.
  void DrawHead(const Linear& layer, std::vector<float>& weights) {
    constexpr float kLogitScale = 0.01F;
    Draw(layer, weights);
    for (std::size_t i = layer.begin; i < layer.end(); ++i) {
      const bool is_logit = (i - layer.begin) % layer.outputs < kActionCount;
      if (is_logit) weights[i] *= kLogitScale;
    }
  }

 private:
  RandomStream rng_;
};

}  // namespace aquafarm::agents
