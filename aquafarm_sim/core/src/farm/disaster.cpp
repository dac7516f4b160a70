// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/disaster.h"

#include <algorithm>

#include "aquafarm/base/angle.h"
#include "aquafarm/base/check.h"
#include "aquafarm/grid/action.h"

namespace aquafarm {
namespace {

struct SineCosine {
  double sine{};
  double cosine{};
};

// Returns sine and cosine of an angle in [0, 45] degrees. On this range nine terms of each Taylor
// series are exact to double precision. The series uses only +, * and /, so results are
// bit-identical on every machine. libm does not guarantee this.
SineCosine OfFirstOctant(int degrees) {
  const double x = degrees * kRadiansPerDegree;
  double sine = 0.0;
  double cosine = 0.0;
  double term = 1.0;
  for (int power = 0; power < 18; ++power) {
    const double sign = (power / 2) % 2 == 0 ? 1.0 : -1.0;
    (power % 2 == 0 ? cosine : sine) += sign * term;
    term = term * x / (power + 1);
  }
  return {sine, cosine};
}

std::array<std::array<float, 2>, 360> MakeHeadings() {
  std::array<std::array<float, 2>, 360> headings{};
  for (int degrees = 0; degrees < 360; ++degrees) {
    const int quadrant = degrees / 90;
    const int within = degrees % 90;
    SineCosine value = OfFirstOctant(within <= 45 ? within : 90 - within);
    if (within > 45) std::swap(value.sine, value.cosine);
    const auto sine = static_cast<float>(value.sine);
    const auto cosine = static_cast<float>(value.cosine);
    // The east component is the sine of a compass bearing and the north component its cosine.
    constexpr float kZero = 0.0F;  // 0 - x instead of -x avoids -0 in the table
    switch (quadrant) {
      case 0:
        headings[static_cast<std::size_t>(degrees)] = {sine, cosine};
        break;
      case 1:
        headings[static_cast<std::size_t>(degrees)] = {cosine, kZero - sine};
        break;
      case 2:
        headings[static_cast<std::size_t>(degrees)] = {kZero - sine, kZero - cosine};
        break;
      default:
        headings[static_cast<std::size_t>(degrees)] = {kZero - cosine, sine};
        break;
    }
  }
  return headings;
}

// Sets the displacement per step from heading and speed.
void SetMotion(ObservableDisaster& disaster) {
  const std::array<float, 2> direction = HeadingVector(disaster.heading_deg);
  disaster.dx = direction[0] * disaster.speed;
  disaster.dy = direction[1] * disaster.speed;
}

// Returns the squared radius of a ring. A ring of radius 0 is absent and gets -1, so that no
// squared distance is within it.
float Squared(float radius) { return radius > 0.0F ? radius * radius : -1.0F; }

// Sets all rings to those of a waypoint or spec.
void SetRings(ObservableDisaster& disaster, const std::vector<float>& radii,
              const std::vector<QuadrantRadii>& quadrants) {
  disaster.by_quadrant = !quadrants.empty();
  for (std::size_t k = 0; k < radii.size(); ++k) {
    if (disaster.by_quadrant) {
      SetRing(disaster, k, quadrants[k]);
    } else {
      SetRing(disaster, k, radii[k]);
    }
  }
}

// Sets the state that is constant on the leg after a waypoint: index of the waypoint, grade,
// displacement, speed and heading. The heading is rounded to the nearest whole degree. Displays and
// bulletins use speed and heading.
void EnterLeg(ObservableDisaster& disaster, const std::vector<Waypoint>& track,
              std::size_t waypoint) {
  disaster.waypoint = static_cast<std::int32_t>(waypoint);
  const Waypoint& from = track[waypoint];
  const Waypoint& to = track[std::min(waypoint + 1, track.size() - 1)];
  disaster.grade = from.grade;
  const float span = to.step - from.step;
  disaster.dx = span > 0.0F ? (to.x - from.x) / span : 0.0F;
  disaster.dy = span > 0.0F ? (to.y - from.y) / span : 0.0F;
  disaster.speed = 0.0F;
  for (std::int32_t heading = 0; heading < 360; ++heading) {
    const std::array<float, 2> direction = HeadingVector(heading);
    const float along = direction[0] * disaster.dx + direction[1] * disaster.dy;
    if (along <= disaster.speed) continue;
    disaster.speed = along;
    disaster.heading_deg = heading;
  }
}

// Reflects a coordinate outside [low, high] at the border, and the heading with it. A coordinate
// may already be outside before the step, for example after SetDisaster. Such a disaster continues
// unless it moves farther away. If it moves farther away, the coordinate keeps its old value in
// this step, and the heading is reflected.
// @param mirror sum of the heading and the reflected heading [degrees]: 360 for x, 180 for y
void Bounce(float& position, float before, float low, float high, std::int32_t mirror,
            Disaster& disaster) {
  const bool below = position < low;
  if (before < low || before > high) {
    if (below ? position >= before : position <= before) return;
    position = before;
  } else {
    position = below ? low + (low - position) : high - (position - high);
    position = std::min(std::max(position, low), high);
  }
  disaster.heading_deg = (mirror - disaster.heading_deg + 720) % 360;
  SetMotion(disaster);
}

// Returns the wrapped coordinate: a coordinate outside [low, high] is moved to the opposite side.
float Wrapped(float position, float low, float high) {
  if (position < low) return std::min(position + (high - low), high);
  if (position > high) return std::max(position - (high - low), low);
  return position;
}

// Applies the border to a disaster that has moved.
void MeetBorder(Disaster& disaster, float x_before, float y_before, std::int32_t width,
                std::int32_t height) {
  if (disaster.border == Border::kLeave) return;
  const float low = -0.5F - disaster.margin;
  const float high_x = static_cast<float>(width) - 0.5F + disaster.margin;
  const float high_y = static_cast<float>(height) - 0.5F + disaster.margin;
  if (disaster.border == Border::kWrap) {
    disaster.x = Wrapped(disaster.x, low, high_x);
    disaster.y = Wrapped(disaster.y, low, high_y);
    return;
  }
  const auto is_outside = [low](float position, float high) {
    return position < low || position > high;
  };
  if (is_outside(disaster.x, high_x)) Bounce(disaster.x, x_before, low, high_x, 360, disaster);
  if (is_outside(disaster.y, high_y)) Bounce(disaster.y, y_before, low, high_y, 180, disaster);
}

// With its turn probability, turns a disaster by 45 degrees to a random side.
void Turn(Disaster& disaster, const StreamKey& turn_key, std::int32_t step) {
  if (disaster.turn_threshold == 0) return;
  const auto count = static_cast<std::uint32_t>(step);
  if (count % 4 == 0 || count == 1) disaster.draws = Draw(turn_key, count / 4);
  const std::uint32_t draw = disaster.draws[count % 4];
  if ((draw >> 1U) >= disaster.turn_threshold) return;
  disaster.heading_deg = (disaster.heading_deg + ((draw & 1U) != 0 ? 45 : 315)) % 360;
  SetMotion(disaster);
}

}  // namespace

void SetRing(ObservableDisaster& disaster, std::size_t ring, float radius) {
  disaster.radius[ring] = radius;
  disaster.radius_squared[ring] = Squared(radius);
}

void SetRing(ObservableDisaster& disaster, std::size_t ring, const QuadrantRadii& radii) {
  SetRing(disaster, ring, *std::max_element(radii.begin(), radii.end()));
  for (std::size_t q = 0; q < radii.size(); ++q) disaster.quadrant[q][ring] = radii[q];
}

float RiskByQuadrant(const ObservableDisaster& disaster, float west, float south,
                     float distance_squared) {
  const auto& radii = disaster.quadrant[QuadrantOf(west, south)];
  for (std::size_t k = 0; k < static_cast<std::size_t>(disaster.rings); ++k) {
    if (distance_squared <= Squared(radii[k])) return disaster.risk[k];
  }
  return 0.0F;
}

void GrowRings(ObservableDisaster& disaster, float by) {
  if (by == 0.0F) return;
  const auto grown = [by](float radius) { return std::max(0.0F, radius + by); };
  for (std::size_t k = 0; k < static_cast<std::size_t>(disaster.rings); ++k) {
    if (disaster.by_quadrant) {
      QuadrantRadii radii{};
      for (std::size_t q = 0; q < radii.size(); ++q) {
        const float radius = disaster.quadrant[q][k];
        radii[q] = radius > 0.0F ? grown(radius) : 0.0F;  // an absent quadrant stays absent
      }
      SetRing(disaster, k, radii);
    } else {
      SetRing(disaster, k, grown(disaster.radius[k]));
    }
  }
}

std::array<float, 2> HeadingVector(std::int32_t heading_deg) {
  static const std::array<std::array<float, 2>, 360> kHeadings = MakeHeadings();
  AQUAFARM_CHECK_GE(heading_deg, 0);
  AQUAFARM_CHECK_LT(heading_deg, 360);
  return kHeadings[static_cast<std::size_t>(heading_deg)];
}

Disaster SpawnDisaster(const DisasterSpec& spec, std::int32_t id, std::uint64_t seed,
                       std::uint64_t episode, std::int32_t width, std::int32_t height,
                       const std::vector<Waypoint>* track) {
  Disaster disaster;
  disaster.kind = spec.kind;
  disaster.border = spec.border;
  disaster.grade = spec.grade;
  disaster.rings = static_cast<std::int32_t>(spec.radii.size());
  SetRings(disaster, spec.radii, spec.quadrants);
  const GradeRisks by_grade = spec.grade_factors.empty() ? GradeRisks{} : RisksByGrade(spec);
  const std::vector<float>& risks =
      by_grade.empty() ? spec.risks : by_grade[static_cast<std::size_t>(spec.grade - 1)];
  std::copy(risks.begin(), risks.end(), disaster.risk.begin());
  disaster.speed = spec.speed;
  disaster.turn_threshold =
      static_cast<std::uint32_t>(static_cast<double>(spec.turn_probability) * 2147483648.0);
  disaster.radius_growth = spec.radius_growth;
  disaster.margin = disaster.reach();
  disaster.steps_left = spec.duration;
  RandomStream rng({seed, episode, RngStream::kDisasterSpawn, static_cast<std::uint32_t>(id)});
  const float margin = disaster.margin;
  // All three are drawn even if the spec sets some of them, so that the other draws stay the same.
  const float x = rng.Uniform(-0.5F - margin, static_cast<float>(width) - 0.5F + margin);
  const float y = rng.Uniform(-0.5F - margin, static_cast<float>(height) - 0.5F + margin);
  const auto heading = static_cast<std::int32_t>(rng.Below(360));
  disaster.x = spec.start ? (*spec.start)[0] : x;
  disaster.y = spec.start ? (*spec.start)[1] : y;
  disaster.heading_deg = spec.heading_deg.value_or(heading);
  SetMotion(disaster);
  const std::vector<Waypoint>& followed = track != nullptr ? *track : spec.track;
  if (!followed.empty()) {
    disaster.waypoint = 0;
    FollowTrack(disaster, followed, 0);
  }
  return disaster;
}

void MoveDisaster(Disaster& disaster, const Track& track, const StreamKey& turn_key,
                  std::int32_t step, std::int32_t width, std::int32_t height) {
  if (!disaster.active()) return;
  --disaster.steps_left;
  if (disaster.waypoint != kNone) {
    FollowTrack(disaster, *track, step);
    return;
  }
  Turn(disaster, turn_key, step);
  const float x_before = disaster.x;
  const float y_before = disaster.y;
  disaster.x += disaster.dx;
  disaster.y += disaster.dy;
  MeetBorder(disaster, x_before, y_before, width, height);
  GrowRings(disaster, disaster.radius_growth);
}

void FollowTrack(ObservableDisaster& disaster, const std::vector<Waypoint>& track,
                 std::int32_t step) {
  const auto now = static_cast<float>(step);
  auto last = static_cast<std::size_t>(disaster.waypoint);
  while (last + 1 < track.size() && track[last + 1].step <= now) ++last;
  if (static_cast<std::int32_t>(last) != disaster.waypoint || step == 0) {
    EnterLeg(disaster, track, last);
  }
  const Waypoint& from = track[last];
  const Waypoint& to = track[std::min(last + 1, track.size() - 1)];
  const float span = to.step - from.step;
  const float part = span > 0.0F ? std::min(std::max((now - from.step) / span, 0.0F), 1.0F) : 0.0F;
  const auto between = [part](float a, float b) { return a + (b - a) * part; };
  disaster.x = between(from.x, to.x);
  disaster.y = between(from.y, to.y);
  disaster.by_quadrant = !from.quadrants.empty();
  for (std::size_t k = 0; k < from.radii.size(); ++k) {
    disaster.risk[k] = between(from.risks[k], to.risks[k]);
    if (!disaster.by_quadrant) {
      SetRing(disaster, k, between(from.radii[k], to.radii[k]));
      continue;
    }
    QuadrantRadii radii{};
    for (std::size_t q = 0; q < radii.size(); ++q) {
      radii[q] = between(from.quadrants[k][q], to.quadrants[k][q]);
    }
    SetRing(disaster, k, radii);
  }
}

void FillRisk(const Scenario& scenario, const std::vector<Disaster>& disasters, Grid<float>& risk) {
  for (std::int32_t y = 0; y < risk.rows(); ++y) {
    for (std::int32_t x = 0; x < risk.cols(); ++x) {
      risk(y, x) = std::min(RiskAt(disasters, {x, y}), scenario.SeaRiskAt({x, y}));
    }
  }
}

void FillRisks(const Scenario& scenario, const std::vector<Disaster>& disasters, Grid<float>& risk,
               DamagingRisks& by_kind) {
  FillRisk(scenario, disasters, risk);
  for (std::size_t kind = 0; kind < by_kind.size(); ++kind) {
    Grid<float>& damaging = by_kind[kind];
    if (damaging.size() == 0) continue;
    const auto& factors = scenario.damage.kinds[kind];
    for (Eigen::Index y = 0; y < risk.rows(); ++y) {
      for (Eigen::Index x = 0; x < risk.cols(); ++x) {
        // Shortcuts: most cells have no risk. With a single disaster and no sea, the risk only has
        // to be multiplied by one factor.
        const Cell cell{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
        const float worst = risk(y, x);
        const bool is_alone = disasters.size() == 1 && !scenario.seas;
        damaging(y, x) = worst == 0.0F ? 0.0F
                         : is_alone ? worst * factors[static_cast<std::size_t>(disasters[0].kind)]
                                    : std::min(DamagingRiskAt(disasters, cell, factors),
                                               scenario.SeaRiskAt(cell));
      }
    }
  }
}

}  // namespace aquafarm
