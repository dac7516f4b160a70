// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm/base/suggest.h"

namespace aquafarm_sim {

/// Reads a node's private parameters. The node must call RefuseOthers last. RefuseOthers refuses
/// all parameters that were neither read nor allowed, so that a misspelled name is an error.
class Params {
 public:
  explicit Params(const ros::NodeHandle& private_node) : node_(private_node) {}

  // Text, Flag, Int and Number read a parameter. `value` is unchanged if the parameter is not set.
  // @throws InputError for another type, or for a number that is not in [min, max]: "~episodes: got
  //         -1, expected [0, 2147483647]"

  void Text(const std::string& name, std::string& value) { Read(name, "a text", value); }
  void Flag(const std::string& name, bool& value) { Read(name, "true or false", value); }
  /// Also throws InputError for a number with a fraction. NodeHandle::getParam would round it.
  void Int(const std::string& name, int min, int max, int& value) {
    double number = value;
    if (node_.getParam(name, number) && !(number == std::trunc(number))) {
      throw aquafarm::InputError("~" + name + ": got " + ToText(number) +
                                 ", expected a whole number");
    }
    if (Read(name, "a whole number", value)) CheckRange(name, value, min, max);
  }
  void Number(const std::string& name, double min, double max, double& value) {
    if (Read(name, "a number", value)) CheckRange(name, value, min, max);
  }

  /// Allows a parameter that other code reads, for example a library.
  void Allow(const std::string& name) { known_.push_back(name); }

  /// @throws InputError that contains the name of an unknown parameter and the known names
  void RefuseOthers() const {
    std::vector<std::string> there;
    node_.getParamNames(there);
    const std::string space = node_.getNamespace() + "/";
    for (const std::string& path : there) {
      if (path.compare(0, space.size(), space) != 0) continue;
      const std::string name = path.substr(space.size());
      if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
      std::string names;
      for (const std::string& one : known_) names += (names.empty() ? "" : ", ") + one;
      throw aquafarm::InputError("~" + name + ": unknown parameter" +
                                 aquafarm::DidYouMean(name, known_) +
                                 ", expected one of: " + names);
    }
  }

  /// Returns the parameters that were read and are set, as "name:=value".
  const std::vector<std::string>& given() const { return given_; }

 private:
  template <typename T>
  static std::string ToText(const T& value) {
    std::ostringstream text;
    text.precision(12);
    text << std::boolalpha << value;
    return text.str();
  }

  template <typename T>
  bool Read(const std::string& name, const char* type, T& value) {
    known_.push_back(name);
    if (!node_.hasParam(name)) return false;
    if (!node_.getParam(name, value)) {
      throw aquafarm::InputError("~" + name + ": got another type, expected " + type);
    }
    given_.push_back(name + ":=" + ToText(value));
    return true;
  }

  template <typename T>
  static void CheckRange(const std::string& name, T value, T min, T max) {
    if (value >= min && value <= max) return;  // the condition is false for NaN
    throw aquafarm::InputError("~" + name + ": got " + ToText(value) + ", expected [" +
                               ToText(min) + ", " + ToText(max) + "]");
  }

  ros::NodeHandle node_;
  std::vector<std::string> known_;
  std::vector<std::string> given_;
};

}  // namespace aquafarm_sim
