// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Reads messages of bags whose definitions are older than those of this version. A definition may
/// gain fields, never lose or change one. The fields that an old message lacks are zero: numbers 0,
/// strings and arrays empty.
///
/// When fields are added to a message that bags contain: the md5 sums that a release had are in
/// kOlderMessages. Nothing else is needed, since both definitions are parsed.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace aquafarm_sim {

/// A message definition of an earlier version.
struct OlderMessage {
  std::string_view type;
  std::string_view md5sum;
};

/// Definitions that this version can still read.
inline constexpr std::array<OlderMessage, 4> kOlderMessages{{
    {"aquafarm_msgs/FarmSpec", "dc645def7450ce7b7546018ebd6bd293"},        // 0.1.0
    {"aquafarm_msgs/FarmState", "7cc3a3ac59b389c71adbfc34a6052e14"},       // 0.1.0
    {"aquafarm_msgs/EpisodeSummary", "bc5de7d4c54257781f6cf02455e96c5b"},  // 0.1.0
    {"aquafarm_msgs/EpisodeSummary", "ea008750c7b063b51da8fa41320c4c6b"},  // without money
}};

/// Returns whether a definition is one of kOlderMessages.
bool IsOlderMessage(std::string_view type, std::string_view md5sum);

/// Thrown for a definition that cannot be parsed, and for a message that does not fit it.
struct TranslationError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The fields of a message type and of the types that it contains (wiki.ros.org/msg).
class MessageDefinition {
 public:
  static constexpr std::int64_t kScalar = -1;
  static constexpr std::int64_t kAnyLength = -2;
  struct Type;
  struct Field {
    std::string name;
    std::string type_name;
    const Type* type;
    std::int64_t count;  ///< of a fixed array; kScalar or kAnyLength
  };
  struct Type {
    std::size_t bytes{};  ///< of a number; 0: a string or a message
    bool is_string{};
    std::vector<Field> fields;  ///< of a message, in order
  };

  /// @param type with its package @param text the definition with those of the types it contains
  /// @throws TranslationError
  MessageDefinition(const std::string& type, const std::string& text);

  const Type& root() const { return *root_; }

 private:
  using Texts = std::map<std::string, std::string>;  // by type
  const Type* Find(const std::string& name, const Texts& texts, int depth);
  void ReadFields(const std::string& of, const std::string& text, const Texts& texts, int depth,
                  Type& type);

  std::map<std::string, std::unique_ptr<Type>> types_;
  const Type* root_{};
};

/// Converts serialized messages of one definition to another by the names of their fields.
class MessageTranslator {
 public:
  using Bytes = std::vector<std::uint8_t>;

  /// @throws TranslationError for a definition that cannot be parsed, or for a field with another
  ///         type
  MessageTranslator(const std::string& type, const std::string& from, const std::string& to);

  /// Fields that only the new definition has are zero; those that only the old one has are dropped.
  /// @throws TranslationError if the message is not one of the old definition
  Bytes Translate(const Bytes& message) const;

 private:
  MessageDefinition from_;
  MessageDefinition to_;
};

}  // namespace aquafarm_sim
