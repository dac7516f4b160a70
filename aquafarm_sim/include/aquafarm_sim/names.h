// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Names of topics, services and tf frames of a ranch. The name of a topic or service is relative
/// to the ranch's namespace unless it starts with a slash. C++ nodes must use these constants.

#include <cstdint>
#include <string>

namespace aquafarm_sim::names {

inline constexpr const char* kSpec = "spec";
inline constexpr const char* kState = "state";
inline constexpr const char* kSavedState = "saved_state";
inline constexpr const char* kChart = "chart";
inline constexpr const char* kRisk = "risk";
inline constexpr const char* kSea = "sea";
inline constexpr const char* kEpisode = "episode";
inline constexpr const char* kTraining = "training";
inline constexpr const char* kValues = "values";
inline constexpr const char* kValuePoints = "values/points";
inline constexpr const char* kChoice = "choice";
inline constexpr const char* kClock = "/clock";

inline constexpr const char* kCommand = "command";
inline constexpr const char* kStep = "step";
inline constexpr const char* kReset = "reset";
inline constexpr const char* kGetState = "get_state";
inline constexpr const char* kSaveState = "save_state";
inline constexpr const char* kLoadState = "load_state";
inline constexpr const char* kPause = "pause";
inline constexpr const char* kSetDisaster = "set_disaster";
inline constexpr const char* kSetPace = "set_pace";

inline constexpr const char* kMapFrame = "map";
inline constexpr const char* kEarthFrame = "earth";

/// Name of a ship's namespace, and of its tf frame without SimParams::frame_prefix.
inline std::string Ship(std::int32_t id) { return "ship_" + std::to_string(id); }
/// Name of a disaster's tf frame without SimParams::frame_prefix.
inline std::string Disaster(std::int32_t id) { return "disaster_" + std::to_string(id); }
/// Topic of a sea layer as an occupancy grid, for display.
inline std::string Sea(const std::string& layer) { return std::string(kSea) + "/" + layer; }
/// Topic of the values of a sea layer.
inline std::string SeaValues(const std::string& layer) { return Sea(layer) + "/values"; }
inline std::string Observation(std::int32_t ship) { return Ship(ship) + "/observation"; }
inline std::string Claim(std::int32_t ship) { return Ship(ship) + "/claim"; }
inline std::string Move(std::int32_t ship) { return Ship(ship) + "/move"; }
inline std::string Pickup(std::int32_t ship) { return Ship(ship) + "/pickup"; }
inline std::string DropOff(std::int32_t ship) { return Ship(ship) + "/drop_off"; }

}  // namespace aquafarm_sim::names
