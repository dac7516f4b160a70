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

/// Where the weights of a network are in a flat vector, and which random numbers draw them.
struct WeightOrigin {
  std::uint64_t seed{};
  std::uint32_t network{};  ///< index of the network in its learner; each draws its own numbers
  std::size_t begin{};      ///< index of its first weight
};

/// Draws initial weights from (seed, network, learner), uniform in ±1/√fan_in as in PyTorch.
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

  /// Draws the last layer: its logits are near 0, so that the initial policy is almost uniform.
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
