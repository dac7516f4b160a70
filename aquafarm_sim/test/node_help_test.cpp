// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/node_help.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace aquafarm_sim {
namespace {

constexpr NodeHelp kHelp{"aquafarm_sim", "sim_node", "Simulates.", "sim.launch"};

// Returns what is printed for some arguments; empty if the node would start.
std::string Printed(std::vector<std::string> words, const NodeHelp& help = kHelp) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  testing::internal::CaptureStdout();
  const bool is_printed = PrintHelpIfRequested(static_cast<int>(words.size()), argv.data(), help);
  const std::string text = testing::internal::GetCapturedStdout();
  EXPECT_EQ(is_printed, !text.empty());
  return text;
}

TEST(NodeHelp, IsPrintedOnlyIfRequested) {
  EXPECT_EQ(Printed({}), "");
  EXPECT_EQ(Printed({"sim_node"}), "");
  EXPECT_EQ(Printed({"sim_node", "_x:=-h", "__name:=sim"}), "");
  EXPECT_EQ(Printed({"--help"}), "") << "the name of the program";
  EXPECT_NE(Printed({"sim_node", "-h"}), "");
  EXPECT_NE(Printed({"sim_node", "_x:=1", "--help"}), "");
}

TEST(NodeHelp, NamesTheLaunchFileIfThereIsOne) {
  const std::string text = Printed({"sim_node", "-h"});
  EXPECT_EQ(text.rfind("usage: rosrun aquafarm_sim sim_node ", 0), 0U);
  EXPECT_NE(text.find("Simulates."), std::string::npos);
  EXPECT_NE(text.find("sim.launch"), std::string::npos);
  EXPECT_EQ(Printed({"x", "-h"}, {"p", "x", "Does.", nullptr}).find("launch"), std::string::npos);
}

}  // namespace
}  // namespace aquafarm_sim
