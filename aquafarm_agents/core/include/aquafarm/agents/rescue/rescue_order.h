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
  double time_s{};  ///< after the start of the plan; of leaving, or of completing the order
  Cell cell{};
  std::int32_t device{kNone};         ///< fetch
  std::int32_t port{kNone};           ///< leave, if in a port; deliver
  std::vector<std::int32_t> devices;  ///< deliver: all devices that are unloaded
  double km{};                        ///< since the previous order
  double kwh{};                       ///< since the previous order; 0 without RescueProblem::energy
  double probability{};               ///< that the order is carried out
};

/// A position of a ship on its way.
struct TimedCell {
  Cell cell{};
  double time_s{};  ///< of entering the cell
};

}  // namespace aquafarm::agents
