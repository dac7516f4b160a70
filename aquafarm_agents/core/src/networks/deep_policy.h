// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Helpers of the learners with networks and of their policies: conversion of observations to
/// tensors, and masks of forbidden actions.

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

/// Returns the option `device` with which a saved policy plays. It is auto for a policy that was
/// trained with cuda, so that the policy also plays on a machine without CUDA.
inline std::string PlayingDevice(const std::string& trained_on) {
  return trained_on == "cuda" ? "auto" : trained_on;
}

/// Writes an additive mask: 0 for allowed actions, −1e9 for forbidden ones. Infinite values could
/// lead to NaN. @param out [kActionCount]
inline void MaskLogits(ActionMask allowed, float* out) {
  for (std::size_t a = 0; a < kActionCount; ++a) {
    out[a] = ((allowed >> a) & 1U) != 0 ? 0.0F : -1e9F;
  }
}

/// Returns the advantage gap max_a' Q(s, a') − Q(s, a) of an action a, where a' is allowed.
/// @param values Q(s, ·), [kActionCount]
inline float AdvantageGap(const float* values, ActionMask allowed, std::size_t action) {
  return BestOf(values, allowed).value - values[action];
}

/// Access to observations of type Scalar: float features, or bytes of planes (255 represents 1).
/// Shape() returns the shape of one observation, Of() the observations of all slots. ToInput()
/// converts rows of observations to a float tensor of the given shape.
template <typename Scalar>
struct ObservationTraits;

template <>
struct ObservationTraits<float> {
  static std::vector<std::int64_t> Shape(const EnvironmentSpec& spec) {
    return {spec.feature_count};
  }
  static const float* Of(const StepResults& results) { return results.features.data(); }
  static torch::Tensor ToInput(const float* rows, const std::vector<std::int64_t>& shape,
                               torch::Device device) {
    return torch::from_blob(const_cast<float*>(rows), shape, torch::kFloat).to(device);
  }
};

template <>
struct ObservationTraits<std::uint8_t> {
  static std::vector<std::int64_t> Shape(const EnvironmentSpec& spec) {
    return {spec.plane_count, spec.height, spec.width};
  }
  static const std::uint8_t* Of(const StepResults& results) { return results.planes.data(); }
  static torch::Tensor ToInput(const std::uint8_t* rows, const std::vector<std::int64_t>& shape,
                               torch::Device device) {
    return torch::from_blob(const_cast<std::uint8_t*>(rows), shape, torch::kByte)
        .to(device)
        .to(torch::kFloat)
        .div_(255.0F);
  }
};

/// Returns the number of values of a tensor of this shape.
inline std::size_t ElementCount(const std::vector<std::int64_t>& shape) {
  return static_cast<std::size_t>(
      std::accumulate(shape.begin(), shape.end(), std::int64_t{1}, std::multiplies<>()));
}

/// Returns the shape {count, rest…}.
inline std::vector<std::int64_t> WithCount(std::size_t count, std::vector<std::int64_t> rest) {
  rest.insert(rest.begin(), static_cast<std::int64_t>(count));
  return rest;
}

}  // namespace aquafarm::agents
