// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target for bags: reads an input as verify_bag does.
#include <rosbag/bag.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

#include "aquafarm/base/check.h"
#include "aquafarm_sim/bags/bag_check.h"

// Keeps a bag open, so that rosbag's plugin for encryption stays loaded. Else each input would load
// the plugin again.
const rosbag::Bag& KeepPlugin() {
  static const std::string path = "/dev/shm/fuzz_bag_open." + std::to_string(getpid());
  static const rosbag::Bag bag(path, rosbag::bagmode::Write);
  unlink(path.c_str());
  return bag;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string path = "/dev/shm/fuzz_bag." + std::to_string(getpid());
  [[maybe_unused]] static const rosbag::Bag& open_bag = KeepPlugin();
  std::ofstream(path, std::ios::binary) << std::string(reinterpret_cast<const char*>(data), size);
  try {
    aquafarm_sim::CheckBag(path, "");
  } catch (const aquafarm::InputError&) {  // expected; any other exception is a bug
  }
  unlink(path.c_str());
  return 0;
}
