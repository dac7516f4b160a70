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
#include <cstring>
#include <map>
#include <memory>
#include <sstream>
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
inline constexpr std::array<OlderMessage, 3> kOlderMessages{{
    {"aquafarm_msgs/FarmSpec", "dc645def7450ce7b7546018ebd6bd293"},        // 0.1.0
    {"aquafarm_msgs/FarmState", "7cc3a3ac59b389c71adbfc34a6052e14"},       // 0.1.0
    {"aquafarm_msgs/EpisodeSummary", "bc5de7d4c54257781f6cf02455e96c5b"},  // 0.1.0
}};

inline bool IsOlderMessage(std::string_view type, std::string_view md5sum) {
  for (const OlderMessage& one : kOlderMessages) {
    if (one.type == type && one.md5sum == md5sum) return true;
  }
  return false;
}

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
  MessageDefinition(const std::string& type, const std::string& text) {
    std::map<std::string, std::string> texts;
    std::istringstream lines(text);
    std::string name = type;
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("=====", 0) == 0) continue;
      if (line.rfind("MSG: ", 0) == 0) {
        name = line.substr(5);
      } else {
        texts[name] += line + '\n';
      }
    }
    root_ = Find(type, texts, 0);
  }

  const Type& root() const { return *root_; }

 private:
  static std::size_t BytesOf(const std::string& name) {
    static const std::map<std::string, std::size_t> kBytes{
        {"bool", 1},  {"int8", 1},   {"uint8", 1},   {"byte", 1},   {"char", 1},
        {"int16", 2}, {"uint16", 2}, {"int32", 4},   {"uint32", 4}, {"float32", 4},
        {"int64", 8}, {"uint64", 8}, {"float64", 8}, {"time", 8},   {"duration", 8}};
    const auto found = kBytes.find(name);
    return found == kBytes.end() ? 0 : found->second;
  }

  const Type* Find(const std::string& name, const std::map<std::string, std::string>& texts,
                   int depth) {
    if (const auto known = types_.find(name); known != types_.end()) return known->second.get();
    auto type = std::make_unique<Type>();
    type->bytes = BytesOf(name);
    type->is_string = name == "string";
    if (type->bytes == 0 && !type->is_string) {
      const auto text = texts.find(name);
      if (text == texts.end() || depth > kMaxDepth) {
        throw TranslationError("no definition of " + name);
      }
      ReadFields(name, text->second, texts, depth, *type);
    }
    return types_.emplace(name, std::move(type)).first->second.get();
  }

  void ReadFields(const std::string& of, const std::string& text,
                  const std::map<std::string, std::string>& texts, int depth, Type& type) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      if (line.substr(0, line.find('#')).find('=') != std::string::npos) continue;  // a constant
      std::istringstream words(line.substr(0, line.find('#')));
      Field field{"", "", nullptr, kScalar};
      if (!(words >> field.type_name)) continue;
      if (!(words >> field.name)) throw TranslationError("a field without a name in " + of);
      const std::size_t bracket = field.type_name.find('[');
      if (bracket != std::string::npos) {
        const std::string count = field.type_name.substr(bracket + 1);
        field.count = count == "]" ? kAnyLength : std::strtol(count.c_str(), nullptr, 10);
        field.type_name.resize(bracket);
      }
      if (BytesOf(field.type_name) == 0 && field.type_name != "string" &&
          field.type_name.find('/') == std::string::npos) {
        field.type_name = field.type_name == "Header"
                              ? "std_msgs/Header"
                              : of.substr(0, of.find('/') + 1) + field.type_name;
      }
      field.type = Find(field.type_name, texts, depth + 1);
      type.fields.push_back(std::move(field));
    }
  }

  static constexpr int kMaxDepth = 16;
  std::map<std::string, std::unique_ptr<Type>> types_;
  const Type* root_{};
};

/// Converts serialized messages of one definition to another by the names of their fields.
class MessageTranslator {
 public:
  using Bytes = std::vector<std::uint8_t>;

  /// @throws TranslationError for a definition that cannot be parsed, or for a field with another
  ///         type
  MessageTranslator(const std::string& type, const std::string& from, const std::string& to)
      : from_(type, from), to_(type, to) {
    CheckTypes(from_.root(), to_.root());
  }

