// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A farm as text, with one character per cell and north at the top:
///   0-9 ship (last digit of its id)   d device to fetch   P port   # island   o rock
///   ~ water with a risk               . other water
/// A cell with several objects shows the object that is listed first above. A cell with several
/// ships shows the ship with the lowest id. Ships that are not active are not shown.

#include <cstdint>
#include <string>

#include "aquafarm/farm/farm.h"

namespace aquafarm {

/// Legend of the marks. The script aquafarm_bringup/scripts/keyboard contains the same line.
inline constexpr const char kMapKey[] =
    "0…9 ship  d device  P port  # island  o rock  ~ disaster  . water";

/// Returns the mark of a chart cell. @param bits CellBits @param device_mark mark of a device site
char ChartMark(std::uint8_t bits, char device_mark);

/// Returns the current state as text. The first line contains the name of the scenario, the step,
/// the return, the deliveries and, after the end, the end reason. The map follows.
std::string RenderText(const Farm& farm);

}  // namespace aquafarm
