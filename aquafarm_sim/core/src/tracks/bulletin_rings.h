// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "aquafarm/tracks/track.h"
#include "input/parse_context.h"

namespace aquafarm::internal {

inline constexpr double kMaxRadius_km = 3000.0;

/// Reads the radii of an object with one key per quadrant, NE, SE, SW, NW, in lower or upper case.
/// Missing or invalid radii are replaced by those of `fallback`, with a warning.
std::array<double, kQuadrantCount> ReadQuadrants(
    const nlohmann::json& value, const std::string& path,
    const std::array<const char*, kQuadrantCount>& keys, std::int32_t wind_kt,
    const std::array<double, kQuadrantCount>& fallback, ParseContext& place);

/// Adds the ring of a wind from the quadrants of a bulletin. Bulletins write 0 for "no such wind"
/// and for "not known". If the storm's own wind is at least that strong, all zeros mean that the
/// radii are not known; else they mean that no such wind blows.
void AddSaidRing(std::int32_t wind_kt, const std::array<double, kQuadrantCount>& radius_km,
                 StormFix& fix);

}  // namespace aquafarm::internal