  /// Fields that only `to` has are zero; those that only `from` has are dropped.
  /// @throws TranslationError if the message is not one of `from`
  Bytes Translate(const Bytes& message) const {
    Bytes out;
    std::size_t at = 0;
    Copy(from_.root(), to_.root(), message, at, out);
    if (at != message.size()) throw TranslationError("a message longer than its definition");
    return out;
  }

 private:
  using Field = MessageDefinition::Field;
  using Type = MessageDefinition::Type;

  static const Field* Find(const Type& type, const std::string& name) {
    for (const Field& field : type.fields) {
      if (field.name == name) return &field;
    }
    return nullptr;
  }

  static void CheckTypes(const Type& from, const Type& to) {
    for (const Field& field : to.fields) {
      const Field* same = Find(from, field.name);
      if (same == nullptr) continue;
      if (same->type_name != field.type_name || same->count != field.count) {
        throw TranslationError("field " + field.name + " has another type");
      }
      CheckTypes(*same->type, *field.type);
    }
  }

  static std::size_t Take(std::size_t count, const Bytes& in, std::size_t& at) {
    if (count > in.size() - at) throw TranslationError("a message shorter than its definition");
    const std::size_t begin = at;
    at += count;
    return begin;
  }

  static std::uint32_t Length(const Bytes& in, std::size_t& at) {
    std::uint32_t length = 0;
    std::memcpy(&length, in.data() + Take(sizeof(length), in, at), sizeof(length));
    return length;
  }

  // Reads the number of entries of a field. An entry without fields cannot occur in our messages.
  static std::uint64_t CountOf(const Field& field, const Bytes& in, std::size_t& at) {
    if (field.count == MessageDefinition::kScalar) return 1;
    const std::uint64_t count = field.count == MessageDefinition::kAnyLength
                                    ? Length(in, at)
                                    : static_cast<std::uint64_t>(field.count);
    if (count > in.size() - at) throw TranslationError("a message shorter than its definition");
    return count;
  }

  static void Skip(const Field& field, const Bytes& in, std::size_t& at) {
    const std::uint64_t count = CountOf(field, in, at);
    for (std::uint64_t i = 0; i < count; ++i) {
      if (field.type->bytes > 0) {
        Take(field.type->bytes, in, at);
      } else if (field.type->is_string) {
        Take(Length(in, at), in, at);
      } else {
        for (const Field& part : field.type->fields) Skip(part, in, at);
      }
    }
  }

  static void Zero(const Field& field, Bytes& out) {
    if (field.count == MessageDefinition::kAnyLength) {
      out.insert(out.end(), sizeof(std::uint32_t), 0);
      return;
    }
    const std::int64_t count = field.count == MessageDefinition::kScalar ? 1 : field.count;
    for (std::int64_t i = 0; i < count; ++i) {
      if (field.type->bytes > 0 || field.type->is_string) {
        out.insert(out.end(), field.type->is_string ? 4 : field.type->bytes, 0);
      } else {
        for (const Field& part : field.type->fields) Zero(part, out);
      }
    }
  }

  // Copies a message whose fields are found by name. @param at its position in `in`, then its end
  static void Copy(const Type& from, const Type& to, const Bytes& in, std::size_t& at, Bytes& out) {
    std::map<std::string_view, std::size_t> begins;
    for (const Field& field : from.fields) {
      begins[field.name] = at;
      Skip(field, in, at);
    }
    for (const Field& field : to.fields) {
      const Field* same = Find(from, field.name);
      if (same == nullptr) {
        Zero(field, out);
      } else {
        CopyField(*same, field, in, begins[field.name], out);
      }
    }
  }

  static void CopyField(const Field& from, const Field& to, const Bytes& in, std::size_t begin,
                        Bytes& out) {
    std::size_t at = begin;
    const bool is_message = from.type->bytes == 0 && !from.type->is_string;
    if (is_message) {
      const std::uint64_t count = CountOf(from, in, at);
      Append(in, begin, at, out);  // the number of entries
      for (std::uint64_t i = 0; i < count; ++i) Copy(*from.type, *to.type, in, at, out);
    } else {
      Skip(from, in, at);
      Append(in, begin, at, out);
    }
  }

  static void Append(const Bytes& in, std::size_t begin, std::size_t end, Bytes& out) {
    out.insert(out.end(), in.begin() + static_cast<std::ptrdiff_t>(begin),
               in.begin() + static_cast<std::ptrdiff_t>(end));
  }

  MessageDefinition from_;
  MessageDefinition to_;
};

}  // namespace aquafarm_sim
