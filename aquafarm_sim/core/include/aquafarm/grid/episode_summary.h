// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The statistics of an episode. Saved states, messages, metrics.csv, evaluation.csv and Python use
/// the list below.

#include <cstdint>
#include <type_traits>

#include "aquafarm/grid/action.h"

namespace aquafarm {

/// One statistic of an episode.
struct EpisodeField {
  const char* name;    ///< name of the struct member
  const char* column;  ///< column in metrics.csv and evaluation.csv
  bool is_added{};     ///< true if older files and saved states may lack it
};

/// Calls visit(field, member…) for every statistic. `member…` are the members called field.name in
/// the given records. Each record is an EpisodeStatistics or a message EpisodeSummary. Append new
/// statistics at the end, with is_added = true.
template <typename Visit, typename... Records>
void VisitEpisodeFields(const Visit& visit, Records&... records) {
  visit(EpisodeField{"seed", "seed"}, records.seed...);
  visit(EpisodeField{"episode", "episode"}, records.episode...);
  visit(EpisodeField{"steps", "steps"}, records.steps...);
  visit(EpisodeField{"episode_return", "return"}, records.episode_return...);
  visit(EpisodeField{"delivered", "delivered"}, records.delivered...);
  visit(EpisodeField{"devices", "devices"}, records.devices...);
  visit(EpisodeField{"delivered_health", "delivered_health"}, records.delivered_health...);
  visit(EpisodeField{"crashes", "crashes"}, records.crashes...);
  visit(EpisodeField{"collisions", "collisions"}, records.collisions...);
  visit(EpisodeField{"steps_in_disaster", "steps_in_disaster"}, records.steps_in_disaster...);
  visit(EpisodeField{"reason", "reason"}, records.reason...);
  visit(EpisodeField{"energy", "energy_kwh", true}, records.energy...);
  visit(EpisodeField{"distance", "distance_km", true}, records.distance...);
}

/// Copies every statistic from one record to another. Converts it to the type of the target.
template <typename From, typename To>
void CopyEpisodeFields(const From& from, To& to) {
  VisitEpisodeFields([](const EpisodeField&, const auto& value,
                        auto& copy) { copy = static_cast<std::decay_t<decltype(copy)>>(value); },
                     from, to);
}

/// Statistics of an episode.
struct EpisodeStatistics {
  std::uint64_t seed{};
  std::uint64_t episode{};
  std::int32_t steps{};
  float episode_return{};  ///< sum of the rewards of all ships and steps, before sharing
  std::int32_t delivered{};
  std::int32_t devices{};
  /// In an EpisodeSummary: mean health of the delivered devices; 0 without a delivery. In an
  /// EpisodeRecord: sum of the health of the delivered devices.
  float delivered_health{};
  std::int32_t crashes{};
  std::int32_t collisions{};
  std::int32_t steps_in_disaster{};  ///< number of ship-steps that end in a cell with a risk
  double energy{};                   ///< consumed by all ships [kWh]
  double distance{};                 ///< travelled by all ships [km]
  EndReason reason{};
  /// Returns whether every device was delivered.
  bool Success() const { return reason == EndReason::kAllRetrieved; }
};

/// Statistics of an ended episode and the farm that played it.
struct EpisodeSummary : EpisodeStatistics {
  std::int32_t farm{};  ///< index of the farm
};

}  // namespace aquafarm
