// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/rescue/ensemble.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/disaster.h"
#include "rescue/storm_member.h"

namespace aquafarm::agents {

/// Fills the arrays of an ensemble, member by member.
class EnsembleBuilder {
 public:
  EnsembleBuilder(const CentralForecast& forecast, const std::vector<Cell>& sites,
                  Ensemble& ensemble)
      : forecast_(forecast),
        sites_(sites),
        out_(ensemble),
        sampler_(forecast, ensemble.options_),
        width_(ensemble.options_.width),
        height_(ensemble.options_.height),
        cells_(static_cast<std::size_t>(width_ * height_)),
        members_(static_cast<std::size_t>(ensemble.members())),
        first_(static_cast<std::size_t>(ensemble.rings_) * cells_ * members_,
               Ensemble::kNoArrival) {
    const auto rings = static_cast<std::size_t>(out_.rings_);
    const auto steps = static_cast<std::size_t>(out_.steps());
    out_.covered_.assign(rings * steps * cells_, 0);
    out_.touching_.assign(rings * steps, 0);
    out_.exposure_.assign(sites.size() * steps * members_, 0.0F);
    out_.risk_sum_.assign(steps * cells_, 0.0F);
    everywhere_.assign(rings * steps, 0);
    risk_everywhere_.assign(steps, 0.0F);
    Locate();
  }

  void Run() {
    const std::size_t points = forecast_.path.points.size();
    std::vector<std::vector<StormErrors>> errors;
    for (std::size_t member = 0; member < members_; ++member) {
      sampler_.Draw(static_cast<std::int32_t>(member), states_);
      errors.push_back(sampler_.errors());
      for (std::int32_t step = 0; step < out_.steps(); ++step) AddStep(member, step);
    }
    AddEverywhere();
    AddUpExposure();
    Transpose();
    for (std::size_t i = 0; i < points; ++i) AddSpread(i, errors);
  }

 private:
  // Finds the leg of the track at each step.
  void Locate() {
    const auto& points = forecast_.path.points;
    for (std::int32_t step = 0; step < out_.steps(); ++step) {
      std::size_t next = 0;
      while (next < points.size() && points[next].step <= step) ++next;
      const std::size_t from = next == 0 ? 0 : next - 1;
      const std::size_t to = std::min(next, points.size() - 1);
      const double span = points[to].step - points[from].step;
      const double part = span > 0.0 ? (step - points[from].step) / span : 0.0;
      legs_.push_back({from, to, static_cast<float>(std::clamp(part, 0.0, 1.0))});
    }
  }

  void AddStep(std::size_t member, std::int32_t step) {
    const Leg& leg = legs_[static_cast<std::size_t>(step)];
    const StormState storm = Between(states_[leg.from], states_[leg.to], leg.part,
                                     static_cast<std::size_t>(out_.rings_));
    for (std::int32_t ring = out_.rings_; ring-- > 0;) {  // the widest ring first
      if (!AddRing(member, step, ring, storm)) break;  // inner rings do not reach the ranch either
    }
    for (std::size_t site = 0; site < sites_.size(); ++site) AddExposure(member, step, site, storm);
  }

  static bool IsIn(const StormState& storm, std::size_t ring, float x, float y) {
    const float west = storm.x - x;
    const float south = storm.y - y;
    const float radius = storm.radius[ring][QuadrantOf(west, south)];
    return radius > 0.0F && west * west + south * south <= radius * radius;
  }

  void AddExposure(std::size_t member, std::int32_t step, std::size_t site,
                   const StormState& storm) {
    const auto x = static_cast<float>(sites_[site].x);
    const auto y = static_cast<float>(sites_[site].y);
    const auto at = static_cast<std::size_t>(step);
    for (std::size_t ring = 0; ring < static_cast<std::size_t>(out_.rings_); ++ring) {
      if (!IsIn(storm, ring, x, y)) continue;
      out_.exposure_[(site * legs_.size() + at) * members_ + member] = -storm.risk[ring];
      return;
    }
  }

