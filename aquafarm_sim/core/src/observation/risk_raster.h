// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The risk of disasters at many cells at once, for encodings: the same float comparisons as
/// RiskOf, but a run of cells at a time, as vectors of GCC and Clang.

#include <algorithm>
#include <array>
#include <cstdint>

#include "aquafarm/farm/disaster.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// 1 / the worst risk of §2.1.
inline constexpr float kRiskScale = 1.0F / 20.0F;

/// [0, 1] as a byte.
inline std::uint8_t ToByte(float part) {
  return static_cast<std::uint8_t>(std::min(std::max(part, 0.0F), 1.0F) * 255.0F + 0.5F);
}

/// Cells that are looked at together.
inline constexpr std::int32_t kRun = 16;
using FloatRun = float __attribute__((vector_size(kRun * sizeof(float))));

/// Paints one disaster's risk on planes [H, W] of bytes, 255 for the worst.
class RiskBrush {
 public:
  /// @param disaster must outlive the brush
  RiskBrush(const ObservableDisaster& disaster, std::int32_t width, std::int32_t height);

  /// Paints it `ahead` steps along its present heading; the worse is kept where one lies already.
  /// @param plane may be read and written back unchanged up to kRun - 1 bytes past its end
  void Paint(float ahead, std::uint8_t* plane) const;

 private:
  const ObservableDisaster& disaster_;
  std::int32_t width_;
  std::int32_t height_;
  std::array<float, kMaxRings> radius_squared_;
  std::array<std::int32_t, kMaxRings> levels_{};
};

/// The moves' courses and, last, staying.
inline constexpr std::int32_t kCourseCount = kMoveCount + 1;
static_assert(kCourseCount <= kRun);

/// What a ship would meet on each course, every disaster holding its motion.
class CourseRisks {
 public:
  /// Where the courses lead from `self`, at the risk of the sea; the map's edge stops a ship.
  CourseRisks(const Scenario& scenario, Cell self);

  /// Takes a disaster as it was known `age` steps ago where it is worse.
  void Worsen(const ObservableDisaster& disaster, float age);

  /// @param next [kMoveCount] risk after one step of each move @param courses [kCourseCount] mean
  /// risk of each course; both 1 for the worst of §2.1
  void Write(float* next, float* courses) const;

 private:
  inline static constexpr std::size_t kSteps = 6;  // as far as a course is looked along

  // Step by step, a course a lane; the lanes that are left over count for nothing.
  std::array<FloatRun, kSteps> x_;
  std::array<FloatRun, kSteps> y_;
  std::array<FloatRun, kSteps> risk_{};
};

}  // namespace aquafarm
