// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A learner's options as people write them: "discount=0.97 learning_rate=linear:0.2:0.05:1".

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/agents/base/schedule.h"
#include "aquafarm/agents/base/text.h"

namespace aquafarm::agents {

/// Hands out options by key with defaults; what nobody asked for is refused by Finish().
class OptionReader {
 public:
  /// @param text key=value, separated by blanks or commas
  /// @throws InputError on anything else and on a key given twice
  explicit OptionReader(const std::string& text);

  /// Value of `key` in [min, max].
  double Number(const std::string& key, double otherwise, double min, double max);
  /// true or false.
  bool Flag(const std::string& key, bool otherwise);
  Schedule GetSchedule(const std::string& key, const Schedule& otherwise, double min, double max);
  std::string Text(const std::string& key, const std::string& otherwise);

  /// @throws InputError naming the first key that was not asked for, and all that were
  void Finish() const;

  /// Every option asked for with its value in force, sorted: what checkpoints and run.json keep.
  std::string Resolved() const;
  /// Replaces the resolved text of `key` by its canonical form.
  void Resolve(const std::string& key, const std::string& value) { resolved_[key] = value; }

 private:
  const std::string* Find(const std::string& key);

  std::map<std::string, std::string> given_;
  std::map<std::string, std::string> resolved_;
};

}  // namespace aquafarm::agents