  // Adds the cells that a ring covers. Returns false if the ring is absent or too far from the
  // ranch.
  bool AddRing(std::size_t member, std::int32_t step, std::int32_t ring, const StormState& storm) {
    const auto& radius = storm.radius[static_cast<std::size_t>(ring)];
    const float widest = *std::max_element(radius.begin(), radius.end());
    const auto right = static_cast<float>(width_ - 1);
    const auto top = static_cast<float>(height_ - 1);
    const float dx = std::max({-storm.x, storm.x - right, 0.0F});
    const float dy = std::max({-storm.y, storm.y - top, 0.0F});
    if (widest <= 0.0F || dx * dx + dy * dy > widest * widest) return false;
    const std::size_t slot = static_cast<std::size_t>(ring * out_.steps() + step);
    const float narrowest = *std::min_element(radius.begin(), radius.end());
    const float far_x = std::max(std::abs(storm.x), std::abs(right - storm.x));
    const float far_y = std::max(std::abs(storm.y), std::abs(top - storm.y));
    std::int16_t* first =
        first_.data() + (static_cast<std::size_t>(ring) * members_ + member) * cells_;
    const auto now = static_cast<std::int16_t>(step);
    // Rings are nested, so each ring adds the difference between its risk and that of the next
    // wider ring.
    const auto k = static_cast<std::size_t>(ring);
    const float weaker = ring + 1 < out_.rings_ ? storm.risk[k + 1] : 0.0F;
    const float more = storm.risk[k] - weaker;
    if (far_x * far_x + far_y * far_y <= narrowest * narrowest) {
      risk_everywhere_[static_cast<std::size_t>(step)] += more;
      ++everywhere_[slot];
      ++out_.touching_[slot];
      for (std::size_t cell = 0; cell < cells_; ++cell) first[cell] = std::min(first[cell], now);
      return true;
    }
    bool touches = false;
    std::uint16_t* covered = out_.covered_.data() + slot * cells_;
    float* risk = out_.risk_sum_.data() + static_cast<std::size_t>(step) * cells_;
    for (std::int32_t y = 0; y < height_; ++y) {
      const auto [from, to] = Span(storm, static_cast<std::size_t>(ring), static_cast<float>(y));
      const auto row = static_cast<std::size_t>(y * width_);
      for (std::int32_t x = from; x <= to; ++x) {
        const std::size_t cell = row + static_cast<std::size_t>(x);
        ++covered[cell];
        risk[cell] += more;
        first[cell] = std::min(first[cell], now);
      }
      touches = touches || from <= to;
    }
    out_.touching_[slot] += touches ? 1 : 0;
    return true;
  }

  // Returns the first and last column of a row within a ring. The row crosses a western and an
  // eastern quadrant, each with its own radius.
  std::pair<std::int32_t, std::int32_t> Span(const StormState& storm, std::size_t ring,
                                             float y) const {
    const float south = storm.y - y;
    const auto half = [&](float radius) {
      const float rest = radius * radius - south * south;
      return radius > 0.0F && rest >= 0.0F ? std::sqrt(rest) : -1.0F;
    };
    // Columns east of the centre are in an eastern quadrant, columns west of it in a western one.
    const float east = half(storm.radius[ring][QuadrantOf(-1.0F, south)]);
    const float west = half(storm.radius[ring][QuadrantOf(1.0F, south)]);
    if (east < 0.0F && west < 0.0F) return {0, -1};
    const float from = west < 0.0F ? storm.x : storm.x - west;
    const float to = east < 0.0F ? storm.x : storm.x + east;
    const auto limit = [](float value, float max) { return std::clamp(value, -1.0F, max); };
    const auto edge = static_cast<float>(width_);
    return {std::max(0, static_cast<std::int32_t>(std::ceil(limit(from, edge)))),
            std::min(width_ - 1, static_cast<std::int32_t>(std::floor(limit(to, edge))))};
  }

  void AddEverywhere() {
    for (std::size_t step = 0; step < legs_.size(); ++step) {
      float* risk = out_.risk_sum_.data() + step * cells_;
      for (std::size_t cell = 0; cell < cells_; ++cell) risk[cell] += risk_everywhere_[step];
    }
    for (std::size_t slot = 0; slot < everywhere_.size(); ++slot) {
      if (everywhere_[slot] == 0) continue;
      std::uint16_t* covered = out_.covered_.data() + slot * cells_;
      for (std::size_t cell = 0; cell < cells_; ++cell) {
        covered[cell] = static_cast<std::uint16_t>(covered[cell] + everywhere_[slot]);
      }
    }
  }

  void AddUpExposure() {
    for (std::size_t site = 0; site < sites_.size(); ++site) {
      for (std::size_t step = 1; step < legs_.size(); ++step) {
        float* now = out_.exposure_.data() + (site * legs_.size() + step) * members_;
        for (std::size_t member = 0; member < members_; ++member) {
          now[member] += now[member - members_];
        }
      }
    }
  }

  // Copies the arrivals from first_ [rings, members, cells] to arrival_ [rings, cells, members].
  void Transpose() {
    out_.arrival_.resize(first_.size());
    for (std::size_t ring = 0; ring < static_cast<std::size_t>(out_.rings_); ++ring) {
      const std::int16_t* from = first_.data() + ring * members_ * cells_;
      std::int16_t* to = out_.arrival_.data() + ring * members_ * cells_;
      for (std::size_t cell = 0; cell < cells_; ++cell) {
        for (std::size_t member = 0; member < members_; ++member) {
          to[cell * members_ + member] = from[member * cells_ + cell];
        }
      }
    }
  }

