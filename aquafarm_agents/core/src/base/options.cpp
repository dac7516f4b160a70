// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/base/options.h"

#include <algorithm>

#include "aquafarm/base/check.h"

namespace aquafarm::agents {

OptionReader::OptionReader(const std::string& text) {
  const char* const kBlanks = " ,\t\n";
  std::size_t begin = text.find_first_not_of(kBlanks);
  while (begin != std::string::npos) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == word.size()) {
      throw InputError("options: got '" + word + "', expected key=value");
    }
    const std::string key = word.substr(0, equals);
    if (!given_.emplace(key, word.substr(equals + 1)).second) {
      throw InputError("options: " + key + " is given twice");
    }
    begin = text.find_first_not_of(kBlanks, end);
  }
}

const std::string* OptionReader::Find(const std::string& key) {
  const auto found = given_.find(key);
  return found == given_.end() ? nullptr : &found->second;
}

double OptionReader::Number(const std::string& key, double otherwise, double min, double max) {
  const std::string* text = Find(key);
  const double value = text == nullptr ? otherwise : ParseNumber(*text, key);
  if (value < min || value > max) {
    throw InputError(key + ": got " + FormatNumber(value) + ", expected [" + FormatNumber(min) +
                     ", " + FormatNumber(max) + "]");
  }
  resolved_[key] = FormatNumber(value);
  return value;
}

bool OptionReader::Flag(const std::string& key, bool otherwise) {
  const std::string* text = Find(key);
  if (text != nullptr && *text != "true" && *text != "false") {
    throw InputError(key + ": got '" + *text + "', expected true or false");
  }
  const bool value = text == nullptr ? otherwise : *text == "true";
  resolved_[key] = value ? "true" : "false";
  return value;
}

Schedule OptionReader::GetSchedule(const std::string& key, const Schedule& otherwise, double min,
                                   double max) {
  const std::string* text = Find(key);
  const Schedule value = text == nullptr ? otherwise : ParseSchedule(*text, key, min, max);
  resolved_[key] = ToString(value);
  return value;
}

std::string OptionReader::Text(const std::string& key, const std::string& otherwise) {
  const std::string* text = Find(key);
  resolved_[key] = text == nullptr ? otherwise : *text;
  return resolved_[key];
}

void OptionReader::Finish() const {
  for (const auto& [key, value] : given_) {
    if (resolved_.count(key) != 0) continue;
    std::vector<std::string> keys;
    for (const auto& entry : resolved_) keys.push_back(entry.first);
    throw InputError(
        "options: got '" + key + "', expected " +
        (keys.empty() ? "none: this algorithm has no options" : "one of: " + Join(keys)));
  }
}

std::string OptionReader::Resolved() const {
  std::string text;
  for (const auto& [key, value] : resolved_) {
    text += (text.empty() ? "" : " ") + key + "=" + value;
  }
  return text;
}

}  // namespace aquafarm::agents
