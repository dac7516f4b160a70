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
  /// @param text key=value pairs, separated by blanks or commas; old names of options are replaced
  ///   by the new ones
  /// @throws InputError if `text` has another syntax or contains a key twice
  explicit OptionReader(const std::string& text);

  /// Returns the value of `key`, or `fallback` if the text does not contain the key.
  /// @throws InputError if the value is not a finite number in [min, max]
  double Number(const std::string& key, double fallback, double min, double max);
  /// Returns the value of `key`, or `fallback` if the text does not contain the key.
  /// @throws InputError if the value is neither "true" nor "false"
  bool Flag(const std::string& key, bool fallback);
  /// Returns the schedule of `key`, or `fallback` if the text does not contain the key.
  /// @throws InputError in the same cases as ParseSchedule
  Schedule GetSchedule(const std::string& key, const Schedule& fallback, double min, double max);
  /// Returns the value of `key` as text, or `fallback` if the text does not contain the key.
  std::string Text(const std::string& key, const std::string& fallback);

  /// @throws InputError if a given key was never read; the message lists the keys that were read
  void Finish() const;

  /// Returns every option that was read, with its effective value, as key=value pairs sorted by
  /// key. Checkpoints and run.json contain this text.
  std::string Resolved() const;
  /// Sets the value of `key` in Resolved(), for example to a canonical form.
  void Resolve(const std::string& key, const std::string& value) { resolved_[key] = value; }

 private:
  const std::string* Find(const std::string& key);

  std::map<std::string, std::string> given_;
  std::map<std::string, std::string> resolved_;
};

/// Returns the options in `text` sorted by key, with old names replaced by the current ones.
/// Checkpoints of earlier versions may contain old names. If a key is given twice, the later value
/// is kept.
/// @throws InputError if `text` does not consist of key=value pairs
std::string CanonicalOptions(const std::string& text);

/// Returns one line for each old name in `text`, for example "option batch is now called
/// batch_size".
/// @throws InputError if `text` does not consist of key=value pairs
std::vector<std::string> RenamedOptions(const std::string& text);

}  // namespace aquafarm::agents
