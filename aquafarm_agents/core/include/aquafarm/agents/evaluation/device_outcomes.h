// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Outcomes of each device over the episodes of an evaluation.

#include <cstdint>
#include <vector>

#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

/// How the episodes ended for one device.
struct DeviceTally {
  DeviceKind kind{};          ///< of the last episode
  std::int64_t episodes{};    ///< episodes in which the farm has this device
  std::int64_t delivered{};   ///< episodes that ended with it in a port
  std::int64_t aboard{};      ///< episodes that ended with it on a ship
  double delivered_health{};  ///< sum of its health over the episodes that delivered it

  /// Returns the number of episodes that ended with it at sea.
  std::int64_t Left() const { return episodes - delivered - aboard; }
};

/// Adds the devices of a farm at the end of an episode. Outcomes are by device id.
inline void AddDevices(const std::vector<Device>& devices, std::vector<DeviceTally>& outcomes) {
  if (outcomes.size() < devices.size()) outcomes.resize(devices.size());
  for (std::size_t id = 0; id < devices.size(); ++id) {
    DeviceTally& one = outcomes[id];
    one.kind = devices[id].kind;
    ++one.episodes;
    if (devices[id].status == DeviceStatus::kAboard) ++one.aboard;
    if (devices[id].status != DeviceStatus::kDelivered) continue;
    ++one.delivered;
    one.delivered_health += static_cast<double>(devices[id].health);
  }
}

}  // namespace aquafarm::agents
