// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// One file that holds a learner, whole or as a policy alone. Little-endian:
///
///   magic "aquaCKPT" | u32 format | u32 0 | u64 bytes of index | u64 bytes of sections |
///   u64 checksum of all that follows | index (CBOR: what it is, and its sections) | raw sections
///
/// It is written beside, synced and renamed, so a name never stands for half a file.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/environment/environment.h"

namespace aquafarm::agents {

inline constexpr std::uint32_t kCheckpointFormat = 2;

struct Checkpoint {
  // What it is.
  std::string kind;          ///< kTraining or kPolicy
  std::string algorithm;     ///< such as q_learning
  std::string options;       ///< of the learner, resolved
  std::string version;       ///< of the suite that wrote it
  std::uint64_t seed{};      ///< of the training
  EnvironmentSpec spec;      ///< farms that it was made on; without the YAML text
  std::uint64_t steps{};     ///< farm steps and
  std::uint64_t episodes{};  ///< episodes of training behind it

  std::map<std::string, std::string> sections;  ///< raw bytes by name

  inline static constexpr const char* kTraining = "training";
  inline static constexpr const char* kPolicy = "policy";

  bool Has(const std::string& name) const { return sections.count(name) != 0; }
  /// @throws InputError when there is none
  const std::string& Section(const std::string& name) const;

  template <typename T>
  void SetArray(const std::string& name, const std::vector<T>& values) {
    sections[name].assign(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  /// @throws InputError unless there are exactly `size` values
  template <typename T>
  void GetArray(const std::string& name, std::size_t size, std::vector<T>& values) const {
    const std::string& bytes = Section(name);
    CheckSize(name, bytes.size(), size * sizeof(T));
    values.resize(size);
    bytes.copy(reinterpret_cast<char*>(values.data()), bytes.size());
  }

 private:
  static void CheckSize(const std::string& name, std::size_t got, std::size_t expected);
};

/// @throws StorageError; the file is then as it was
void WriteCheckpoint(const std::string& path, const Checkpoint& checkpoint);

/// @throws InputError when it is missing, no checkpoint, damaged or of another format
Checkpoint ReadCheckpoint(const std::string& path);

/// Refuses to continue a training on other terms. @param path stands first in messages
/// @throws InputError with what differs
void CheckContinues(const Checkpoint& checkpoint, const std::string& path,
                    const std::string& algorithm, const std::string& options, std::uint64_t seed,
                    const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
