// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Outcomes of the devices in the episodes of an evaluation, by id and by kind. The outcomes by id
/// are meaningful only if every episode has the same devices.

#include <array>
#include <cstdint>
#include <vector>

#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

/// How the episodes ended for one device, or for all devices of a kind.
struct DeviceTally {
  DeviceKind kind{};
  std::int64_t devices{};     ///< number of devices counted, in all episodes
  std::int64_t delivered{};   ///< number of them in a port at the end of their episode
  std::int64_t aboard{};      ///< number of them on a ship at the end of their episode
  double delivered_health{};  ///< sum of the health of those in a port

  /// Returns the number of devices at sea at the end of their episode.
  std::int64_t Left() const { return devices - delivered - aboard; }
  /// Counts a device at the end of an episode.
  void Add(const Device& device) {
    kind = device.kind;
    ++devices;
    if (device.status == DeviceStatus::kAboard) ++aboard;
    if (device.status != DeviceStatus::kDelivered) return;
    ++delivered;
    delivered_health += static_cast<double>(device.health);
  }
};

/// The outcomes of an evaluation.
struct DeviceOutcomes {
  std::vector<DeviceTally> by_id;
  std::array<DeviceTally, kDeviceKindCount> by_kind{};
  /// Whether each id refers to the same device in every episode. Set it to false for a family of
  /// ranches. Add sets it to false if the episodes differ in the number or kinds of devices.
  bool are_same{true};

  bool empty() const { return by_id.empty(); }
  /// Counts the devices of a farm at the end of an episode.
  void Add(const std::vector<Device>& ended) {
    const bool is_first = by_id.empty();
    if (!is_first && by_id.size() != ended.size()) are_same = false;
    if (by_id.size() < ended.size()) by_id.resize(ended.size());
    for (std::size_t id = 0; id < ended.size(); ++id) {
      if (by_id[id].devices > 0 && by_id[id].kind != ended[id].kind) are_same = false;
      by_id[id].Add(ended[id]);
      by_kind[static_cast<std::size_t>(ended[id].kind)].Add(ended[id]);
    }
  }
};

}  // namespace aquafarm::agents
