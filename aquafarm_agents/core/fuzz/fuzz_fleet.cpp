// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target for the lists of a rescue. The first byte selects the list: s for ships, any other
// byte for devices. The ranch and its storm are those of Typhoon In-Fa.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string>

#include "aquafarm/agents/rescue/rescue_case.h"
#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "rescue/case_parts.h"

namespace {

using namespace aquafarm;

agents::RescueRequest OfInFa() {
  agents::RescueRequest request;
  request.storm = AQUAFARM_STORM_FILE;
  request.storm_name = "In-fa";
  request.at = 1627174800;  // 2021-07-25T01:00:00Z
  return request;
}

/// Returns the case without devices, ships and ports. It is made once, because reading the storm
/// takes time.
agents::RescueCase WithoutFleet() {
  agents::RescueCase rescue =
      agents::MakeRescueCase(std::make_shared<const Scenario>(
                                 LoadScenario(AQUAFARM_SCENARIO_DIR "/zhoushan_infa_2021.yaml")),
                             OfInFa());
  rescue.problem.devices.clear();
  rescue.problem.ships.clear();
  rescue.problem.ports.clear();
  return rescue;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const agents::RescueCase without_fleet = WithoutFleet();
  static const std::string path = "/dev/shm/fuzz_fleet." + std::to_string(getpid());
  if (size == 0) return 0;
  std::ofstream(path, std::ios::binary)
      << std::string(reinterpret_cast<const char*>(data) + 1, size - 1);
  agents::RescueRequest request = OfInFa();
  (data[0] == 's' ? request.ships_file : request.devices) = path;
  agents::RescueCase rescue = without_fleet;
  try {
    agents::ReadFleet(request, rescue);
  } catch (const InputError&) {  // expected for invalid input; any other failure is a bug
  }
  unlink(path.c_str());
  return 0;
}
