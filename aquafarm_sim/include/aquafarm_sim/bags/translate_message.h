// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Translates messages of earlier versions in bags to the definitions of this version. A new
/// version may add fields to a message, but must not remove or change fields. Fields that an old
/// message lacks become zero: numbers 0, strings and arrays empty.
///
/// If you add fields to a message that bags contain, add the md5 sum of its previous definition to
/// kOlderMessages. If other messages contain this message, add their previous md5 sums too. The
/// translation itself needs no change, because both definitions are parsed.

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

/// Earlier definitions that this version can read.
inline constexpr std::array<OlderMessage, 4> kOlderMessages{{
    {"aquafarm_msgs/FarmSpec", "dc645def7450ce7b7546018ebd6bd293"},        // 0.1.0
    {"aquafarm_msgs/FarmState", "7cc3a3ac59b389c71adbfc34a6052e14"},       // 0.1.0
    {"aquafarm_msgs/EpisodeSummary", "bc5de7d4c54257781f6cf02455e96c5b"},  // 0.1.0
    {"aquafarm_msgs/EpisodeSummary", "ea008750c7b063b51da8fa41320c4c6b"},  // without money
}};

/// Returns whether a definition is one of kOlderMessages.
bool IsOlderMessage(std::string_view type, std::string_view md5sum);

/// Thrown if a definition cannot be parsed, if a field has different types in two definitions, or
/// if a message does not fit its definition.
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
    std::int64_t count;  ///< length of an array of fixed length; else kScalar or kAnyLength
  };
  struct Type {
    std::size_t bytes{};  ///< size of a number, time or duration; 0: a string or a message
    bool is_string{};
    std::vector<Field> fields;  ///< fields of a message, in order
  };

  /// @param type name with package, for example aquafarm_msgs/FarmState
  /// @param text definition of the type, followed by those of the types that it contains
  /// @throws TranslationError if the text cannot be parsed
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

/// Converts serialized messages from one definition to another. Fields are matched by name.
class MessageTranslator {
 public:
  using Bytes = std::vector<std::uint8_t>;

  /// @throws TranslationError if a definition cannot be parsed, or a field has different types in
  ///         the two definitions
  MessageTranslator(const std::string& type, const std::string& from, const std::string& to);

  /// Converts a message. Fields that only the new definition has become zero; fields that only the
  /// old definition has are dropped.
  /// @throws TranslationError if the message does not fit the old definition
  Bytes Translate(const Bytes& message) const;

 private:
  MessageDefinition from_;
  MessageDefinition to_;
};

}  // namespace aquafarm_sim
