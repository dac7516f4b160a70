// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/node/sim_params.h"

#include <ros/package.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include "aquafarm/base/check.h"
#include "aquafarm_sim/params.h"

namespace aquafarm_sim {
namespace {

using aquafarm::InputError;
namespace fs = std::filesystem;

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

SimParams ReadSimParams(const ros::NodeHandle& private_node) {
  SimParams params;
  Params reader(private_node);
  int farms = params.ranch.farms;
  int threads = params.ranch.threads;
  int seed = 1;
  std::string pace = "lockstep";
  reader.Text("scenario", params.scenario);
  reader.Int("farms", 1, kMaxFarms, farms);
  reader.Int("threads", 1, 256, threads);
  reader.Int("seed", -1, INT32_MAX, seed);
  reader.Text("pace", pace);
  reader.Number("rate_hz", kMinRate_hz, kMaxRate_hz, params.ranch.rate_hz);
  reader.Number("barrier_timeout_s", 0.01, 3600.0, params.ranch.barrier_timeout_s);
  reader.Flag("late_ships_hold", params.ranch.late_ships_hold);
  reader.Number("claim_timeout_s", 0.1, 3600.0, params.ranch.claim_timeout_s);
  reader.Number("publish_hz", 0.0, kMaxRate_hz, params.publish_hz);
  reader.Flag("record", params.record);
  reader.Text("keep", params.keep);
  reader.Text("keep_dir", params.keep_dir);
  reader.Number("recorder_wait_s", 0.0, 3600.0, params.recorder_wait_s);
  reader.Flag("publish_clock", params.publish_clock);
  reader.Text("map_frame", params.map_frame);
  reader.Text("earth_frame", params.earth_frame);
  reader.Text("frame_prefix", params.frame_prefix);
  reader.Allow("diagnostic_period");  // read by diagnostic_updater
  reader.RefuseOthers();
  if (pace != "lockstep" && pace != "paced") {
    throw InputError("~pace: got '" + pace + "', expected lockstep or paced");
  }
  params.ranch.farms = farms;
  params.ranch.threads = threads;
  params.ranch.seed = seed < 0 ? ros::WallTime::now().toNSec() : static_cast<std::uint64_t>(seed);
  params.ranch.paced = pace == "paced";
  params.ranch.map_frame = params.map_frame;
  return params;
}

std::vector<std::string> ShippedScenarios(const std::string& folder) {
  std::vector<std::string> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".yaml") found.push_back(entry.path().stem().string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string ResolveScenario(const std::string& scenario, const std::string& folder) {
  const bool is_path =
      scenario.find('/') != std::string::npos || fs::path(scenario).extension() == ".yaml";
  const std::string path = is_path ? scenario : (fs::path(folder) / (scenario + ".yaml")).string();
  std::error_code error;
  if (fs::is_regular_file(path, error)) return path;
  throw InputError("scenario: got '" + scenario + "', expected the path of a file or one of " +
                   Joined(ShippedScenarios(folder)));
}

std::string ScenarioFolder() { return ros::package::getPath("aquafarm_sim") + "/scenarios"; }

}  // namespace aquafarm_sim
