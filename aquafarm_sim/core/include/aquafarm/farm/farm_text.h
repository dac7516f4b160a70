// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A farm as text, one character a cell, north up:
///   0-9 ship (last digit of its id)   d device that waits   P port   # island   o rock
///   ~ water at a risk                 . other water
/// A ship hides what lies in its cell, a device that waits hides the port, and so on in this order.

#include <cstdint>
#include <string>

#include "aquafarm/farm/farm.h"

namespace aquafarm {

/// The marks of maps in text; the script `keyboard` has the same line.
inline constexpr const char kMapKey[] =
    "0…9 ship  d device  P port  # island  o rock  ~ disaster  . water";

/// The mark of a chart cell (CellBits); `device_mark` stands for a device site.
char ChartMark(std::uint8_t bits, char device_mark);

/// The present state: a line with the step, the return and the deliveries, then the map.
std::string RenderText(const Farm& farm);

}  // namespace aquafarm
