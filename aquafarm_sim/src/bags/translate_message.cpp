// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/bags/translate_message.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

namespace aquafarm_sim {
namespace {

using Bytes = MessageTranslator::Bytes;
using Field = MessageDefinition::Field;
using Type = MessageDefinition::Type;

constexpr int kMaxDepth = 16;

std::size_t BytesOf(const std::string& name) {
  static const std::map<std::string, std::size_t> kBytes{
      {"bool", 1},  {"int8", 1},   {"uint8", 1},   {"byte", 1},   {"char", 1},
      {"int16", 2}, {"uint16", 2}, {"int32", 4},   {"uint32", 4}, {"float32", 4},
      {"int64", 8}, {"uint64", 8}, {"float64", 8}, {"time", 8},   {"duration", 8}};
  const auto found = kBytes.find(name);
  return found == kBytes.end() ? 0 : found->second;
}

const Field* Find(const Type& type, const std::string& name) {
  for (const Field& field : type.fields) {
    if (field.name == name) return &field;
  }
  return nullptr;
}

void CheckTypes(const Type& from, const Type& to) {
  for (const Field& field : to.fields) {
    const Field* same = Find(from, field.name);
    if (same == nullptr) continue;
    if (same->type_name != field.type_name || same->count != field.count) {
      throw TranslationError("field " + field.name + " has another type");
    }
    CheckTypes(*same->type, *field.type);
  }
}

std::size_t Take(std::size_t count, const Bytes& in, std::size_t& at) {
  if (count > in.size() - at) throw TranslationError("a message shorter than its definition");
  const std::size_t begin = at;
  at += count;
  return begin;
}

std::uint32_t Length(const Bytes& in, std::size_t& at) {
  std::uint32_t length = 0;
  std::memcpy(&length, in.data() + Take(sizeof(length), in, at), sizeof(length));
  return length;
}

// Reads the number of entries of a field. The check assumes that an entry has at least one byte.
// This is true because all of our messages have fields.
std::uint64_t CountOf(const Field& field, const Bytes& in, std::size_t& at) {
  if (field.count == MessageDefinition::kScalar) return 1;
  const std::uint64_t count = field.count == MessageDefinition::kAnyLength
                                  ? Length(in, at)
                                  : static_cast<std::uint64_t>(field.count);
  if (count > in.size() - at) throw TranslationError("a message shorter than its definition");
  return count;
}

void Skip(const Field& field, const Bytes& in, std::size_t& at) {
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

void Zero(const Field& field, Bytes& out) {
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

void Append(const Bytes& in, std::size_t begin, std::size_t end, Bytes& out) {
  out.insert(out.end(), in.begin() + static_cast<std::ptrdiff_t>(begin),
             in.begin() + static_cast<std::ptrdiff_t>(end));
}

void Copy(const Type& from, const Type& to, const Bytes& in, std::size_t& at, Bytes& out);

void CopyField(const Field& from, const Field& to, const Bytes& in, std::size_t begin, Bytes& out) {
  std::size_t at = begin;
  const bool is_message = from.type->bytes == 0 && !from.type->is_string;
  if (is_message) {
    const std::uint64_t count = CountOf(from, in, at);
    Append(in, begin, at, out);  // copies the number of entries
    for (std::uint64_t i = 0; i < count; ++i) Copy(*from.type, *to.type, in, at, out);
  } else {
    Skip(from, in, at);
    Append(in, begin, at, out);
  }
}

// Copies a message; fields are matched by name.
// @param at position of the message in `in`; receives the position of its end
void Copy(const Type& from, const Type& to, const Bytes& in, std::size_t& at, Bytes& out) {
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

}  // namespace

bool IsOlderMessage(std::string_view type, std::string_view md5sum) {
  return std::any_of(kOlderMessages.begin(), kOlderMessages.end(), [&](const OlderMessage& one) {
    return one.type == type && one.md5sum == md5sum;
  });
}

MessageDefinition::MessageDefinition(const std::string& type, const std::string& text) {
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

const MessageDefinition::Type* MessageDefinition::Find(const std::string& name, const Texts& texts,
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

void MessageDefinition::ReadFields(const std::string& of, const std::string& text,
                                   const Texts& texts, int depth, Type& type) {
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

MessageTranslator::MessageTranslator(const std::string& type, const std::string& from,
                                     const std::string& to)
    : from_(type, from), to_(type, to) {
  CheckTypes(from_.root(), to_.root());
}

MessageTranslator::Bytes MessageTranslator::Translate(const Bytes& message) const {
  Bytes out;
  std::size_t at = 0;
  Copy(from_.root(), to_.root(), message, at, out);
  if (at != message.size()) throw TranslationError("a message longer than its definition");
  return out;
}

}  // namespace aquafarm_sim
