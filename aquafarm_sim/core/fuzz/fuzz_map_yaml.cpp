// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target for the YAML file of a map_server map.
#include <cstddef>
#include <cstdint>
#include <string>

#include "aquafarm/base/check.h"
#include "charts/map_yaml.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aquafarm;
  try {
    internal::ParseMapYaml(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
  } catch (const InputError&) {  // expected for invalid input; any other failure is a bug
  }
  return 0;
}
