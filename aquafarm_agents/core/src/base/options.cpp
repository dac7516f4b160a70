// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/base/options.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "aquafarm/base/check.h"

namespace aquafarm::agents {

namespace {

// Old names and their replacements, which are the usual names of reinforcement-learning libraries.
constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kRenamed{
    {{"average_rate", "ema_rate"},
     {"batch", "batch_size"},
     {"discount", "gamma"},
     {"double_q", "double_dqn"},
     {"gradient_limit", "max_grad_norm"},
     {"hidden", "hidden_size"},
     {"importance", "importance_exponent"},
     {"priority", "priority_exponent"},
     {"replay", "buffer_size"},
     {"sequence", "sequence_length"},
     {"start", "learning_starts"},
     {"steps_per_update", "train_interval"},
     {"target_period", "target_update_interval"},
     {"target_rate", "tau"}}};

std::string_view CurrentName(std::string_view key) {
  const auto* const found = std::find_if(kRenamed.begin(), kRenamed.end(),
                                         [&](const auto& names) { return names.first == key; });
  return found == kRenamed.end() ? key : found->second;
}

// Splits "key=value …" into pairs. @throws InputError on any other syntax
std::vector<std::pair<std::string, std::string>> SplitOptions(const std::string& text) {
  const char* const kBlanks = " ,\t\n";
  std::vector<std::pair<std::string, std::string>> pairs;
  std::size_t begin = text.find_first_not_of(kBlanks);
  while (begin != std::string::npos) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == word.size()) {
      throw InputError("options: got '" + word + "', expected key=value, such as gamma=0.99");
    }
    pairs.emplace_back(word.substr(0, equals), word.substr(equals + 1));
    begin = text.find_first_not_of(kBlanks, end);
  }
  return pairs;
}

std::string JoinOptions(const std::map<std::string, std::string>& options) {
  std::string text;
  for (const auto& [key, value] : options) text += (text.empty() ? "" : " ") + key + "=" + value;
  return text;
}

}  // namespace

OptionReader::OptionReader(const std::string& text) {
  std::map<std::string, std::string> names;  // name in `text` by current name
  for (auto& [key, value] : SplitOptions(text)) {
    const std::string current(CurrentName(key));
    given_.emplace(current, std::move(value));
    const auto [first, is_new] = names.emplace(current, key);
    if (is_new) continue;
    throw InputError("options: got " +
                     (first->second == key ? key + " twice"
                                           : first->second + " and " + key +
                                                 ", the old and the new name of one option") +
                     ", expected it once; remove one of them");
  }
}

const std::string* OptionReader::Find(const std::string& key) {
  const auto found = given_.find(key);
  return found == given_.end() ? nullptr : &found->second;
}

double OptionReader::Number(const std::string& key, double fallback, double min, double max) {
  const std::string* text = Find(key);
  const double value = text == nullptr ? fallback : ParseNumber(*text, key);
  if (value < min || value > max) {
    throw InputError(key + ": got " + FormatNumber(value) + ", expected [" + FormatNumber(min) +
                     ", " + FormatNumber(max) + "]");
  }
  resolved_[key] = FormatNumber(value);
  return value;
}

bool OptionReader::Flag(const std::string& key, bool fallback) {
  const std::string* text = Find(key);
  if (text != nullptr && *text != "true" && *text != "false") {
    throw InputError(key + ": got '" + *text + "', expected true or false");
  }
  const bool value = text == nullptr ? fallback : *text == "true";
  resolved_[key] = value ? "true" : "false";
  return value;
}

Schedule OptionReader::GetSchedule(const std::string& key, const Schedule& fallback, double min,
                                   double max) {
  const std::string* text = Find(key);
  const Schedule value = text == nullptr ? fallback : ParseSchedule(*text, key, min, max);
  resolved_[key] = ToString(value);
  return value;
}

std::string OptionReader::Text(const std::string& key, const std::string& fallback) {
  const std::string* text = Find(key);
  resolved_[key] = text == nullptr ? fallback : *text;
  return resolved_[key];
}

void OptionReader::Finish() const {
  for (const auto& [key, value] : given_) {
    if (resolved_.count(key) != 0) continue;
    std::vector<std::string> keys;
    for (const auto& entry : resolved_) keys.push_back(entry.first);
    throw InputError("options: got '" + key + "', expected " +
                     (keys.empty() ? "no option, because this algorithm has none; remove it"
                                   : "one of: " + Join(keys)));
  }
}

std::string OptionReader::Resolved() const { return JoinOptions(resolved_); }

std::string CanonicalOptions(const std::string& text) {
  std::map<std::string, std::string> options;
  for (auto& [key, value] : SplitOptions(text)) options[std::string(CurrentName(key))] = value;
  return JoinOptions(options);
}

std::vector<std::string> RenamedOptions(const std::string& text) {
  std::vector<std::string> lines;
  for (const auto& [key, value] : SplitOptions(text)) {
    const std::string_view name = CurrentName(key);
    if (name == key) continue;
    lines.push_back("option " + key + " is now called " + std::string(name));
  }
  return lines;
}

}  // namespace aquafarm::agents
