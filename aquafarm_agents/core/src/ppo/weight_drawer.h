// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include "aquafarm/base/rng.h"
#include "aquafarm/grid/action.h"
#include "ppo/linear.h"

namespace aquafarm::agents {

/// Draws initial weights from (seed, learner), uniform in ±1/√fan_in as in PyTorch.
class WeightDrawer {
 public:
  explicit WeightDrawer(std::uint64_t seed) : rng_({seed, 0, RngStream::kLearner, 0}) {}

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
