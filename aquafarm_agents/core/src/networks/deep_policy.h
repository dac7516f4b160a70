// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What the deep learners and their policies share around a libtorch network: observations as
/// tensors, masks of values.

#include <torch/torch.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/agents/networks/deep_options.h"
#include "networks/farm_rows.h"

namespace aquafarm::agents {

/// Where a saved policy plays: what learnt on CUDA need not find it again.
inline std::string PlayingDevice(const std::string& trained_on) {
  return trained_on == "cuda" ? "auto" : trained_on;
}

/// Marks what must not be chosen: 0, or a number far below any value, and finite, so that nothing
/// becomes NaN. @param out [kActionCount]
inline void MarkForbidden(ActionMask allowed, float* out) {
  for (std::size_t a = 0; a < kActionCount; ++a) {
    out[a] = ((allowed >> a) & 1U) != 0 ? 0.0F : -1e9F;
  }
}

/// How much less than the best action that is not forbidden the taken one is worth: what advantage
/// learning takes a share of off its target. @param values [..., kActionCount]
/// @param forbidden likewise, by MarkForbidden @param actions [..., 1] @returns [...]
inline torch::Tensor Shortfall(const torch::Tensor& values, const torch::Tensor& forbidden,
                               const torch::Tensor& actions) {
  return (values + forbidden).amax(-1) - values.gather(-1, actions).squeeze(-1);
}

/// How the network sees: float features, or bytes of planes (255 stands for 1).
template <typename Scalar>
struct Sight;

template <>
struct Sight<float> {
  static std::vector<std::int64_t> Shape(const EnvironmentSpec& spec) {
    return {spec.feature_count};
  }
  static const float* Of(const Results& results) { return results.features.data(); }
  static torch::Tensor ToInput(const float* rows, std::vector<std::int64_t> shape,
                               torch::Device device) {
    return torch::from_blob(const_cast<float*>(rows), shape, torch::kFloat).to(device);
  }
};

template <>
struct Sight<std::uint8_t> {
  static std::vector<std::int64_t> Shape(const EnvironmentSpec& spec) {
    return {spec.plane_count, spec.height, spec.width};
  }
  static const std::uint8_t* Of(const Results& results) { return results.planes.data(); }
  static torch::Tensor ToInput(const std::uint8_t* rows, std::vector<std::int64_t> shape,
                               torch::Device device) {
    return torch::from_blob(const_cast<std::uint8_t*>(rows), shape, torch::kByte)
        .to(device)
        .to(torch::kFloat)
        .div_(255.0F);
  }
};

/// Numbers of one observation.
inline std::size_t ElementCount(const std::vector<std::int64_t>& shape) {
  return static_cast<std::size_t>(
      std::accumulate(shape.begin(), shape.end(), std::int64_t{1}, std::multiplies<>()));
}

/// {count, rest…}
inline std::vector<std::int64_t> WithCount(std::size_t count, std::vector<std::int64_t> rest) {
  rest.insert(rest.begin(), static_cast<std::int64_t>(count));
  return rest;
}

}  // namespace aquafarm::agents
