// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Generalized advantage estimation (Schulman et al. 2016, Eq. 16) over a rollout:
///
///   δ_t = r_t + γ V(s_{t+1}) − V(s_t)
///   A_t = δ_t + γ λ A_{t+1}
///
///   kContinues      these equations; A_{t+1} = 0 at the last step of the rollout
///   kTruncated      A_{t+1} = 0; V(s_{t+1}) is the value of the episode's last observation
///   kTerminated     A_{t+1} = 0 and V(s_{t+1}) = 0
///   kNoTransition   A_t = 0; the sample is excluded from training

#include <cstddef>
#include <cstdint>
#include <vector>

namespace aquafarm::agents {

/// What follows a step of an agent: another step, the end of the episode, or no transition.
enum class StepEnd : std::uint8_t { kContinues, kTruncated, kTerminated, kNoTransition };
inline constexpr int kStepEndCount = 4;

/// Computes the advantages of T = ends.size() / slots steps of E = slots agents. All arrays are
/// time-major.
/// @param rewards [T, E] reward that follows each action
/// @param values [T + 1, E] value of each observation; the last row bootstraps the last step
/// @param ends [T, E]
/// @param advantages is resized to [T, E]
void EstimateAdvantages(const std::vector<float>& rewards, const std::vector<float>& values,
                        const std::vector<StepEnd>& ends, std::size_t slots, float gamma,
                        float lambda, std::vector<float>& advantages);

}  // namespace aquafarm::agents
