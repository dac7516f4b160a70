// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "aquafarm/storms/track.h"
#include "input/parse_context.h"

namespace aquafarm::internal {

inline constexpr double kMostRadius_km = 3000.0;

/// The radii of an object by the keys of its quadrants, north-east first and in either case. Those
/// that it leaves out, or that are invalid, are as `otherwise`, with a warning.
std::array<double, kQuadrantCount> ReadQuadrants(
    const nlohmann::json& value, const std::string& path,
    const std::array<const char*, kQuadrantCount>& keys, std::int32_t wind_kt,
    const std::array<double, kQuadrantCount>& otherwise, ParseContext& place);

/// The ring of a wind from what a bulletin says of its quadrants. Bulletins write 0 and nothing
/// alike: where the storm itself blows that hard, no radius means that it was not said; where it
/// does not, that there is none.
void AddSaidRing(std::int32_t wind_kt, const std::array<double, kQuadrantCount>& radius_km,
                 StormFix& fix);

}  // namespace aquafarm::internal
