// SPDX-License-Identifier: BSD-3-Clause
#include "yaml_reader.h"

#include <algorithm>

namespace aquafarm::internal {
namespace {

// For messages of one line.
std::string Shortened(std::string text) {
  constexpr std::size_t kLongest = 60;
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c >= 0 && c < ' '; }, ' ');
  return text;
}

std::string KindOf(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Map:
      return "a block of keys";
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Scalar:
      return "'" + Shortened(node.Scalar()) + "'";
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
  if (!node.IsMap()) throw Refusal(path_, node, "a block of keys");
  for (const auto& pair : node) {
    if (!pair.first.IsScalar()) {
      throw FieldError(path_, "got " + KindOf(pair.first) + " as a key, expected a name");
    }
    const std::string key = pair.first.Scalar();
    const std::string here = Join(path_, Shortened(key));
    lines_.Put(here, pair.first);
    if (!nodes_.emplace(key, pair.second).second) {
      throw FieldError(here, "got the key twice, expected it once");
    }
  }
}

void YamlReader::When(bool used, const char* condition) {
  used_ = used;
  condition_ = condition;
}

const YAML::Node* YamlReader::Take(const char* key) {
  const auto found = nodes_.find(key);
  if (!used_) {
    if (found == nodes_.end()) return nullptr;
    throw FieldError(Join(path_, key), std::string("is used only where ") + condition_);
  }
  allowed_.emplace_back(key);
  return found == nodes_.end() ? nullptr : &found->second;
}

void YamlReader::Finish() const {
  for (const auto& [key, node] : nodes_) {
    if (std::find(allowed_.begin(), allowed_.end(), key) != allowed_.end()) continue;
    const std::optional<std::string> nearest = Nearest(key, allowed_);
    throw FieldError(Join(path_, Shortened(key)),
                     "unknown key '" + Shortened(key) + "'" +
                         (nearest ? " (did you mean '" + *nearest + "'?)" : "") +
                         "; allowed: " + List(allowed_));
  }
}

void YamlReader::CheckList(const std::string& path, const YAML::Node& node,
                           const std::array<std::size_t, 2>& sizes) {
  if (!node.IsSequence()) throw Refusal(path, node, "a list");
  CheckSize(path, node.size(), sizes);
}

FieldError YamlReader::Refusal(const std::string& path, const YAML::Node& node,
                               const std::string& expected) {
  return FieldError(path, "got " + KindOf(node) + ", expected " + expected);
}

void YamlReader::Read(const std::string& path, const YAML::Node& node, bool& value, AnyFlag) {
  const std::string text = node.IsScalar() ? node.Scalar() : "";
  value = text == "true";
  if (!value && text != "false") throw Refusal(path, node, Expected(value, AnyFlag{}));
}

void YamlReader::Read(const std::string& path, const YAML::Node& node, std::string& value, TextOf) {
  if (!node.IsScalar()) throw Refusal(path, node, Expected(value, TextOf{}));
  value = node.Scalar();
}

void YamlReader::Read(const std::string& path, const YAML::Node& node, std::int64_t& value,
                      UtcTime) {
  if (node.IsScalar() && ParseTime(node.Scalar(), value)) return;
  throw Refusal(path, node, Expected(value, UtcTime{}));
}

std::size_t YamlReader::ReadName(const std::string& path, const YAML::Node& node,
                                 const std::vector<std::string>& names) {
  const std::string text = node.IsScalar() ? node.Scalar() : "";
  const auto found = std::find(names.begin(), names.end(), text);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  const std::optional<std::string> nearest = Nearest(text, names);
  throw Refusal(path, node,
                "one of " + List(names) + (nearest ? " (did you mean '" + *nearest + "'?)" : ""));
}

}  // namespace aquafarm::internal
