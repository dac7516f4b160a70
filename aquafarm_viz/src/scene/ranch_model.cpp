// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/scene/ranch_model.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "aquafarm_viz/base/palette.h"
#include "aquafarm_viz/base/text.h"
#include "aquafarm_viz/scene/labels.h"
#include "scene/nautical.h"
#include "scene/outlook_text.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::TrainingStatus;

std::string CellText(int x, int y) {
  return "(" + std::to_string(x) + ", " + std::to_string(y) + ")";
}

// Replaces spaces with no-break spaces, so that the text stays on one line.
std::string Unbroken(const std::string& text) {
  std::string result;
  for (const char letter : text) {
    if (letter == ' ') {
      result += "\u00a0";
    } else {
      result += letter;
    }
  }
  return result;
}

}  // namespace

RanchModel::RanchModel() : courses_(std::make_shared<CourseReader>()) {}

std::string RanchModel::Take(const aquafarm_msgs::FarmStateConstPtr& state) {
  return pairing_.AddState(state);
}

void RanchModel::Take(const aquafarm_msgs::TrainingStatusConstPtr& training) {
  const bool is_new = training_ == nullptr || training_->run_dir != training->run_dir ||
                      training->episode < training_->episode;
  const bool moved = is_new || training->episode > training_->episode;
  if (is_new) {
    curve_.clear();
    every_ = 1;
    came_ = 0;
  }
  training_ = training;
  if (!moved || !std::isfinite(training->mean_return) || came_++ % every_ != 0) return;
  curve_.push_back({double(training->episode), double(training->mean_return),
                    std::isfinite(training->success_rate) ? double(training->success_rate) : 0.0});
  if (curve_.size() < kMaxPoints) return;
  for (std::size_t i = 0; 2 * i < curve_.size(); ++i) curve_[i] = curve_[2 * i];
  curve_.resize((curve_.size() + 1) / 2);
  every_ *= 2;
}

bool RanchModel::paused() const { return shown().state != nullptr && shown().state->paused; }

std::string RanchModel::Headline() const {
  if (shown().state == nullptr) return "no ranch yet";
  const auto& spec = *shown().spec;
  const auto& state = *shown().state;
  std::string text = spec.scenario_name + "   episode " + Count(state.episode) + "   step " +
                     Count(state.step) + " / " +
                     Count(std::uint64_t(std::max(0, spec.step_limit))) + "   return " +
                     Number(state.joint_return, 1) + "   seed " + SeedText(state.seed);
  if (state.paused) text += "   paused";
  return text;
}

std::string RanchModel::RewardLine() const {
  if (shown().state == nullptr) return "";
  std::string text = "reward " + Signed(shown().state->joint_reward);
  const char* between = ":   ";
  for (const auto& [name, value] : RewardTermsOf(*shown().state)) {
    if (value == 0.0F) continue;
    text += between + name + " " + Signed(value);
    between = "   ";
  }
  return text;
}

std::string RanchModel::TrainingLine() const {
  if (training_ == nullptr) return "";
  const TrainingStatus& now = *training_;
  const bool waits_for_ranch = now.phase == TrainingStatus::WAITING && paused();
  std::string text = now.algorithm + ", " + PhaseName(now.phase) +
                     (waits_for_ranch ? " (ranch paused)" : "") + "   " + Count(now.episode) +
                     (now.episodes > 0 ? " / " + Count(now.episodes) : "") +
                     " episodes   mean return " + Number(now.mean_return, 1) + "   success " +
                     Percent(now.success_rate);
  if (now.steps_per_second > 0.0F && !waits_for_ranch)
    text += "   " + Unbroken(Rate(now.steps_per_second) + " steps/s");
  if (const auto left = Duration(now.time_left_s); !left.empty() && !waits_for_ranch)
    text += "   " + Unbroken("left " + left);
  return text;
}

ros::Time RanchModel::PlanNow() const {
  const bool follows = plan_->follows_ranch && shown().state != nullptr;
  return follows ? std::max(plan_->start, shown().state->world_time) : plan_->start;
}

const RanchModel::Row& RanchModel::ShipColumns() {
  static const Row columns{"ship", "cell", "action", "aboard", "reward", "return"};
  return columns;
}

