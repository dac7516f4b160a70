// SPDX-License-Identifier: BSD-3-Clause
#include "tracks/bulletin_rings.h"

#include <algorithm>

#include "base/text.h"
#include "input/json_object.h"

namespace aquafarm::internal {
namespace {

using Json = nlohmann::json;

}  // namespace

std::array<double, kQuadrantCount> ReadQuadrants(
    const Json& value, const std::string& path, const std::array<const char*, kQuadrantCount>& keys,
    std::int32_t wind_kt, const std::array<double, kQuadrantCount>& fallback, ParseContext& place) {
  const JsonObject object(value, path, place);
  std::array<double, kQuadrantCount> radius_km = fallback;
  std::size_t given = 0;
  for (std::size_t q = 0; q < keys.size(); ++q) {
    const std::string upper = Upper(keys[q]);
    const auto one = object.TryNumber({keys[q], upper.c_str()}, 0.0, kMaxRadius_km);
    radius_km[q] = one.value_or(fallback[q]);
    given += one ? 1 : 0;
  }
  const bool all = *std::max_element(fallback.begin(), fallback.end()) > 0.0;
  const std::string wind = std::to_string(wind_kt) + " kt: ";
  if (given == 0 && !IsBlank(value)) {
    place.WarnValue(path, wind + "has none of the quadrants " + keys[0] + ", " + keys[1] + ", " +
                              keys[2] + " and " + keys[3]);
  } else if (given > 0 && given < keys.size()) {
    place.WarnValue(path, wind + "some quadrants have no radius; they get " +
                              (all ? "the radius of the whole ring" : "the radius 0"));
  }
  return radius_km;
}

void AddSaidRing(std::int32_t wind_kt, const std::array<double, kQuadrantCount>& radius_km,
                 StormFix& fix) {
  const bool given = *std::max_element(radius_km.begin(), radius_km.end()) > 0.0;
  const bool blows = !fix.wind_mps || *fix.wind_mps >= wind_kt * kMpsPerKnot;
  if (given || !blows) AddRing({wind_kt, radius_km, false}, fix.rings);
}

}  // namespace aquafarm::internal
