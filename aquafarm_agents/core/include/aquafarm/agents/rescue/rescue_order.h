// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Orders to a ship and its positions.

#include <cstdint>
#include <string_view>
#include <vector>

#include "aquafarm/grid/action.h"
#include "aquafarm/grid/cell.h"

namespace aquafarm::agents {

enum class OrderKind : std::uint8_t { kLeave, kFetch, kDeliver };
inline constexpr int kOrderKindCount = 3;
/// "leave", "fetch", "deliver".
std::string_view ToString(OrderKind value);

/// An order to a ship.
struct RescueOrder {
  OrderKind kind{};
  double time_s{};  ///< leave: when it begins; else when it is done; after the start of the plan
  Cell cell{};
  std::int32_t device{kNone};         ///< fetch
  std::int32_t port{kNone};           ///< leave, if in a port; deliver
  std::vector<std::int32_t> devices;  ///< deliver: all that are unloaded
  double km{};                        ///< since the order before
  double probability{};               ///< that the order is carried out
};

/// A position of a ship on its way.
struct TimedCell {
  Cell cell{};
  double time_s{};  ///< of entering the cell
};

}  // namespace aquafarm::agents
