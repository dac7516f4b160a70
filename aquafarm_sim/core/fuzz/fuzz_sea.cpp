// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target for netCDF fields. netCDF reads only files, so each input is written to /dev/shm
// first. Inputs with the signature of HDF5 are skipped, because libhdf5 reads them and its faults
// are not those of this project.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

#include "aquafarm/base/check.h"
#include "aquafarm/sea/sea_field.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aquafarm;
  static const std::string path = "/dev/shm/fuzz_sea." + std::to_string(getpid());
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (bytes.find("\x89HDF\r\n\x1a\n") != std::string::npos) return 0;
  std::ofstream(path, std::ios::binary) << bytes;
  const GeoFrame frame({30.1, 122.1}, 1000.0);
  try {
    ToLayer(LoadSeaField(path, {"t", {}, 0.0}, frame, 12, 8), frame, 12, 8);
  } catch (const InputError&) {  // expected for invalid input; any other failure is a bug
  }
  unlink(path.c_str());
  return 0;
}
