// SPDX-License-Identifier: BSD-3-Clause
#include "yaml_reader.h"

#include <algorithm>

namespace aquafarm::internal {
namespace {

std::string KindOf(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Map:
      return "a block of keys";
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Scalar:
      return "'" + node.Scalar() + "'";
    default:
      return "nothing";
  }
}

}  // namespace

void LineMap::Put(const std::string& path, const YAML::Node& node) {
  lines_[path] = node.Mark().line + 1;
}

int LineMap::Find(std::string path) const {
  for (;;) {
    const auto found = lines_.find(path);
    if (found != lines_.end()) return found->second;
    const std::size_t cut = path.find_last_of(".[");
    if (cut == std::string::npos) break;
    path.resize(cut);
  }
  const auto top = lines_.find("");
  return top == lines_.end() ? 0 : top->second;
}

YamlReader::YamlReader(const YAML::Node& node, std::string path, LineMap& lines)
    : path_(std::move(path)), lines_(lines) {
  if (!node.IsMap()) throw FieldError(path_, "got " + KindOf(node) + ", expected a block of keys");
  for (const auto& pair : node) {
    if (!pair.first.IsScalar()) {
      throw FieldError(path_, "got " + KindOf(pair.first) + " as a key, expected a name");
    }
    const std::string key = pair.first.Scalar();
    lines_.Put(Join(path_, key), pair.first);
    if (!nodes_.emplace(key, pair.second).second) {
      throw FieldError(Join(path_, key), "got the key twice, expected it once");
    }
  }
}

void YamlReader::When(bool used, const char* condition) {
  used_ = used;
  condition_ = condition;
}

const YAML::Node* YamlReader::Take(const char* key, Need need) {
  const auto found = nodes_.find(key);
  if (!used_) {
    if (found == nodes_.end()) return nullptr;
    throw FieldError(Join(path_, key), std::string("is used only where ") + condition_);
  }
  allowed_.emplace_back(key);
  if (found != nodes_.end()) return &found->second;
  if (need == Need::kRequired) throw FieldError(Join(path_, key), "missing, expected a value");
  return nullptr;
}

void YamlReader::Finish() const {
  for (const auto& [key, node] : nodes_) {
    if (std::find(allowed_.begin(), allowed_.end(), key) != allowed_.end()) continue;
    const std::optional<std::string> nearest = Nearest(key, allowed_);
    throw FieldError(Join(path_, key), "unknown key '" + key + "'" +
                                           (nearest ? " (did you mean '" + *nearest + "'?)" : "") +
                                           "; allowed: " + List(allowed_));
  }
}

void YamlReader::CheckList(const std::string& path, const YAML::Node& node,
                           const std::array<std::size_t, 2>& sizes) {
  if (!node.IsSequence()) throw FieldError(path, "got " + KindOf(node) + ", expected a list");
  CheckSize(path, node.size(), sizes);
}

std::string YamlReader::Scalar(const std::string& path, const YAML::Node& node,
                               const std::string& expected) {
  if (!node.IsScalar()) throw FieldError(path, "got " + KindOf(node) + ", expected " + expected);
  return node.Scalar();
}

void YamlReader::Read(const std::string& path, const YAML::Node& node, bool& value, AnyFlag) {
  const std::string expected = "true or false";
  const std::string text = Scalar(path, node, expected);
  value = text == "true";
  if (!value && text != "false") {
    throw FieldError(path, "got '" + text + "', expected " + expected);
  }
}

void YamlReader::Read(const std::string& path, const YAML::Node& node, std::int64_t& value,
                      UtcTime) {
  const std::string expected = "a UTC time as 2021-07-24T12:00:00Z";
  const std::string text = Scalar(path, node, expected);
  if (!ParseTime(text, value)) throw FieldError(path, "got '" + text + "', expected " + expected);
}

std::size_t YamlReader::ReadName(const std::string& path, const YAML::Node& node,
                                 const std::vector<std::string>& names) {
  const std::string expected = "one of " + List(names);
  const std::string text = Scalar(path, node, expected);
  const auto found = std::find(names.begin(), names.end(), text);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  const std::optional<std::string> nearest = Nearest(text, names);
  throw FieldError(path, "got '" + text + "', expected " + expected +
                             (nearest ? " (did you mean '" + *nearest + "'?)" : ""));
}

}  // namespace aquafarm::internal
