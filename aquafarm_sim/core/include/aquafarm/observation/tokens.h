// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Features as entity tokens (view.tokens). Their number depends neither on the size of the map nor
/// on the number of entities, so one network can play every ranch. The tokens are:
///
///   ship       1 token    the observing ship, its surroundings, the risk in each direction
///   device    10 tokens   fetchable devices that are deployed or aboard the observing ship
///   port       6 tokens
///   disaster   4 tokens   known disasters that have not ended
///   other      4 tokens   other visible ships
///
/// Each token has a slot in the feature vector. A slot without an entity contains zeros. Feature 0
/// of a slot is 1 if the slot has an entity; the ship's slot lacks this feature. Entities fill the
/// slots in id order. If there are more entities than slots, those nearest to the ship are kept.
/// The distance of a device or a port is the number of moves by water; devices aboard count as
/// nearest. The distance of a disaster is that to the edge of its largest ring. The distance of
/// another ship is the number of moves as if there were no land.
///
/// Lengths are in units of kTokenLength cells and clamped to [-4, 4]. Risks are divided by the
/// worst risk of §2.1 of the paper (see docs/model.md). Forecast risks assume that each known
/// disaster keeps its motion and its size until it ends. The features ship.risk.* and
/// ship.course.* ignore the ends of disasters. docs/generalist.md lists every feature.

#include <array>
#include <cstdint>
#include <vector>

#include "aquafarm/observation/feature_group.h"

namespace aquafarm {

inline constexpr float kTokenLength = 16.0F;        ///< unit of lengths [cells]
inline constexpr std::int32_t kTokenDevices = 10;   ///< slots
inline constexpr std::int32_t kTokenPorts = 6;      ///< slots
inline constexpr std::int32_t kTokenDisasters = 4;  ///< slots
inline constexpr std::int32_t kTokenOthers = 4;     ///< slots
inline constexpr std::int32_t kTokenWindow = 3;     ///< radius of the near surroundings [cells]
inline constexpr std::int32_t kTokenRoute = 32;     ///< steps of a route that route_risk sums

/// Slots of one kind of entity, consecutive in the feature vector.
struct TokenGroup {
  std::int32_t begin{};  ///< index of the first feature
  std::int32_t slots{};
  std::int32_t size{};  ///< number of features of one slot
  std::int32_t end() const { return begin + slots * size; }
};
inline constexpr std::size_t kTokenGroupCount = 5;

/// Returns the groups ship, devices, ports, disasters and others, in the order of the features.
const std::array<TokenGroup, kTokenGroupCount>& TokenGroups();
/// Returns the names of all features, in order.
const std::vector<std::string>& TokenNames();
/// Returns the feature groups that write the tokens, in order.
std::vector<FeatureGroup> TokenFeatureGroups();

}  // namespace aquafarm
