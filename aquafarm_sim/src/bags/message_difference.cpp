// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/bags/message_difference.h"

#include <algorithm>
#include <utility>

namespace aquafarm_sim {
namespace {

struct Line {
  std::size_t indent{};
  std::string name;
  std::string value;
};

// Parses the next line of a printed message. roscpp prints "name: value", indented by two spaces
// per level; the line of an array entry is "name[index]: value".
Line ReadLine(std::istringstream& text) {
  std::string line;
  std::getline(text, line);
  const std::size_t start = std::min(line.find_first_not_of(' '), line.size());
  const std::size_t colon = std::min(line.find(':', start), line.size());
  std::string value = colon < line.size() ? line.substr(colon + 1) : "";
  value.erase(0, value.find_first_not_of(' '));
  return {start, line.substr(start, colon - start), value};
}

std::string PathOf(const std::vector<Line>& parents, const Line& line) {
  std::string path;
  for (const Line& parent : parents) {
    if (parent.name.size() > 2 && parent.name.substr(parent.name.size() - 2) == "[]") continue;
    path += parent.name + ".";
  }
  return path + line.name;
}

}  // namespace

std::string FirstDifferentLine(const std::string& got, const std::string& simulated) {
  std::istringstream got_text(got);
  std::istringstream simulated_text(simulated);
  std::vector<Line> parents;
  while (got_text && simulated_text) {
    const Line one = ReadLine(got_text);
    const Line other = ReadLine(simulated_text);
    while (!parents.empty() && parents.back().indent >= one.indent) parents.pop_back();
    if (one.name != other.name || one.indent != other.indent) {
      return PathOf(parents, one) + ": got another number of entries than simulated";
    }
    if (one.value != other.value) {
      return PathOf(parents, one) + ": got " + one.value + ", simulated " + other.value;
    }
    parents.push_back(one);
  }
  return "got bits that differ from those simulated";
}

}  // namespace aquafarm_sim
