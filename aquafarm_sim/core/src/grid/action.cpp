// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/grid/action.h"

#include "base/name_of.h"

namespace aquafarm {

using internal::NameOf;

std::string_view ToString(Action value) {
  static constexpr std::array<std::string_view, kActionCount + 1> kNames{
      "north",      "south",      "west",   "east",     "north_west", "north_east",
      "south_west", "south_east", "pickup", "drop_off", "hold"};
  return NameOf(value, kNames);
}

std::string_view ToString(Outcome value) {
  static constexpr std::array<std::string_view, kOutcomeCount> kNames{
      "ok",   "edge",       "crash", "collision", "illegal_pickup", "illegal_drop_off",
      "held", "out_of_play"};
  return NameOf(value, kNames);
}

std::string_view ToString(EndReason value) {
  static constexpr std::array<std::string_view, kEndReasonCount> kNames{
      "none", "all_retrieved", "disaster_ended", "step_limit"};
  return NameOf(value, kNames);
}

}  // namespace aquafarm
