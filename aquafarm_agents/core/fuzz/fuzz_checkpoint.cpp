// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target for checkpoints. Repairs the magic, format, sizes and checksum of the header, so that
// the reader accepts them. Then parses the checkpoint and makes its policy. The policies of an
// algorithm use the environment spec of the first sample that needs no repair.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>

#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/agents/training/algorithms.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/hash.h"
#include "learning/parse_checkpoint.h"

namespace {

constexpr std::size_t kHeader = 40;  // magic, format, zero, index_bytes, section_bytes, checksum

std::uint64_t Get(const std::string& bytes, std::size_t at) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

void Put(std::string& bytes, std::size_t at, std::uint64_t value) {
  std::memcpy(bytes.data() + at, &value, sizeof(value));
}

/// Repairs the header; returns false if nothing had to be repaired.
bool Repair(std::string& bytes) {
  const std::string before = bytes.substr(0, kHeader);
  const std::uint64_t body = bytes.size() - kHeader;
  std::memcpy(bytes.data(), "aquaCKPT", 8);
  Put(bytes, 8, aquafarm::agents::kCheckpointFormat);
  const std::uint64_t index = Get(bytes, 16) <= body ? Get(bytes, 16) : body / 2;
  Put(bytes, 16, index);
  Put(bytes, 24, body - index);
  Put(bytes, 32, aquafarm::HashBytes(std::string_view(bytes).substr(kHeader)));
  return bytes.compare(0, kHeader, before) != 0;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aquafarm::agents;
  static std::map<std::string, EnvironmentSpec> specs;
  if (size < kHeader) return 0;
  std::string bytes(reinterpret_cast<const char*>(data), size);
  const bool changed = Repair(bytes);
  try {
    const Checkpoint checkpoint = ParseCheckpoint(bytes, "fuzz");
    if (!changed) specs.emplace(checkpoint.algorithm, checkpoint.spec);
    const auto spec = specs.find(checkpoint.algorithm);
    if (spec != specs.end()) FindAlgorithm(spec->first).make_policy(checkpoint, spec->second);
  } catch (const aquafarm::InputError&) {  // expected for invalid input; any other failure is a bug
  }
  return 0;
}
