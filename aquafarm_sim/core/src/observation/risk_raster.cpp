// SPDX-License-Identifier: BSD-3-Clause
#include "observation/risk_raster.h"

#include <cstring>
#include <limits>

#include "aquafarm/base/widest.h"
#include "aquafarm/grid/action.h"

namespace aquafarm {
namespace {

using IntRun = std::int32_t __attribute__((vector_size(kRun * sizeof(std::int32_t))));
using ByteRun = std::uint8_t __attribute__((vector_size(kRun)));

// A box of cells [x0, x1) × [y0, y1) that contains all cells of the map inside a disaster.
struct Box {
  std::int32_t x0, x1, y0, y1;
};

Box ReachedBox(float cx, float cy, float reach, std::int32_t width, std::int32_t height) {
  const auto clamp = [](float value, std::int32_t limit) {
    return static_cast<std::int32_t>(std::min(std::max(value, 0.0F), static_cast<float>(limit)));
  };
  return {clamp(cx - reach, width), clamp(cx + reach + 1.0F, width), clamp(cy - reach, height),
          clamp(cy + reach + 1.0F, height)};
}

constexpr IntRun kLanes = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

// Paints circular rings. The last run of a row may extend past the end of the row and of the plane;
// level 0 leaves the bytes there unchanged.
AQUAFARM_WIDEST
void PaintRings(float cx, float cy, const float* radius_squared, const std::int32_t* levels,
                Box box, std::int32_t width, std::uint8_t* plane) {
  for (std::int32_t x0 = box.x0; x0 < box.x1; x0 += kRun) {
    const IntRun columns = kLanes + x0;
    const FloatRun dx = cx - __builtin_convertvector(columns, FloatRun);
    const FloatRun nowhere = FloatRun{} + std::numeric_limits<float>::infinity();
    const FloatRun dx_squared = columns < width ? dx * dx : nowhere;
    for (std::int32_t y = box.y0; y < box.y1; ++y) {
      const float dy = cy - static_cast<float>(y);
      const FloatRun distance_squared = dx_squared + dy * dy;
      IntRun level = {};
      for (std::int32_t k = kMaxRings; k-- > 0;) {
        level = distance_squared <= radius_squared[k] ? IntRun{} + levels[k] : level;
      }
      const ByteRun painted = __builtin_convertvector(level, ByteRun);
      std::uint8_t* const row = plane + static_cast<std::ptrdiff_t>(y) * width + x0;
      ByteRun present;
      std::memcpy(&present, row, sizeof(present));
      present = painted > present ? painted : present;
      std::memcpy(row, &present, sizeof(present));
    }
  }
}

// Paints rings with a radius per quadrant, cell by cell.
void PaintQuadrants(const ObservableDisaster& disaster, float cx, float cy, Box box,
                    std::int32_t width, std::uint8_t* plane) {
  ObservableDisaster there = disaster;
  there.x = cx;
  there.y = cy;
  for (std::int32_t y = box.y0; y < box.y1; ++y) {
    for (std::int32_t x = box.x0; x < box.x1; ++x) {
      std::uint8_t& cell = plane[y * width + x];
      const float risk = RiskOf(there, static_cast<float>(x), static_cast<float>(y));
      cell = std::max(cell, ToByte(-risk * kRiskScale));
    }
  }
}

/// Displacement per step of each course.
struct CourseMoves {
  FloatRun x{};
  FloatRun y{};
};

CourseMoves MakeCourseMoves() {
  CourseMoves moves;
  for (std::size_t i = 0; i < kMoves.size(); ++i) {
    moves.x[i] = static_cast<float>(kMoves[i].x);
    moves.y[i] = static_cast<float>(kMoves[i].y);
  }
  return moves;
}

const CourseMoves kCourseMoves = MakeCourseMoves();

// Computes the cells of all courses that start at `from`, clamped to the map.
// @param x, y [steps] one run for each step
AQUAFARM_WIDEST
void FollowCourses(Cell from, std::int32_t width, std::int32_t height, std::size_t steps,
                   FloatRun* x, FloatRun* y) {
  const FloatRun zero = {};
  const FloatRun east = zero + static_cast<float>(width - 1);
  const FloatRun north = zero + static_cast<float>(height - 1);
  for (std::size_t step = 0; step < steps; ++step) {
    const auto taken = static_cast<float>(step + 1);
    const FloatRun to_x = static_cast<float>(from.x) + taken * kCourseMoves.x;
    const FloatRun to_y = static_cast<float>(from.y) + taken * kCourseMoves.y;
    x[step] = to_x < zero ? zero : to_x > east ? east : to_x;
    y[step] = to_y < zero ? zero : to_y > north ? north : to_y;
  }
}

// Adds a disaster with circular rings: each cell of the courses keeps the worse risk.
// @param x, y, risk [steps] one run for each step
AQUAFARM_WIDEST
void MaxWithRings(const ObservableDisaster& disaster, float age, std::size_t steps,
                  const FloatRun* x, const FloatRun* y, FloatRun* risk) {
  const auto rings = static_cast<std::size_t>(disaster.rings);
  for (std::size_t step = 0; step < steps; ++step) {
    const float ahead = age + static_cast<float>(step + 1);
    const FloatRun west = disaster.x - (x[step] - ahead * disaster.dx);
    const FloatRun south = disaster.y - (y[step] - ahead * disaster.dy);
    const FloatRun distance_squared = west * west + south * south;
    FloatRun there = {};
    // From the outermost ring inwards, because the innermost ring that contains a cell applies.
    for (std::size_t k = rings; k-- > 0;) {
      const FloatRun inside = FloatRun{} + disaster.risk[k];
      there = distance_squared <= disaster.radius_squared[k] ? inside : there;
    }
    risk[step] = there < risk[step] ? there : risk[step];
  }
}

// Does the same as MaxWithRings for rings with a radius per quadrant, cell by cell.
void MaxWithQuadrants(const ObservableDisaster& disaster, float age, std::size_t steps,
                      const FloatRun* x, const FloatRun* y, FloatRun* risk) {
  for (std::size_t step = 0; step < steps; ++step) {
    const float ahead = age + static_cast<float>(step + 1);
    for (std::int32_t i = 0; i < kCourseCount; ++i) {
      const float there =
          RiskOf(disaster, x[step][i] - ahead * disaster.dx, y[step][i] - ahead * disaster.dy);
      risk[step][i] = std::min(risk[step][i], there);
    }
  }
}

}  // namespace

RiskBrush::RiskBrush(const ObservableDisaster& disaster, std::int32_t width, std::int32_t height)
    : disaster_(disaster), width_(width), height_(height) {
  radius_squared_.fill(-1.0F);
  if (disaster.by_quadrant) return;
  for (std::size_t k = 0; k < static_cast<std::size_t>(disaster.rings); ++k) {
    radius_squared_[k] = disaster.radius_squared[k];
    levels_[k] = ToByte(-disaster.risk[k] * kRiskScale);
  }
}

void RiskBrush::Paint(float ahead, std::uint8_t* plane) const {
  const float cx = disaster_.x + ahead * disaster_.dx;
  const float cy = disaster_.y + ahead * disaster_.dy;
  const Box box = ReachedBox(cx, cy, disaster_.reach(), width_, height_);
  if (disaster_.rings == 0 || box.x0 >= box.x1 || box.y0 >= box.y1) return;
  if (disaster_.by_quadrant) return PaintQuadrants(disaster_, cx, cy, box, width_, plane);
  PaintRings(cx, cy, radius_squared_.data(), levels_.data(), box, width_, plane);
}

LookaheadRisks::LookaheadRisks(const Scenario& scenario, Cell self) {
  FollowCourses(self, scenario.width, scenario.height, kSteps, x_.data(), y_.data());
  if (!scenario.seas || scenario.seas->risk.empty()) return;
  for (std::size_t step = 0; step < kSteps; ++step) {
    for (std::int32_t i = 0; i < kCourseCount; ++i) {
      const auto x = static_cast<std::int32_t>(x_[step][i]);
      risk_[step][i] = scenario.SeaRiskAt({x, static_cast<std::int32_t>(y_[step][i])});
    }
  }
}

void LookaheadRisks::MaxWith(const ObservableDisaster& disaster, float age) {
  if (disaster.by_quadrant) {
    MaxWithQuadrants(disaster, age, kSteps, x_.data(), y_.data(), risk_.data());
  } else {
    MaxWithRings(disaster, age, kSteps, x_.data(), y_.data(), risk_.data());
  }
}

void LookaheadRisks::Write(float* next, float* courses) const {
  const FloatRun first = risk_[0] * kRiskScale;
  FloatRun mean = {};
  for (const FloatRun& risk : risk_) mean += risk * kRiskScale;
  mean /= static_cast<float>(kSteps);
  std::memcpy(next, &first, kMoveCount * sizeof(float));
  std::memcpy(courses, &mean, kCourseCount * sizeof(float));
}

}  // namespace aquafarm
