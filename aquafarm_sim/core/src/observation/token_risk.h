// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Computes the forecast risk that entity tokens contain (observation/tokens.h). Assumes that every
/// known disaster keeps its motion and its size until it ends.

#include <algorithm>
#include <array>
#include <cmath>

#include "aquafarm/observation/view.h"
#include "aquafarm/scenario/limits.h"
#include "observation/risk_raster.h"

namespace aquafarm {

/// Steps until the largest ring of a disaster reaches a cell, and until it has left the cell.
struct RingTimes {
  float in{-1.0F};   ///< 0: the cell is inside now; -1: it is never inside
  float out{-1.0F};  ///< at most the steps until the disaster ends; -1: the cell is never inside
};

/// The known disasters of a view that have not ended.
class TokenRisk {
 public:
  explicit TokenRisk(const View& view) : scenario_(*view.scenario) {
    for (const KnownDisaster& known : view.disasters) {
      if (known.known && known.belief.active()) disasters_[count_++] = &known;
    }
    has_sea_ = scenario_.seas && !scenario_.seas->risk.empty();
  }

  /// Returns true if no known disaster is active and the scenario has no layer of sea risk. Returns
  /// false if it has a layer, even if the layer is 0 everywhere.
  bool is_calm() const { return count_ == 0 && !has_sea_; }
  std::size_t count() const { return count_; }
  const KnownDisaster& disaster(std::size_t i) const { return *disasters_[i]; }

  /// Returns the worst risk of sea and disasters at a cell of the map after `ahead` steps, in
  /// [0, 1]; 1 is kWorstRisk.
  float At(Cell cell, float ahead) const {
    float worst = has_sea_ ? scenario_.SeaRiskAt(cell) : 0.0F;
    for (std::size_t i = 0; i < count_; ++i) {
      const ObservableDisaster& belief = disasters_[i]->belief;
      const float moved = ahead + static_cast<float>(disasters_[i]->age);
      if (ahead >= static_cast<float>(belief.steps_left)) continue;  // the disaster has ended
      worst = std::min(worst, RiskOf(belief, static_cast<float>(cell.x) - moved * belief.dx,
                                     static_cast<float>(cell.y) - moved * belief.dy));
    }
    return -worst * kRiskScale;
  }

  /// Returns true only if no disaster can reach a ship that starts at `from` and moves for `steps`
  /// steps. The check uses an upper bound of the reach, so it may return false although no disaster
  /// can reach the ship. Always returns false if the scenario has a layer of sea risk.
  bool IsCalmWithin(Cell from, std::int32_t steps) const {
    constexpr float kLongestMove = 1.4142136F;
    if (has_sea_) return false;
    for (std::size_t i = 0; i < count_; ++i) {
      const ObservableDisaster& belief = disasters_[i]->belief;
      const float speed = std::sqrt(belief.dx * belief.dx + belief.dy * belief.dy);
      const auto taken = static_cast<float>(steps);
      const float range = belief.reach() + taken * kLongestMove +
                          (taken + static_cast<float>(disasters_[i]->age)) * speed;
      const float east = belief.x - static_cast<float>(from.x);
      const float north = belief.y - static_cast<float>(from.y);
      if (east * east + north * north <= range * range) return false;
    }
    return true;
  }

  /// Returns the times of the disaster that reaches the cell first. Both are -1 if no disaster
  /// reaches it.
  RingTimes RingsAt(Cell cell) const {
    RingTimes first;
    for (std::size_t i = 0; i < count_; ++i) {
      const RingTimes times = TimesOf(*disasters_[i], cell);
      if (times.in >= 0.0F && (first.in < 0.0F || times.in < first.in)) first = times;
    }
    return first;
  }

  /// Returns the times of one disaster: the solutions t of |c + v·t − cell| = r before the disaster
  /// ends. c is its centre now, extrapolated from its last known position. v is its motion per step
  /// and r its largest radius.
  static RingTimes TimesOf(const KnownDisaster& known, Cell cell) {
    const ObservableDisaster& belief = known.belief;
    const auto age = static_cast<float>(known.age);
    const auto last = static_cast<float>(belief.steps_left);
    const float px = belief.x + age * belief.dx - static_cast<float>(cell.x);
    const float py = belief.y + age * belief.dy - static_cast<float>(cell.y);
    const float a = belief.dx * belief.dx + belief.dy * belief.dy;
    const float b = px * belief.dx + py * belief.dy;
    const float c = px * px + py * py - belief.reach() * belief.reach();
    RingTimes times;
    if (c <= 0.0F) {
      times.in = 0.0F;
      times.out = a > 0.0F ? std::min(last, (-b + std::sqrt(b * b - a * c)) / a) : last;
      return times;
    }
    const float root = b * b - a * c;
    if (a <= 0.0F || b >= 0.0F || root < 0.0F) return times;
    const float in = (-b - std::sqrt(root)) / a;
    if (in >= last) return times;
    times.in = in;
    times.out = std::min(last, (-b + std::sqrt(root)) / a);
    return times;
  }

 private:
  const Scenario& scenario_;
  std::array<const KnownDisaster*, static_cast<std::size_t>(kMaxDisasters)> disasters_{};
  std::size_t count_{};
  bool has_sea_{};
};

}  // namespace aquafarm
