// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <map>

#include "scenario/schema.h"

namespace aquafarm::internal {

/// A key that a file gives by its old name.
struct OldName {
  std::string path;
  std::string new_key;
};

/// Line numbers of keys by path, and the keys that a file gives by their old names.
class LineMap {
 public:
  void Put(const std::string& path, const YAML::Node& node);
  /// Returns the line of a path, or of the nearest enclosing block; 0 if unknown.
  int Find(std::string path) const;
  void PutOld(OldName name) { old_names_.push_back(std::move(name)); }
  const std::vector<OldName>& old_names() const { return old_names_; }

 private:
  std::map<std::string, int> lines_;
  std::vector<OldName> old_names_;
};

/// Archive that fills structs from a block of keys. The value of an absent key does not change.
class YamlReader {
 public:
  static constexpr bool kReads = true;

  /// @throws FieldError if the node is not a block of keys, or if a key is not a name or occurs
  ///   twice
  YamlReader(const YAML::Node& node, std::string path, LineMap& lines);

  bool Has(const char* key, bool) const { return nodes_.count(key) > 0; }
  void When(bool used, const char* condition);
  void Always() { When(true, ""); }
  const std::string& path() const { return path_; }

  template <typename T, typename Domain>
  void Field(const char* key, T& value, const Domain& domain, Need need = Need::kOptional) {
    const YAML::Node* node = Take(key);
    const std::string path = Join(path_, key);
    if (node != nullptr) {
      Read(path, *node, value, domain);
      Check(path, value, domain);
    } else if (need == Need::kRequired && used_) {
      throw FieldError(path, "missing, expected " + Expected(value, domain));
    }
  }

  /// Reads a key as Field does. The file may give it by its present or its old name.
  template <typename T, typename Domain>
  void Renamed(const char* key, const char* old_key, T& value, const Domain& domain) {
    Field(IsOld(key, old_key) ? old_key : key, value, domain);
  }

  template <typename Visit>
  void Struct(const char* key, const Visit& visit) {
    if (const YAML::Node* node = Take(key)) Block(*node, Join(path_, key), visit);
  }

  template <typename T, typename Visit>
  void Optional(const char* key, std::optional<T>& value, const Visit& visit) {
    const YAML::Node* node = Take(key);
    if (node == nullptr) return;
    Block(*node, Join(path_, key), [&](YamlReader& child) { visit(child, value.emplace()); });
  }

  template <typename T, typename Visit>
  void Structs(const char* key, std::vector<T>& values, std::array<std::size_t, 2> sizes,
               const Visit& visit) {
    const YAML::Node* node = Take(key);
    if (node == nullptr) return;
    const std::string path = Join(path_, key);
    CheckList(path, *node, sizes);
    values.clear();
    for (const YAML::Node& entry : *node) {
      const std::string here = At(path, values.size());
      lines_.Put(here, entry);
      T value;
      Block(entry, here, [&](YamlReader& child) { visit(child, value); });
      values.push_back(std::move(value));
    }
  }

  /// @throws FieldError if the block has a key that was not visited; the message lists the valid
  ///   keys
  void Finish() const;

 private:
  template <typename Visit>
  void Block(const YAML::Node& node, const std::string& path, const Visit& visit) {
    YamlReader child(node, path, lines_);
    visit(child);
    child.Finish();
  }

  /// Returns whether the block has a key by its old name; if so, records it in the LineMap.
  /// @throws FieldError if the block has both names
  bool IsOld(const char* key, const char* old_key);
  /// Returns the node of a key, or nullptr if the key is absent.
  /// @throws FieldError if the key is given but not in use (When)
  const YAML::Node* Take(const char* key);
  static void CheckList(const std::string& path, const YAML::Node& node,
                        const std::array<std::size_t, 2>& sizes);
  static FieldError Refusal(const std::string& path, const YAML::Node& node,
                            const std::string& expected);

