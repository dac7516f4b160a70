// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// File format of a complete learner or of a policy alone. Little-endian:
///
///   magic "aquaCKPT" | u32 format | u32 0 | u64 bytes of index | u64 bytes of sections |
///   u64 checksum of all that follows | index (CBOR: metadata and section table) | raw sections
///
/// Files are written by WriteFileAtomically, so a file is never incomplete.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/environment/environment.h"

namespace aquafarm::agents {

inline constexpr std::uint32_t kCheckpointFormat = 2;

/// Content of a checkpoint file: a learner during a training, or a policy.
struct Checkpoint {
  // Metadata.
  std::string kind;          ///< kTraining or kPolicy
  std::string algorithm;     ///< such as q_learning
  std::string options;       ///< resolved options of the learner
  std::string version;       ///< version of the suite that wrote it
  std::uint64_t seed{};      ///< seed of the training
  EnvironmentSpec spec;      ///< spec of the training farms, without the YAML text
  std::uint64_t steps{};     ///< farm steps of training so far
  std::uint64_t episodes{};  ///< episodes of training so far

  std::map<std::string, std::string> sections;  ///< raw bytes by name

  inline static constexpr const char* kTraining = "training";
  inline static constexpr const char* kPolicy = "policy";

  bool Has(const std::string& name) const { return sections.count(name) != 0; }
  /// @throws InputError if there is no such section
  const std::string& Section(const std::string& name) const;

  template <typename T>
  void SetArray(const std::string& name, const std::vector<T>& values) {
    sections[name].assign(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  /// @throws InputError unless the section has exactly `size` values
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

/// Writes a checkpoint file. @throws StorageError; the file is then unchanged
void WriteCheckpoint(const std::string& path, const Checkpoint& checkpoint);

/// Reads a checkpoint file.
/// @throws InputError if it is missing, is not a checkpoint, is damaged or has another format
Checkpoint ReadCheckpoint(const std::string& path);

/// Checks that a training with the given settings can resume from a checkpoint.
/// @param path file name of the checkpoint, for messages
/// @throws InputError naming the difference
void CheckContinues(const Checkpoint& checkpoint, const std::string& path,
                    const std::string& algorithm, const std::string& options, std::uint64_t seed,
                    const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
