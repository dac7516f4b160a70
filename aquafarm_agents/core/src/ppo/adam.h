// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "aquafarm/agents/learning/checkpoint.h"

namespace aquafarm::agents {

/// Adam (Kingma and Ba 2015) for a flat parameter vector, with gradient clipping by norm.
class Adam {
 public:
  explicit Adam(std::size_t size) : mean_(size), square_(size) {}

  /// Takes one step against `gradient`. If its norm exceeds `max_norm`, it is first scaled to this
  /// norm.
  /// @param max_norm 0: no limit
  /// @returns false if the norm of the gradient is not finite; nothing is then changed
  [[nodiscard]] bool Step(const std::vector<float>& gradient, double learning_rate, double max_norm,
                          std::vector<float>& weights);
  std::uint64_t steps() const { return steps_; }

  /// Adds sections `adam.mean`, `adam.square` and `adam`.
  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError if sections are missing or have another size; the state is then unchanged
  void Load(const Checkpoint& checkpoint);

 private:
  std::vector<float> mean_;    // moving average of the gradient
  std::vector<float> square_;  // moving average of the squared gradient
  std::uint64_t steps_{};
};

}  // namespace aquafarm::agents
