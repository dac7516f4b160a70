// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The keys of a family of ranches; part of schema.h.

#include "scenario/domains.h"
#include "scenario/ranges.h"

namespace aquafarm::internal {

template <typename Archive, typename S>
void VisitFamily(Archive& a, S& s) {
  a.Optional("family", s.family, [](auto& b, auto& family) {
    constexpr Interval<std::int32_t> kFamilySide{8, 256};
    b.Field("width", family.width, kFamilySide);
    b.Field("height", family.height, kFamilySide);
    b.Field("islands", family.islands, Interval<std::int32_t>{0, 100});
    b.Field("coast_share", family.coast_share, kShare);
    b.Field("rocks", family.rocks, Interval<float>{0.0F, 0.3F});
    b.Field("devices", family.devices, Interval<std::int32_t>{1, 100});
    b.Field("ports", family.ports, Interval<std::int32_t>{1, 100});
    b.Field("capacity", family.capacity, Interval<std::int32_t>{1, 100});
    b.Field("disasters", family.disasters, Interval<std::int32_t>{0, 16});
    b.Field("storm_share", family.storm_share, kShare);
    b.Field("exposure_damage", family.exposure_damage, kShare);
  });
}

}  // namespace aquafarm::internal
