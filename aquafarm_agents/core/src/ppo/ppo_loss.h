// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The policy head and PPO's loss with its gradient, for rows of network outputs
/// [rows, kActorCriticOutputs]: kActionCount logits, then the value.

#include <Eigen/Core>
#include <cstdint>

#include "aquafarm/grid/action.h"

namespace aquafarm::agents {

inline constexpr std::size_t kActorCriticOutputs = kActionCount + 1;

/// Max log ratio that is exponentiated. Clipping does not bound the ratio from above if the
/// advantage is negative, so exp() could overflow and cause NaN gradients. Beyond the bound b the
/// ratio continues along its tangent: e^b (1 + x − b). Loss and gradient stay finite and
/// consistent.
inline constexpr float kMaxLogRatio = 3.0F;

/// π(a | s) of many rows; masked actions have probability 0.
struct ActionDistribution {
  using Table = Eigen::Array<float, Eigen::Dynamic, kActionCount, Eigen::ColMajor>;
  Table log_probs;           ///< [rows, kActionCount]; undefined where the probability is 0
  Table probs;               ///< [rows, kActionCount]
  Eigen::ArrayXf entropies;  ///< [rows], nats

  /// @param outputs [rows, kActorCriticOutputs], row-major
  /// @param masks [rows], at least one of kActionCount bits set in each
  void Compute(const float* outputs, const ActionMask* masks, std::size_t rows);
};

struct PpoCoefficients {
  float clip{};
  float value_clip{};  ///< 0: not clipped
  float value{};
  float entropy{};
  float imitation{};  ///< of the cross-entropy with the actions of a teacher
};

/// Label of a row without an action of a teacher.
inline constexpr std::uint8_t kNoLabel = 255;

/// Data recorded for each row when its action was chosen. Pointers to [rows].
struct PpoRows {
  const ActionMask* masks{};
  const std::uint8_t* actions{};
  const float* log_probs{};      ///< log π_old(a | s)
  const float* values{};         ///< V_old(s)
  const float* advantages{};     ///< as used in the loss, optionally normalised
  const float* targets{};        ///< value targets
  const float* weights{};        ///< of the row in the loss; 0: the row is ignored
  const std::uint8_t* labels{};  ///< actions of a teacher or kNoLabel; null without a teacher
};

/// Weighted sums over the rows.
struct PpoLoss {
  double policy{};        ///< −min(ρ A, clip(ρ) A)
  double value{};         ///< ½ (V − target)², optionally clipped; not multiplied by value_coef
  double entropy{};       ///< nats
  double square_error{};  ///< (V − target)²
  double clipped{};       ///< fraction of rows whose policy gradient is 0 because of clipping
  double Total(const PpoCoefficients& c) const {
    return policy + static_cast<double>(c.value) * value - static_cast<double>(c.entropy) * entropy;
  }
  PpoLoss& operator+=(const PpoLoss& other);
};

/// Computes the loss of rows and its gradient with respect to the outputs. The gradient, but not
/// the returned loss, contains the cross-entropy with a teacher (*kickstarting*, Schmitt et al.
/// 2018, arXiv:1803.03835).
/// @param outputs [rows, kActorCriticOutputs], row-major
/// @param slopes [rows, kActorCriticOutputs]: d total / d outputs, overwritten
/// @param distribution scratch
PpoLoss ComputeLoss(const float* outputs, std::size_t rows, const PpoRows& recorded,
                    const PpoCoefficients& coefficients, ActionDistribution& distribution,
                    float* slopes);

}  // namespace aquafarm::agents
