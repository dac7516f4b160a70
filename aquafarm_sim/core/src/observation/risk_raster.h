// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Computes the risk of disasters at many cells, for encodings. Finds the same rings as RiskOf,
/// because it compares the same floats. Processes runs of cells at once with the vector extensions
/// of GCC and Clang. § refers to the paper, see docs/model.md.

#include <algorithm>
#include <array>
#include <cstdint>

#include "aquafarm/farm/disaster.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// 1 / |worst risk| of §2.1.
inline constexpr float kRiskScale = 1.0F / 20.0F;

/// Clamps a number to [0, 1] and scales it to a byte in [0, 255].
inline std::uint8_t ToByte(float part) {
  return static_cast<std::uint8_t>(std::min(std::max(part, 0.0F), 1.0F) * 255.0F + 0.5F);
}

/// Number of cells that are processed together.
inline constexpr std::int32_t kRun = 16;
using FloatRun = float __attribute__((vector_size(kRun * sizeof(float))));

/// Paints the risk of one disaster on planes of bytes [H, W]; 255 is the worst risk.
class RiskBrush {
 public:
  /// @param disaster must outlive the brush
  RiskBrush(const ObservableDisaster& disaster, std::int32_t width, std::int32_t height);

  /// Paints the disaster where it is after `ahead` steps of its motion. Each cell keeps the worse
  /// of its previous risk and the risk of the disaster.
  /// @param plane [H, W], followed by at least kRun - 1 bytes of the same buffer. Paint may read
  ///   these bytes and write them back unchanged.
  void Paint(float ahead, std::uint8_t* plane) const;

 private:
  const ObservableDisaster& disaster_;
  std::int32_t width_;
  std::int32_t height_;
  std::array<float, kMaxRings> radius_squared_;
  std::array<std::int32_t, kMaxRings> levels_{};
};

/// Number of courses. A course repeats one of the moves; on the last course, the ship stays in its
/// cell.
inline constexpr std::int32_t kCourseCount = kMoveCount + 1;
static_assert(kCourseCount <= kRun);

/// Risks at the cells of each course of a ship, if every disaster keeps its motion.
class LookaheadRisks {
 public:
  /// Computes the courses from `self` and sets their risks to those of the sea. Clamps x and y to
  /// the map: a diagonal course that reaches an edge continues along the edge.
  LookaheadRisks(const Scenario& scenario, Cell self);

  /// Adds a disaster whose state was observed `age` steps ago; each cell keeps the worse risk.
  void MaxWith(const ObservableDisaster& disaster, float age);

  /// Writes the risks, 0 or negative; −1 is the worst risk of §2.1.
  /// @param next [kMoveCount] risk after one step of each move
  /// @param courses [kCourseCount] mean risk of each course
  void Write(float* next, float* courses) const;

 private:
  inline static constexpr std::size_t kSteps = 6;  // number of steps of a course

  // Cell and risk after each step. A run has one lane per course; the other lanes are unused.
  std::array<FloatRun, kSteps> x_;
  std::array<FloatRun, kSteps> y_;
  std::array<FloatRun, kSteps> risk_{};
};

}  // namespace aquafarm
