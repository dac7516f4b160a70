// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The policy head and PPO's loss with its gradient, for rows of network outputs
/// [rows, kActorCriticOutputs]: kActionCount logits, then the value.

#include <Eigen/Core>
#include <cstdint>

#include "aquafarm/grid/action.h"

namespace aquafarm::agents {

inline constexpr std::size_t kActorCriticOutputs = kActionCount + 1;

/// Max log ratio b that is exponentiated. PPO's clipping does not bound the ratio from above if the
/// advantage is negative, so exp() could overflow and cause NaN gradients. For a log ratio x above
/// b, the ratio is therefore replaced by the tangent e^b (1 + x − b). Loss and gradient stay finite
/// and consistent.
inline constexpr float kMaxLogRatio = 3.0F;

/// π(a | s) of many rows. Masked actions have probability 0.
struct ActionDistribution {
  using Table = Eigen::Array<float, Eigen::Dynamic, kActionCount, Eigen::ColMajor>;
  Table log_probs;           ///< [rows, kActionCount]; meaningless where the probability is 0
  Table probs;               ///< [rows, kActionCount]
  Eigen::ArrayXf entropies;  ///< [rows], nats

  /// Computes the distribution from the outputs of a network.
  /// @param outputs [rows, kActorCriticOutputs], row-major
  /// @param masks [rows] allowed actions, at least one in each row
  void Compute(const float* outputs, const ActionMask* masks, std::size_t rows);
};

struct PpoCoefficients {
  float clip{};        ///< ε: clip range of the probability ratio
  float value_clip{};  ///< clip range of the value; 0: not clipped
  float value{};       ///< weight of the value loss
  float entropy{};     ///< weight of the entropy bonus
  float imitation{};   ///< weight of the cross-entropy with the actions of a teacher
};

/// Label of a row for which no teacher chose an action.
inline constexpr std::uint8_t kNoLabel = 255;

/// Recorded data of each row. Every pointer refers to [rows] values.
struct PpoRows {
  const ActionMask* masks{};
  const std::uint8_t* actions{};
  const float* log_probs{};      ///< log π_old(a | s)
  const float* values{};         ///< V_old(s)
  const float* advantages{};     ///< advantages, already normalized if required
  const float* targets{};        ///< value targets
  const float* weights{};        ///< weight of each row in the loss; 0: the row is ignored
  const std::uint8_t* labels{};  ///< actions of a teacher or kNoLabel; null without a teacher
};

/// Terms of the loss, as weighted sums over the rows.
struct PpoLoss {
  double policy{};        ///< −min(ρ A, clip(ρ) A)
  double value{};         ///< ½ (V − target)², optionally clipped; not multiplied by value_coef
  double entropy{};       ///< nats
  double square_error{};  ///< (V − target)²
  double clipped{};       ///< weight of the rows whose policy gradient is 0, usually by clipping
  double Total(const PpoCoefficients& c) const {
    return policy + static_cast<double>(c.value) * value - static_cast<double>(c.entropy) * entropy;
  }
  PpoLoss& operator+=(const PpoLoss& other);
};

/// Computes the loss of rows and its gradient with respect to the outputs. The cross-entropy with a
/// teacher (*kickstarting*, Schmitt et al. 2018, arXiv:1803.03835) is part of the gradient, but not
/// of the returned loss.
/// @param outputs [rows, kActorCriticOutputs], row-major
/// @param distribution receives the distribution of the outputs
/// @param slopes [rows, kActorCriticOutputs] receives the gradient
PpoLoss ComputeLoss(const float* outputs, std::size_t rows, const PpoRows& recorded,
                    const PpoCoefficients& coefficients, ActionDistribution& distribution,
                    float* slopes);

}  // namespace aquafarm::agents