  // Expected returns a description of the valid values for messages.
  template <typename T>
  static std::enable_if_t<std::is_arithmetic_v<T>, std::string> Expected(
      const T&, const Interval<T>& domain) {
    return (std::is_integral_v<T> ? "a whole number in " : "a number in ") + Describe(domain);
  }
  template <typename Enum>
  static std::enable_if_t<std::is_enum_v<Enum>, std::string> Expected(const Enum&, OneOfNames) {
    return "one of " + List(NamesOf<Enum>());
  }
  static std::string Expected(bool, AnyFlag) { return "true or false"; }
  static std::string Expected(const std::string&, TextOf) { return "a text"; }
  static std::string Expected(const std::string&, LinesOf) { return "a text"; }
  static std::string Expected(float, NumberOrNone) { return "a number or .nan"; }
  static std::string Expected(std::int64_t, UtcTime) {
    return "a UTC time such as 2021-07-24T12:00:00Z";
  }
  template <typename T, typename Domain>
  static std::string Expected(const T&, const Domain&) {
    return "a list";  // also for a cell and for a pair of numbers
  }
  template <typename T, typename Domain>
  static std::string Expected(const std::optional<T>& value, const Domain& domain) {
    return Expected(value.value_or(T{}), domain);
  }

  template <typename T>
  static std::enable_if_t<std::is_arithmetic_v<T>> Read(const std::string& path,
                                                        const YAML::Node& node, T& value,
                                                        const Interval<T>& domain) {
    if (node.IsScalar() && Parse(node.Scalar(), value)) return;
    throw Refusal(path, node, Expected(value, domain));
  }
  template <typename T, typename Domain>
  static void Read(const std::string& path, const YAML::Node& node, std::optional<T>& value,
                   const Domain& domain) {
    Read(path, node, value.emplace(), domain);
  }
  template <typename T>
  static void ReadPair(const std::string& path, const YAML::Node& node, T& first, T& second,
                       const Interval<T>& domain) {
    CheckList(path, node, {2, 2});
    Read(At(path, 0), node[0], first, domain);
    Read(At(path, 1), node[1], second, domain);
  }
  template <typename T>
  static void Read(const std::string& path, const YAML::Node& node, Range<T>& value,
                   const Interval<T>& domain) {
    ReadPair(path, node, value.min, value.max, domain);
  }
  static void Read(const std::string& path, const YAML::Node& node, std::array<float, 2>& value,
                   const Interval<float>& domain) {
    ReadPair(path, node, value[0], value[1], domain);
  }
  static void Read(const std::string& path, const YAML::Node& node, QuadrantRadii& value,
                   const Interval<float>& domain) {
    CheckList(path, node, {value.size(), value.size()});
    for (std::size_t i = 0; i < value.size(); ++i) Read(At(path, i), node[i], value[i], domain);
  }
  static void Read(const std::string& path, const YAML::Node& node, float& value, NumberOrNone);
  static void Read(const std::string& path, const YAML::Node& node, Cell& value, AnyCell) {
    ReadPair(path, node, value.x, value.y, Interval<std::int32_t>{0, kMaxSide - 1});
  }
  static void Read(const std::string& path, const YAML::Node& node, bool& value, AnyFlag);
  static void Read(const std::string& path, const YAML::Node& node, std::string& value, TextOf);
  static void Read(const std::string& path, const YAML::Node& node, std::int64_t& value, UtcTime);
  template <typename Enum>
  static std::enable_if_t<std::is_enum_v<Enum>> Read(const std::string& path,
                                                     const YAML::Node& node, Enum& value,
                                                     OneOfNames) {
    value = static_cast<Enum>(ReadName(path, node, NamesOf<Enum>()));
  }
  static std::size_t ReadName(const std::string& path, const YAML::Node& node,
                              const std::vector<std::string>& names);
  template <typename T, typename Domain>
  static void Read(const std::string& path, const YAML::Node& node, std::vector<T>& values,
                   const ListOf<Domain>& domain) {
    CheckList(path, node, {domain.min_size, domain.max_size});
    values.clear();
    for (const YAML::Node& entry : node) {
      T value{};
      Read(At(path, values.size()), entry, value, domain.entry);
      values.push_back(value);
    }
  }

  std::string path_;
  LineMap& lines_;
  std::map<std::string, YAML::Node> nodes_;
  std::vector<std::string> allowed_;
  bool used_{true};
  const char* condition_{""};
};

/// Reads a YAML text that consists of one block of keys. `visit` reads the keys, and `check` then
/// validates the result.
/// @param what description of such a file for messages, for example "a scenario"
/// @returns a notice for the user for each key that is given by its old name
/// @throws InputError "file:line: key: …" for invalid YAML, for a key that `visit` does not read,
///   and for the errors of `visit` and `check`
std::vector<std::string> ReadYaml(const std::string& text, const std::string& origin_name,
                                  const std::string& what,
                                  const std::function<void(YamlReader&)>& visit,
                                  const std::function<void()>& check);

}  // namespace aquafarm::internal
