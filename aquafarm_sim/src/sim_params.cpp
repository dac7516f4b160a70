// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/sim_params.h"

#include <ros/package.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <sstream>

#include "aquafarm/check.h"

namespace aquafarm_sim {
namespace {

using aquafarm::InputError;
namespace fs = std::filesystem;

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// Reads parameters of one node and remembers which there are.
class Reader {
 public:
  explicit Reader(const ros::NodeHandle& node) : node_(node) {}

  template <typename T>
  void Read(const std::string& name, const char* type, T& value) {
    known_.push_back(name);
    if (!node_.hasParam(name)) return;
    if (!node_.getParam(name, value)) {
      throw InputError("~" + name + ": got another type, expected " + type);
    }
  }
  void ReadDouble(const std::string& name, double least, double most, double& value) {
    Read(name, "a number", value);
    if (!std::isfinite(value) || value < least || value > most) {
      throw InputError("~" + name + ": got " + Text(value) + ", expected [" + Text(least) + ", " +
                       Text(most) + "]");
    }
  }
  void ReadInt(const std::string& name, int least, int most, int& value) {
    Read(name, "a whole number", value);
    if (value < least || value > most) {
      throw InputError("~" + name + ": got " + std::to_string(value) + ", expected [" +
                       std::to_string(least) + ", " + std::to_string(most) + "]");
    }
  }
  void RefuseOthers() {
    known_.push_back("diagnostic_period");  // read by diagnostic_updater
    std::vector<std::string> there;
    node_.getParamNames(there);
    const std::string space = node_.getNamespace() + "/";
    for (const std::string& path : there) {
      if (path.compare(0, space.size(), space) != 0) continue;
      const std::string name = path.substr(space.size());
      if (std::find(known_.begin(), known_.end(), name) == known_.end()) {
        throw InputError("~" + name + ": unknown parameter, expected one of " + Joined(known_));
      }
    }
  }

 private:
  static std::string Text(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
  }
  const ros::NodeHandle& node_;
  std::vector<std::string> known_;
};

}  // namespace

SimParams ReadSimParams(const ros::NodeHandle& private_node) {
  SimParams params;
  Reader reader(private_node);
  int farms = params.ranch.farms;
  int threads = params.ranch.threads;
  int seed = 1;
  std::string pace = "lockstep";
  reader.Read("scenario", "a name or path", params.scenario);
  reader.ReadInt("farms", 1, kMaxFarms, farms);
  reader.ReadInt("threads", 1, 256, threads);
  reader.ReadInt("seed", -1, INT32_MAX, seed);
  reader.Read("pace", "lockstep or paced", pace);
  reader.ReadDouble("rate_hz", kMinRate_hz, kMaxRate_hz, params.ranch.rate_hz);
  reader.ReadDouble("barrier_timeout_s", 0.01, 3600.0, params.ranch.barrier_timeout_s);
  reader.ReadDouble("publish_hz", 0.0, kMaxRate_hz, params.publish_hz);
  reader.Read("record", "true or false", params.record);
  reader.ReadDouble("recorder_wait_s", 0.0, 3600.0, params.recorder_wait_s);
  reader.Read("publish_clock", "true or false", params.publish_clock);
  reader.Read("map_frame", "a frame", params.map_frame);
  reader.Read("earth_frame", "a frame", params.earth_frame);
  reader.Read("frame_prefix", "a text", params.frame_prefix);
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
