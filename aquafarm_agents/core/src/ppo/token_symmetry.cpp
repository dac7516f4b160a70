// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/token_symmetry.h"

#include <algorithm>
#include <string>
#include <unordered_map>
#include <utility>

#include "aquafarm/agents/base/text.h"
#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

/// A symmetry, applied to vectors on the grid.
struct Turning {
  explicit Turning(std::size_t symmetry)
      : swaps((symmetry & 4U) != 0),
        north_sign((symmetry & 2U) != 0 ? -1 : 1),
        east_sign((symmetry & 1U) != 0 ? -1 : 1) {}

  Cell Of(Cell v) const {
    if (swaps) std::swap(v.x, v.y);
    return {east_sign * v.x, north_sign * v.y};
  }

  bool swaps;
  int north_sign;
  int east_sign;
};

std::size_t MoveOf(Cell by) {
  return static_cast<std::size_t>(std::find(kMoves.begin(), kMoves.end(), by) - kMoves.begin());
}

/// The feature of the plain ranch from which a feature of the turned ranch is copied.
struct Source {
  std::string name;  // in the plain ranch
  float sign{1.0F};
};

using Sources = std::unordered_map<std::string, Source>;  // by name in the turned ranch

// Adds the features stem + MOVE for all moves.
void AddMoves(const std::string& stem, const Turning& turning, Sources& sources) {
  for (std::size_t move = 0; move < kMoves.size(); ++move) {
    const auto name = [&stem](std::size_t of) {
      return stem + std::string(ToString(static_cast<Action>(of)));
    };
    sources[name(MoveOf(turning.Of(kMoves[move])))] = {name(move)};
  }
}

// Adds the features stem + "east" and stem + "north".
void AddVector(const std::string& stem, const Turning& turning, Sources& sources) {
  const std::string east = stem + "east";
  const std::string north = stem + "north";
  sources[east] = {turning.swaps ? north : east, static_cast<float>(turning.east_sign)};
  sources[north] = {turning.swaps ? east : north, static_cast<float>(turning.north_sign)};
}

// Adds the feature of a cell. @param name in the plain ranch, such as "ship.near_risk.-1.3"
void AddCell(const std::string& name, const Turning& turning, Sources& sources) {
  const std::size_t y = name.rfind('.') + 1;
  const std::size_t x = name.rfind('.', y - 2) + 1;
  const Cell to = turning.Of({std::stoi(name.substr(x)), std::stoi(name.substr(y))});
  sources[name.substr(0, x) + std::to_string(to.x) + '.' + std::to_string(to.y)] = {name};
}

// Returns the sources of the features that a symmetry may move or negate. All other features are
// copied from the feature of the same name.
Sources SourcesOf(const std::vector<std::string>& names, const Turning& turning) {
  Sources sources;
  for (const std::string& name : names) {
    const std::string what = name.substr(name.find('.') + 1);  // without the slot
    if (what.rfind("near_", 0) == 0) {
      AddCell(name, turning, sources);
    } else if (EndsWith(what, ".north")) {
      AddMoves(name.substr(0, name.size() - std::string("north").size()), turning, sources);
    } else if (what == "north" || EndsWith(what, "_north")) {
      AddVector(name.substr(0, name.size() - std::string("north").size()), turning, sources);
    }
  }
  return sources;
}

}  // namespace

TokenSymmetry::TokenSymmetry(const TokenLayout& layout, std::size_t symmetry) {
  AQUAFARM_CHECK_LT(symmetry, kSymmetries);
  const Turning turning(symmetry);
  std::unordered_map<std::string, std::uint32_t> place;
  for (std::uint32_t i = 0; i < layout.names.size(); ++i) place[layout.names[i]] = i;
  const Sources sources = SourcesOf(layout.names, turning);
  for (std::uint32_t i = 0; i < layout.names.size(); ++i) {
    const auto found = sources.find(layout.names[i]);
    source_.push_back(found == sources.end() ? i : place.at(found->second.name));
    sign_.push_back(found == sources.end() ? 1.0F : found->second.sign);
  }
  for (std::uint8_t action = 0; action < kActionCount; ++action) {
    const bool is_move = action < kMoveCount;
    turned_[action] =
        is_move ? static_cast<std::uint8_t>(MoveOf(turning.Of(kMoves[action]))) : action;
    plain_[turned_[action]] = action;
  }
}

void TokenSymmetry::Turn(const float* tokens, float* turned) const {
  for (std::size_t i = 0; i < source_.size(); ++i) turned[i] = sign_[i] * tokens[source_[i]];
}

ActionMask TokenSymmetry::Turn(ActionMask plain) const {
  ActionMask turned = 0;
  for (std::uint8_t action = 0; action < kActionCount; ++action) {
    if ((plain & MaskOf(static_cast<Action>(action))) == 0) continue;
    turned = static_cast<ActionMask>(turned | MaskOf(static_cast<Action>(turned_[action])));
  }
  return turned;
}

std::vector<TokenSymmetry> AllSymmetries(const TokenLayout& layout) {
  std::vector<TokenSymmetry> all;
  for (std::size_t symmetry = 0; symmetry < kSymmetries; ++symmetry) {
    all.emplace_back(layout, symmetry);
  }
  return all;
}

}  // namespace aquafarm::agents