const RanchModel::Row& RanchModel::DeviceColumns() {
  static const Row columns{"device", "kind", "cell", "status", "health", "value"};
  return columns;
}

const RanchModel::Row& RanchModel::DisasterColumns() {
  static const Row columns{"disaster", "centre", "motion now", "closest", "ends in"};
  return columns;
}

std::vector<RanchModel::Row> RanchModel::Disasters() const {
  std::vector<Row> rows;
  if (shown().state == nullptr) return rows;
  const auto& spec = *shown().spec;
  const auto& state = *shown().state;
  const std::vector<Course> courses = courses_->Read(spec, state);
  for (std::size_t i = 0; i < state.disasters.size(); ++i) {
    const auto& disaster = state.disasters[i];
    if (!disaster.known || disaster.steps_left <= 0) continue;
    rows.push_back({NameNow(disaster, courses[i]), WhereText(spec, disaster.x, disaster.y),
                    MotionText(spec, disaster.heading_deg, double(disaster.speed)),
                    ClosestText(spec, courses[i]), AheadText(spec, disaster.steps_left)});
  }
  return rows;
}

std::vector<RanchModel::Row> RanchModel::Ships() const {
  std::vector<Row> rows;
  if (shown().state == nullptr) return rows;
  for (const auto& ship : shown().state->ships) {
    std::string aboard;
    for (const int device : ship.aboard) {
      aboard += (aboard.empty() ? "" : ", ") + DeviceLabel(device);
    }
    const std::string fault = OutcomeName(ship.outcome);
    rows.push_back(
        {ship.own_device >= 0 ? std::to_string(ship.id) + " (device)" : std::to_string(ship.id),
         ship.visible ? CellText(ship.x, ship.y) : "?",
         ActionName(ship.action) + (fault.empty() ? "" : ": " + fault), aboard,
         Signed(double(ship.reward)), Number(double(ship.episode_return), 1)});
  }
  return rows;
}

std::vector<RanchModel::Row> RanchModel::Devices() const {
  std::vector<Row> rows;
  if (shown().state == nullptr) return rows;
  const auto& spec = *shown().spec;
  const auto& state = *shown().state;
  std::map<std::int32_t, std::string> dangers;
  for (const DeviceOutlook& one :
       ComputeOutlook(spec, state, courses_->Read(spec, state)).devices) {
    dangers[one.id] = FirstAndWorstText(spec, one);
  }
  for (const auto& device : state.devices) {
    const std::string& danger = dangers[device.id];
    rows.push_back({DeviceLabel(device.id), DeviceName(device.kind), CellText(device.x, device.y),
                    danger.empty() ? StatusName(device.status) : danger,
                    device.health_known ? Percent(double(device.health)) : "?",
                    Number(double(device.value), 0)});
  }
  return rows;
}

aquafarm_msgs::DisasterInfo RanchModel::MakeDisaster(std::uint8_t kind, std::uint8_t grade,
                                                     double radius) const {
  aquafarm_msgs::DisasterInfo info;
  info.kind = kind;
  info.grade = grade;
  // The risk of the innermost ring depends on the grade, from -5 (blue) to -20 (red). The outermost
  // ring has the risk -5. The risk of the middle ring is the mean of these two.
  const float worst = -5.0F * static_cast<float>(grade);
  for (const float share : {1.0F / 3.0F, 2.0F / 3.0F, 1.0F}) {
    info.radii.push_back(static_cast<float>(radius) * share);
    info.risks.push_back(worst + (-5.0F - worst) * (share - 1.0F / 3.0F) * 1.5F);
  }
  info.speed = 0.25F;
  info.turn_probability = 0.1F;
  info.duration = 1000;
  info.has_start = true;
  if (shown().state == nullptr) return info;
  info.x = 0.5F * static_cast<float>(shown().spec->width - 1);
  info.y = 0.5F * static_cast<float>(shown().spec->height - 1);
  if (shown().state->ships.empty() || !shown().state->ships[0].visible) return info;
  info.x = static_cast<float>(shown().state->ships[0].x);
  info.y = static_cast<float>(shown().state->ships[0].y);
  return info;
}

std::int32_t RanchModel::NextDisaster() const {
  return shown().state == nullptr ? 0 : static_cast<std::int32_t>(shown().state->disasters.size());
}

}  // namespace aquafarm_viz
