// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "aquafarm/tracks/track.h"
#include "input/parse_context.h"

namespace aquafarm::internal {

inline constexpr double kMaxRadius_km = 3000.0;

/// Reads the radii [km] of an object that has one key per quadrant, in the order NE, SE, SW, NW.
/// Keys may be in upper case, too. Replaces missing and invalid radii by those of `fallback`, with
/// a warning unless all keys are blank.
/// @param path path of the object, for messages
/// @param wind_kt wind of the ring, for messages
std::array<double, kQuadrantCount> ReadQuadrants(
    const nlohmann::json& value, const std::string& path,
    const std::array<const char*, kQuadrantCount>& keys, std::int32_t wind_kt,
    const std::array<double, kQuadrantCount>& fallback, ParseContext& place);

/// Adds the ring of a wind from the quadrants of a bulletin. Bulletins write 0 for "no such wind"
/// and for "not known". If the storm's wind is unknown or at least `wind_kt`, four zeros mean that
/// the radii are not known, and no ring is added. If the storm's wind is weaker, four zeros mean
/// that no such wind blows, and a ring with four zeros is added.
void AddSaidRing(std::int32_t wind_kt, const std::array<double, kQuadrantCount>& radius_km,
                 StormFix& fix);

}  // namespace aquafarm::internal
