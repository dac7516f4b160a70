// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/farm_text.h"

#include <cstdio>

namespace aquafarm {

char ChartMark(std::uint8_t bits, char device_mark) {
  if ((bits & kIslandBit) != 0) return '#';
  if ((bits & kRockBit) != 0) return 'o';
  if ((bits & kPortBit) != 0) return 'P';
  return (bits & kDeviceSiteBit) != 0 ? device_mark : '.';
}

std::string RenderText(const Farm& farm) {
  const Scenario& scenario = farm.scenario();
  const EpisodeRecord& record = farm.record();
  char numbers[128];
  std::snprintf(numbers, sizeof(numbers), "  step %d of %d  return %.1f  delivered %d of %d",
                record.steps, scenario.step_limit, static_cast<double>(record.episode_return),
                record.delivered, record.devices);
  const std::string reason =
      farm.over() ? "  ended: " + std::string(ToString(record.reason)) : std::string();
  std::string text = scenario.name + numbers + reason + '\n';
  const std::size_t start = text.size();
  const auto at = [&](Cell cell) -> char& {  // + 1: each row ends with a line feed
    const std::int32_t row = scenario.height - 1 - cell.y;
    return text[start + static_cast<std::size_t>(row * (scenario.width + 1) + cell.x)];
  };
  for (std::int32_t y = scenario.height; y-- > 0;) {
    for (std::int32_t x = 0; x < scenario.width; ++x) {
      const char mark = ChartMark(farm.layout().bits({x, y}), '.');
      text += mark == '.' && farm.RiskAt({x, y}) < 0.0F ? '~' : mark;
    }
    text += '\n';
  }
  for (const Device& device : farm.devices()) {
    if (device.status == DeviceStatus::kDeployed && !device.self_propelled) at(device.cell) = 'd';
  }
  for (std::size_t id = farm.ships().size(); id-- > 0;) {
    const Ship& ship = farm.ships()[id];
    if (ship.active) at(ship.cell) = static_cast<char>('0' + id % 10);
  }
  return text;
}

}  // namespace aquafarm
