// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Keys of a scenario about kinds of devices and disasters, grade factors, monitoring devices and
/// entity tokens; part of schema.h. They are written only where they differ from the defaults.
/// Scenarios that do not use them therefore have the same texts and hashes as before these keys
/// existed.

#include <algorithm>

#include "scenario/domains.h"

namespace aquafarm::internal {

/// Visits the damage factors: a block per kind of device, with one key per kind of disaster.
template <typename Archive, typename D>
void VisitDamageKinds(Archive& a, D& damage) {
  constexpr Interval<float> kFactor{0.0F, 100.0F};
  const auto differs = [](float factor) { return Archive::kReads || factor != 1.0F; };
  a.When(Archive::kReads || damage.DependsOnKinds(), "");
  a.Struct("kinds", [&](auto& b) {
    for (std::size_t device = 0; device < kDeviceKindCount; ++device) {
      auto& row = damage.kinds[device];
      b.When(std::any_of(row.begin(), row.end(), differs), "");
      b.Struct(ToString(static_cast<DeviceKind>(device)).data(), [&](auto& c) {
        for (std::size_t kind = 0; kind < kDisasterKindCount; ++kind) {
          c.When(differs(row[kind]), "");
          c.Field(ToString(static_cast<DisasterKind>(kind)).data(), row[kind], kFactor);
        }
        c.Always();
      });
      b.Always();
    }
  });
  a.Always();
}

/// Visits the factors of risks by grade.
/// @param used false if grade_risks or storms are given, which exclude these factors
/// @param condition end of the message "is used only if …" for factors that are given but not used
template <typename Archive, typename D>
void VisitGradeFactors(Archive& a, D& disaster, bool used, const char* condition) {
  constexpr Interval<float> kFactor{0.0F, 10.0F, true};
  const bool given = a.Has("grade_factors", !disaster.grade_factors.empty());
  a.When(used && (Archive::kReads || given), condition);
  a.Field("grade_factors", disaster.grade_factors,
          ListOf<Interval<float>>{kFactor, given ? 4U : 0U, 4});
  a.Always();
}

/// Visits the keys of `view` about monitoring devices, entity tokens and kinds.
template <typename Archive, typename V>
void VisitViewKinds(Archive& a, V& view) {
  constexpr Interval<float> kReach{0.0F, 1.0e6F};
  const bool partial = view.mode == ViewMode::kPartial;
  a.When(partial && (Archive::kReads || view.monitoring_radius != 0.0F), "'mode' is partial");
  a.Field("monitoring_radius", view.monitoring_radius, kReach);
  a.When(Archive::kReads || view.tokens, "");
  a.Field("tokens", view.tokens, AnyFlag{});
  a.When(Archive::kReads || view.kinds, "");
  a.Field("kinds", view.kinds, AnyFlag{});
  a.Always();
}

}  // namespace aquafarm::internal
