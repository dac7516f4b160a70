// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Generalized advantage estimation (Schulman et al. 2016, Eq. 16) over a rollout:
///
///   δ_t = r_t + γ V(s_{t+1}) − V(s_t)
///   A_t = δ_t + γ λ A_{t+1}
///
///   kContinues      both terms as above
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

/// Computes the advantages of `ends.size() / slots` steps. All arrays are time-major.
/// @param rewards [T, E] after the action of a sample
/// @param values [T + 1, E] of the observations; the last row is the bootstrap
/// @param ends [T, E]
/// @param advantages [T, E], resized
void EstimateAdvantages(const std::vector<float>& rewards, const std::vector<float>& values,
                        const std::vector<StepEnd>& ends, std::size_t slots, float gamma,
                        float lambda, std::vector<float>& advantages);

}  // namespace aquafarm::agents
