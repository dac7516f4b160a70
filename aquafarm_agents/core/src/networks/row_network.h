// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "aquafarm/agents/networks/deep_options.h"

namespace aquafarm::agents {

/// The feature network of networks.h for one observation, without libtorch: a call of that costs
/// several times the arithmetic of one row, and more where many nodes share a processor's caches.
/// With finite weights it differs from it by rounding alone.
class RowNetwork {
 public:
  /// Keeps the weights; copies of a policy have one each.
  /// @param features of an observation
  /// @param weights as FlatParameters orders those of MakeNetwork with network=mlp
  /// @throws LogicError when they are not as many as the network has
  RowNetwork(std::size_t features, const DeepOptions& options, std::vector<float> weights);
  /// The values of one observation.
  /// @param features [features]
  /// @returns Q of [kActionCount] actions, until the next call
  const float* Forward(const float* features);

 private:
  const std::vector<float> weights_;
  const Eigen::Index features_;
  const bool dueling_;
  Eigen::VectorXf first_;
  Eigen::VectorXf second_;
  Eigen::VectorXf values_;
  Eigen::VectorXf state_value_;
};

}  // namespace aquafarm::agents
