// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/params.h"

#include <algorithm>

#include "aquafarm/agents/options.h"
#include "aquafarm/check.h"

namespace aquafarm_agents {

using aquafarm::InputError;
using aquafarm::agents::FormatNumber;

template <typename T>
bool Params::Read(const std::string& name, const char* type, T& value) {
  known_.push_back(name);
  if (!node_.hasParam(name)) return false;
  if (!node_.getParam(name, value)) {
    throw InputError("~" + name + ": got another type, expected " + type);
  }
  return true;
}

void Params::Text(const std::string& name, std::string& value) {
  if (Read(name, "a text", value)) given_.push_back(name + ":=" + value);
}

void Params::Flag(const std::string& name, bool& value) {
  if (Read(name, "true or false", value)) given_.push_back(name + (value ? ":=true" : ":=false"));
}

void Params::Int(const std::string& name, int min, int max, int& value) {
  if (!Read(name, "a whole number", value)) return;
  if (value < min || value > max) {
    throw InputError("~" + name + ": got " + std::to_string(value) + ", expected [" +
                     std::to_string(min) + ", " + std::to_string(max) + "]");
  }
  given_.push_back(name + ":=" + std::to_string(value));
}

void Params::Number(const std::string& name, double min, double max, double& value) {
  if (!Read(name, "a number", value)) return;
  if (!(value >= min && value <= max)) {
    throw InputError("~" + name + ": got " + FormatNumber(value) + ", expected [" +
                     FormatNumber(min) + ", " + FormatNumber(max) + "]");
  }
  given_.push_back(name + ":=" + FormatNumber(value));
}

void Params::RefuseOthers() const {
  std::vector<std::string> there;
  node_.getParamNames(there);
  const std::string space = node_.getNamespace() + "/";
  for (const std::string& path : there) {
    if (path.compare(0, space.size(), space) != 0) continue;
    const std::string name = path.substr(space.size());
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    throw InputError("~" + name +
                     ": unknown parameter, expected one of: " + aquafarm::agents::Join(known_));
  }
}

}  // namespace aquafarm_agents
