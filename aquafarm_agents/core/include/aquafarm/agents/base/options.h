// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Parser of learner options, for example "gamma=0.97 learning_rate=linear:0.2:0.05:1".

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/agents/base/schedule.h"
#include "aquafarm/agents/base/text.h"

namespace aquafarm::agents {

/// Reads options by key, with defaults. Finish() rejects options that were never read.
class OptionReader {
 public:
  /// @param text key=value pairs, separated by blanks or commas; an old name of an option counts as
  ///   its new name
  /// @throws InputError on any other syntax and on duplicate keys
  explicit OptionReader(const std::string& text);

  /// Value of `key` in [min, max]; `fallback` is the default.
  double Number(const std::string& key, double fallback, double min, double max);
  /// Value of `key`, true or false; `fallback` is the default.
  bool Flag(const std::string& key, bool fallback);
  Schedule GetSchedule(const std::string& key, const Schedule& fallback, double min, double max);
  std::string Text(const std::string& key, const std::string& fallback);

  /// @throws InputError naming the first key that was never read, and all valid keys
  void Finish() const;

  /// Every option that was read, with its effective value, sorted by key. Checkpoints and run.json
  /// contain this text.
  std::string Resolved() const;
  /// Replaces the resolved text of `key` by its canonical form.
  void Resolve(const std::string& key, const std::string& value) { resolved_[key] = value; }

 private:
  const std::string* Find(const std::string& key);

  std::map<std::string, std::string> given_;
  std::map<std::string, std::string> resolved_;
};

/// Returns options with the current names instead of old ones, sorted by key. For the options that
/// checkpoints of earlier versions recorded.
/// @param text as written by OptionReader::Resolved
std::string CanonicalOptions(const std::string& text);

/// Returns one line for each old name in `text`, for example "option batch is now called
/// batch_size". @throws InputError as OptionReader
std::vector<std::string> RenamedOptions(const std::string& text);

}  // namespace aquafarm::agents
