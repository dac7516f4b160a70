// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <cstdint>
#include <string>
#include <vector>

namespace aquafarm_agents {

/// Reads a node's private parameters; each is used or refused.
class Params {
 public:
  explicit Params(const ros::NodeHandle& private_node) : node_(private_node) {}

  // Each leaves `value` as it is when the parameter is absent.
  // @throws InputError "~episodes: got -1, expected [0, 2147483647]"

  void Text(const std::string& name, std::string& value);
  void Flag(const std::string& name, bool& value);
  void Int(const std::string& name, int min, int max, int& value);
  void Number(const std::string& name, double min, double max, double& value);

  /// @throws InputError naming an unknown parameter, and those there are
  void RefuseOthers() const;

  /// "name:=value" of what was given; for records.
  const std::vector<std::string>& given() const { return given_; }

 private:
  template <typename T>
  bool Read(const std::string& name, const char* type, T& value);

  ros::NodeHandle node_;
  std::vector<std::string> known_;
  std::vector<std::string> given_;
};

}  // namespace aquafarm_agents
