// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/scene/labels.h"

#include <aquafarm_msgs/Outcome.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string_view>

#include "aquafarm/grid/reward.h"
#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/base/palette.h"
#include "aquafarm_viz/base/text.h"

namespace aquafarm_viz {

std::string ActionName(std::uint8_t action) {
  if (const int bearing = MoveBearingDeg(action); bearing >= 0) return CompassPoint(bearing);
  return action == 8 ? "pickup" : action == 9 ? "drop-off" : "hold";
}

std::string ChoiceText(const aquafarm_msgs::PolicyChoice& choice,
                       const aquafarm_msgs::ShipState& ship) {
  const auto id = static_cast<std::size_t>(ship.id);
  if (ship.id < 0 || id >= choice.actions.size() || !ship.active) return "";
  const std::string action = ActionName(choice.actions[id]);
  return id < choice.values.size() ? action + " (value " + Number(choice.values[id], 1) + ")"
                                   : action;
}

std::string OutcomeName(std::uint8_t outcome) {
  using aquafarm_msgs::Outcome;
  switch (outcome) {
    case Outcome::EDGE:
      return "edge";
    case Outcome::CRASH:
      return "crash";
    case Outcome::COLLISION:
      return "collision";
    case Outcome::ILLEGAL_PICKUP:
    case Outcome::ILLEGAL_DROP_OFF:
      return "illegal";
    case Outcome::OUT_OF_PLAY:
      return "delivered";
    default:
      return "";
  }
}

std::string ClockText(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state) {
  const std::time_t seconds = state.world_time.sec;
  if (!spec.has_start_time) {
    return Count(std::uint64_t(seconds) / 3600) + " h " + std::to_string(seconds / 60 % 60) +
           " min";
  }
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M UTC", &parts);
  return text.data();
}

std::string DescribeResult(const aquafarm_msgs::CommandResult& result) {
  using aquafarm_msgs::Outcome;
  if (result.code == Outcome::ACCEPTED) return "accepted for step " + Count(result.step);
  const std::string step = ", step " + Count(result.step);
  if (result.code == Outcome::OK)
    return "executed, " + Signed(static_cast<double>(result.reward)) + step;
  std::string what = OutcomeName(result.code);
  if (result.code == Outcome::ILLEGAL_PICKUP) what = "illegal pickup";
  if (result.code == Outcome::ILLEGAL_DROP_OFF) what = "illegal drop-off";
  if (result.code == Outcome::HELD) what = "held";
  return what + ", " + Signed(static_cast<double>(result.reward)) + step;
}

std::string Duration(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0.0 || seconds > 1e8) return "";
  const auto whole = static_cast<unsigned>(seconds);
  std::array<char, 32> text{};
  if (whole >= 3600) {
    std::snprintf(text.data(), text.size(), "%u:%02u:%02u", whole / 3600, whole / 60 % 60,
                  whole % 60);
  } else {
    std::snprintf(text.data(), text.size(), "%u:%02u", whole / 60, whole % 60);
  }
  return text.data();
}

std::string Rate(double value) {
  if (value >= 1e6) return Number(value / 1e6, value < 1e7 ? 2 : 1) + " M";
  if (value >= 1e3) return Number(value / 1e3, value < 1e4 ? 2 : 1) + " k";
  return Number(value, 0);
}

std::string StatusName(std::uint8_t status) {
  static constexpr std::array<const char*, 3> kNames{"deployed", "aboard", "delivered"};
  return status < kNames.size() ? kNames[status] : "";
}

std::string DeviceLabel(std::int32_t id) { return "F" + std::to_string(id); }

std::string PortText(const aquafarm_msgs::FarmSpec& spec, int x, int y) {
  for (const auto& port : spec.ports) {
    if (port.cell.x == x && port.cell.y == y) return "port " + PortLetter(port.id);
  }
  return "";
}

bool IsLabelled(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::DeviceState& device) {
  return device.status == aquafarm_msgs::DeviceState::DEPLOYED && InGrid(spec, device.x, device.y);
}

std::string EndText(const aquafarm_msgs::FarmState& state) {
  static constexpr std::array<const char*, 4> kReasons{"Episode over", "All devices retrieved",
                                                       "The disaster has ended", "Step limit"};
  const std::string reason = kReasons[state.reason < kReasons.size() ? state.reason : 0U];
  if (state.reason == aquafarm_msgs::FarmState::ALL_RETRIEVED) return reason;
  const auto delivered = std::count_if(
      state.devices.begin(), state.devices.end(),
      [](const auto& device) { return device.status == aquafarm_msgs::DeviceState::DELIVERED; });
  return reason + ": " + std::to_string(delivered) + " of " + std::to_string(state.devices.size()) +
         " devices in port";
}

std::string PhaseName(std::uint8_t phase) {
  static constexpr std::array<const char*, 7> kNames{
      "starting", "training", "evaluating", "waiting", "done", "interrupted", "failed"};
  return phase < kNames.size() ? kNames[phase] : "";
}

std::string Signed(double value) { return (value > 0.0 ? "+" : "") + Number(value, 1); }

std::string MissingSteps(std::uint64_t count) {
  return std::to_string(count) + (count == 1 ? " step is missing; 'verify' names it"
                                             : " steps are missing; 'verify' names the first");
}

std::vector<std::pair<std::string, float>> RewardTermsOf(const aquafarm_msgs::FarmState& state) {
  std::vector<std::pair<std::string, float>> sums;
  for (const std::string_view name : aquafarm::kRewardTermNames) {
    sums.emplace_back(name, 0.0F);
    std::string& label = sums.back().first;
    std::replace(label.begin(), label.end(), '_', '-');
  }
  for (const auto& ship : state.ships) {
    std::size_t next = 0;
    aquafarm::VisitRewardTerms([&](const char*, float term) { sums[next++].second += term; },
                               ship.terms);
  }
  return sums;
}

}  // namespace aquafarm_viz