  void AddSpread(std::size_t point, const std::vector<std::vector<StormErrors>>& errors) {
    const StormPoint& central = forecast_.path.points[point];
    EnsembleSpread spread;
    spread.time_s = central.step * out_.options_.step_s;
    spread.lead_h = forecast_.lead_h[point];
    spread.center = {central.x, central.y};
    std::vector<double> distances;
    const auto square = [](double value) { return value * value; };
    for (const std::vector<StormErrors>& member : errors) {
      const StormErrors& error = member[point];
      distances.push_back(std::hypot(error.along_km, error.across_km));
      spread.along_km += square(error.along_km);
      spread.across_km += square(error.across_km);
      spread.wind_mps += square(error.wind_add_mps);
      spread.size_log += square(std::log(error.size_factor));
    }
    const auto count = static_cast<double>(members_);
    for (double* sum : {&spread.along_km, &spread.across_km, &spread.wind_mps, &spread.size_log}) {
      *sum = std::sqrt(*sum / count);
    }
    std::sort(distances.begin(), distances.end());
    spread.radius70_km = distances[(members_ - 1) * 7 / 10];
    out_.spread_.push_back(spread);
  }

  struct Leg {
    std::size_t from{};
    std::size_t to{};
    float part{};
  };

  const CentralForecast& forecast_;
  const std::vector<Cell>& sites_;
  Ensemble& out_;
  MemberSampler sampler_;
  std::int32_t width_;
  std::int32_t height_;
  std::size_t cells_;
  std::size_t members_;
  std::vector<std::int16_t> first_;       // [rings, members, cells] step of arrival, as arrival_
  std::vector<std::int32_t> everywhere_;  // [rings, steps] number of members whose ring covers
                                          // all cells
  std::vector<float> risk_everywhere_;    // [steps] sum of the risks that these rings add
  std::vector<Leg> legs_;                 // by step
  std::vector<StormState> states_;        // by point: states of the current member
};

Ensemble::Ensemble(const CentralForecast& forecast, const EnsembleOptions& options,
                   const std::vector<Cell>& sites)
    : options_(options), rings_(static_cast<std::int32_t>(forecast.path.rings)) {
  const auto require = [](const char* what, std::int64_t got, std::int64_t low, std::int64_t high) {
    if (got >= low && got <= high) return;
    throw InputError(std::string(what) + ": got " + std::to_string(got) + ", expected [" +
                     std::to_string(low) + ", " + std::to_string(high) + "]");
  };
  require("members", options.members, 1, 60000);
  require("steps of the plan", options.steps, 1, 4000);
  require("rings of the storm", rings_, 1, static_cast<std::int64_t>(kMaxStormRings));
  constexpr std::int64_t kMaxNumbers = 400'000'000;  // of one array
  const std::int64_t cells = std::int64_t{options.width} * options.height;
  const std::int64_t steps = options.steps;
  const auto devices = static_cast<std::int64_t>(sites.size());
  require("members times cells times rings", options.members * cells * rings_, 1, kMaxNumbers);
  require("members times steps times devices", options.members * steps * devices, 0, kMaxNumbers);
  require("rings times steps times cells", rings_ * steps * cells, 1, kMaxNumbers);
  AQUAFARM_CHECK_LE(std::size_t{1}, forecast.path.points.size());
  EnsembleBuilder(forecast, sites, *this).Run();
}

RiskField Ensemble::MeanRisk(std::int32_t first_step, float step_reward) const {
  std::vector<RiskLayers> layers;
  const auto count = static_cast<float>(members());
  for (std::int32_t step = first_step; step < steps(); ++step) {
    RiskLayers one;
    one.risk.resize(options_.height, options_.width);
    one.quiet.resize(options_.height, options_.width);
    const std::uint16_t* covered = Covered(rings_ - 1, step);  // by the widest ring
    const float* sum = risk_sum_.data() + static_cast<Eigen::Index>(step) * one.risk.size();
    for (Eigen::Index cell = 0; cell < one.risk.size(); ++cell) {
      one.risk.data()[cell] = sum[cell] / count;
      const float calm = 1.0F - static_cast<float>(covered[cell]) / count;
      one.quiet.data()[cell] = one.risk.data()[cell] + step_reward * calm;
    }
    layers.push_back(std::move(one));
  }
  return {first_step, std::move(layers)};
}

}  // namespace aquafarm::agents
