// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/storms/to_disaster.h"

#include <algorithm>
#include <cmath>

#include "aquafarm/base/check.h"
#include "aquafarm/tracks/fine_rings.h"
#include "aquafarm/tracks/place_storm.h"
#include "base/text.h"
#include "base/time.h"

namespace aquafarm {

std::int32_t StepsToCover(double span_s, double step_duration_s) {
  const double steps = std::ceil(span_s / step_duration_s);
  if (steps <= 1.0e7) return std::max(1, static_cast<std::int32_t>(std::max(steps, 1.0)));
  throw InputError("duration: got " + internal::Format(steps) +
                   " steps, expected at most 10000000; use longer steps");
}

const GradeRisks& DefaultGradeRisks() {
  static const GradeRisks kTable{{-14.0F, -8.0F, -5.0F},
                                 {-16.0F, -9.0F, -5.0F},
                                 {-20.0F, -10.0F, -5.0F},
                                 {-20.0F, -12.0F, -6.0F}};
  return kTable;
}

DisasterSpec ToDisaster(const StormRings& storm, const GradeRisks& risks, const GeoFrame& frame,
                        double cell_size_m, double step_duration_s, std::int64_t start_time) {
  DisasterSpec disaster;
  disaster.kind = DisasterKind::kTyphoon;
  StormPlacer placer;
  disaster.track =
      placer.Place(ToPath(storm, frame, cell_size_m, step_duration_s, start_time), {}, risks);
  const Waypoint& first = disaster.track.front();
  disaster.grade = first.grade;
  disaster.radii = first.radii;
  disaster.risks = first.risks;
  disaster.quadrants = first.quadrants;
  disaster.grade_risks = risks;
  disaster.duration = StepsToCover(static_cast<double>(disaster.track.back().step), 1.0);
  return disaster;
}

DisasterSpec ToDisaster(const StormTrack& bulletin, const Scenario& scenario, std::int32_t id,
                        std::int32_t step_now) {
  if (!scenario.origin || !scenario.start_time) {
    throw InputError("bulletin: needs a ranch with grid.origin and time.start");
  }
  const auto graded = [](const DisasterSpec& one) {
    return !one.grade_risks.empty() || !one.grade_factors.empty();
  };
  const auto& all = scenario.disasters;
  auto model = all.begin() + std::min(id, static_cast<std::int32_t>(all.size()));
  const bool by_quadrant = model != all.end() && !model->quadrants.empty();
  if (model == all.end() || !graded(*model)) model = std::find_if(all.begin(), all.end(), graded);
  const StormTrack whole = WithForecast(bulletin, NoForecast::kPersist);
  const auto now_s = static_cast<std::int64_t>(step_now * scenario.step_duration_s);
  const StormRings storm =
      ToFineRings(whole, by_quadrant ? RingReduction::kQuadrants : RingReduction::kEqualArea,
                  *scenario.start_time + now_s)
          .storm;
  DisasterSpec disaster =
      ToDisaster(storm, model == all.end() ? DefaultGradeRisks() : RisksByGrade(*model),
                 GeoFrame(*scenario.origin, scenario.cell_size_m), scenario.cell_size_m,
                 scenario.step_duration_s, *scenario.start_time);
  const double left = std::ceil(static_cast<double>(disaster.track.back().step)) - step_now;
  if (left <= 0.0) {
    throw InputError("bulletin: got a storm " + Describe(KnowledgeOf(bulletin, whole)) +
                     ", expected one that is known after step " + std::to_string(step_now) + " (" +
                     internal::FormatTime(*scenario.start_time + now_s) +
                     "); send a newer bulletin");
  }
  disaster.duration = StepsToCover(left, 1.0);
  const StormKnowledge known = KnowledgeOf(bulletin, whole);
  if (known.issued == 0) return disaster;
  IssuedForecast forecast;
  forecast.step = static_cast<float>(
      static_cast<double>(known.recorded_until - *scenario.start_time) / scenario.step_duration_s);
  for (const Waypoint& point : disaster.track) {
    if (point.step > forecast.step) forecast.points.push_back(point);
  }
  if (!forecast.points.empty()) disaster.forecasts = {forecast};
  return disaster;
}

}  // namespace aquafarm
