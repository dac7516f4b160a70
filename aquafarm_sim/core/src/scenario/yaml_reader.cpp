// SPDX-License-Identifier: BSD-3-Clause
#include "scenario/yaml_reader.h"

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include "aquafarm/base/suggest.h"
#include "base/text.h"
#include "base/time.h"

namespace aquafarm::internal {
namespace {

// Shortens a text for a one-line message.
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

std::string Place(const std::string& origin_name, int line) {
  return line > 0 ? origin_name + ":" + std::to_string(line) + ": " : origin_name + ": ";
}

void CheckText(const std::string& text, const std::string& origin_name) {
  int line = 1;
  for (const char c : text) {
    if (c == '\n') ++line;
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20U || c == '\n' || c == '\t' || c == '\r') continue;
    throw InputError(Place(origin_name, line) + "got byte " + std::to_string(byte) +
                     ", expected text (is this a binary file?)");
  }
}

// Records the line on which the last document starts and ignores all other events.
class DocumentStarts : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& mark) override { line_ = mark.line + 1; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
  int line() const { return line_; }

 private:
  int line_{};
};

// Parses a text that must consist of one document. YAML::Load alone ignores all text after the
// first document, and YAML::LoadAll does not terminate on a stray closing bracket.
YAML::Node ParseDocument(const std::string& text, const std::string& origin_name,
                         const std::string& what) {
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    DocumentStarts starts;
    if (!parser.HandleNextDocument(starts)) {
      throw InputError(origin_name + ": got no keys, expected " + what);
    }
    if (parser.HandleNextDocument(starts)) {
      throw InputError(Place(origin_name, starts.line()) +
                       "got a second document, expected one YAML document");
    }
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError(Place(origin_name, error.mark.line + 1) + "invalid YAML: " + error.msg);
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

bool YamlReader::IsOld(const char* key, const char* old_key) {
  if (nodes_.count(old_key) == 0) return false;
  const std::string path = Join(path_, old_key);
  if (nodes_.count(key) > 0) {
    throw FieldError(path, "got both " + Join(path_, key) + " and " + path +
                               ", its old name; expected one of them");
  }
  lines_.PutOld({path, key});
  return true;
}

const YAML::Node* YamlReader::Take(const char* key) {
  const auto found = nodes_.find(key);
  if (!used_) {
    if (found == nodes_.end()) return nullptr;
    throw FieldError(Join(path_, key), std::string("is used only if ") + condition_);
  }
  allowed_.emplace_back(key);
  return found == nodes_.end() ? nullptr : &found->second;
}

void YamlReader::Finish() const {
  for (const auto& [key, node] : nodes_) {
    if (std::find(allowed_.begin(), allowed_.end(), key) != allowed_.end()) continue;
    throw FieldError(Join(path_, Shortened(key)), "unknown key '" + Shortened(key) + "'" +
                                                      DidYouMean(key, allowed_) +
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

void YamlReader::Read(const std::string& path, const YAML::Node& node, float& value,
                      NumberOrNone domain) {
  if (!node.IsScalar()) throw Refusal(path, node, Expected(value, domain));
  if (node.Scalar() == ".nan") {
    value = std::numeric_limits<float>::quiet_NaN();
  } else if (!Parse(node.Scalar(), value)) {
    throw Refusal(path, node, Expected(value, domain));
  }
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
  throw Refusal(path, node, "one of " + List(names) + DidYouMean(text, names));
}

std::vector<std::string> ReadYaml(const std::string& text, const std::string& origin_name,
                                  const std::string& what,
                                  const std::function<void(YamlReader&)>& visit,
                                  const std::function<void()>& check) {
  CheckText(text, origin_name);
  const YAML::Node document = ParseDocument(text, origin_name, what);
  LineMap lines;
  lines.Put("", document);
  try {
    YamlReader reader(document, "", lines);
    visit(reader);
    reader.Finish();
    check();
  } catch (const FieldError& error) {
    throw InputError(Place(origin_name, lines.Find(error.path)) + error.what());
  } catch (const YAML::Exception& error) {
    throw InputError(Place(origin_name, error.mark.line + 1) + "invalid YAML: " + error.msg);
  }
  std::vector<std::string> notices;
  for (const OldName& old : lines.old_names()) {
    notices.push_back(Place(origin_name, lines.Find(old.path)) + old.path + " is now called '" +
                      old.new_key + "'; the old name still works");
  }
  return notices;
}

}  // namespace aquafarm::internal
