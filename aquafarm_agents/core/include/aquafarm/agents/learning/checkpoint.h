// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// File format of a learner with its complete state, or of a policy alone. All numbers are
/// little-endian:
///
///   magic "aquaCKPT" | u32 format | u32 0 | u64 size of index | u64 size of sections |
///   u64 checksum of all that follows | index (CBOR: metadata and section table) | raw sections
///
/// Sizes are in bytes.
///
/// WriteFileAtomically writes the files, so a file is never incomplete.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/environment/environment.h"

namespace aquafarm::agents {

/// The only format that this version reads and writes.
inline constexpr std::uint32_t kCheckpointFormat = 2;

/// Metadata of a checkpoint.
struct CheckpointInfo {
  std::string kind;          ///< Checkpoint::kTraining or Checkpoint::kPolicy
  std::string algorithm;     ///< such as q_learning
  std::string options;       ///< resolved options of the learner
  std::string version;       ///< version of the suite that ran the farms
  std::uint64_t seed{};      ///< seed of the training
  EnvironmentSpec spec;      ///< spec of the training farms; without YAML text if read from a file
  std::uint64_t steps{};     ///< farm steps of training so far
  std::uint64_t episodes{};  ///< episodes of training so far
};

/// Content of a checkpoint file: a learner during a training, or a policy.
struct Checkpoint : CheckpointInfo {
  /// A number in a section of named numbers.
  using Number = std::variant<double, std::uint64_t>;

  std::map<std::string, std::string> sections;  ///< raw bytes by name
  /// Further sections. They refer to memory of the learner; see LendArray.
  std::map<std::string, std::string_view> lent;
  /// Whether LendArray may refer to the learner's arrays instead of copying them. Set it only if
  /// the checkpoint is written before the learner changes.
  bool lends{};

  inline static constexpr const char* kTraining = "training";
  inline static constexpr const char* kPolicy = "policy";

  /// Returns whether there is a section with this name.
  bool Has(const std::string& name) const {
    return sections.count(name) != 0 || lent.count(name) != 0;
  }
  /// Returns the bytes of a section. @throws InputError if there is no such section
  std::string_view Section(const std::string& name) const;

  /// Sets a section to a copy of `values`.
  template <typename T>
  void SetArray(const std::string& name, const std::vector<T>& values) {
    sections[name] = BytesOf(values);
  }
  /// Sets a section to a copy of `values` or, if `lends` is true, to a reference to them. They must
  /// then neither change nor be destroyed before the checkpoint is written.
  template <typename T>
  void LendArray(const std::string& name, const std::vector<T>& values) {
    if (!lends) return SetArray(name, values);
    lent[name] = BytesOf(values);
  }
  template <typename T>
  void LendArray(const std::string& name, std::vector<T>&& values) = delete;
  /// Copies a section to `values`.
  /// @throws InputError if there is no such section or it does not have exactly `size` values
  template <typename T>
  void GetArray(const std::string& name, std::size_t size, std::vector<T>& values) const {
    const std::string_view bytes = Section(name);
    CheckSize(name, bytes.size(), size * sizeof(T));
    values.resize(size);
    bytes.copy(reinterpret_cast<char*>(values.data()), bytes.size());
  }

  /// Sets a section of named numbers, as a CBOR map.
  void SetNumbers(const std::string& name, const std::map<std::string, Number>& numbers);
  /// Returns the numbers of a section by name.
  /// @throws InputError if the section is missing or damaged
  std::map<std::string, Number> GetNumbers(const std::string& name) const;

  /// Adds the sections of a part, such as the learner of one agent. Their names get `prefix`.
  void AddPart(const std::string& prefix, Checkpoint&& part);
  /// Returns a checkpoint with the metadata of this one and with the sections that AddPart added
  /// with `prefix`. The returned sections have their original names, without the prefix.
  Checkpoint Part(const std::string& prefix) const;

 private:
  template <typename T>
  static std::string_view BytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
  }
  static void CheckSize(const std::string& name, std::size_t got, std::size_t expected);
};

/// Writes a checkpoint file. @throws StorageError in the same cases as WriteFileAtomically
void WriteCheckpoint(const std::string& path, const Checkpoint& checkpoint);

/// Reads a checkpoint file.
/// @throws InputError if it is missing, is not a checkpoint, is damaged or has another format
Checkpoint ReadCheckpoint(const std::string& path);

/// Checks that a training with the given settings can resume from a checkpoint.
/// @param path path of the checkpoint, for messages
/// @throws InputError that states the first difference
void CheckContinues(const Checkpoint& checkpoint, const std::string& path,
                    const std::string& algorithm, const std::string& options, std::uint64_t seed,
                    const EnvironmentSpec& spec);

/// Checks that a property has the same value for a policy and for the farms of `spec`.
/// @param what name of the property, for the message
/// @param got value of the policy
/// @param expected value of the farms
/// @throws InputError "policy: dqn of scenario paper does not fit scenario x: features: …" if the
///   values differ
void CheckFit(const Checkpoint& policy, const EnvironmentSpec& spec, const std::string& what,
              const std::string& got, const std::string& expected);
void CheckFit(const Checkpoint& policy, const EnvironmentSpec& spec, const std::string& what,
              std::int64_t got, std::int64_t expected);

}  // namespace aquafarm::agents
