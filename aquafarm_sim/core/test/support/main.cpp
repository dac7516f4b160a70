// SPDX-License-Identifier: BSD-3-Clause
// main() of the tests of a folder. With --file=NAME it runs only the tests of NAME.cpp.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <string>

namespace {

// Returns a filter of googletest for the tests of a source; empty if there are none.
std::string FilterOfFile(const std::string& name) {
  std::string filter;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    for (int k = 0; k < suite.total_test_count(); ++k) {
      const testing::TestInfo& test = *suite.GetTestInfo(k);
      if (std::filesystem::path(test.file()).stem() == name)
        filter += std::string(suite.name()) + "." + test.name() + ":";
    }
  }
  return filter;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const std::string option = "--file=";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const std::string name =
        word.substr(0, option.size()) == option ? word.substr(option.size()) : "";
    const std::string filter = name.empty() ? "" : FilterOfFile(name);
    if (filter.empty()) {
      std::fprintf(stderr, "%s: got '%s', expected --file=NAME of a source with tests\n", argv[0],
                   argv[i]);
      return 2;
    }
    testing::GTEST_FLAG(filter) = filter;
  }
  return RUN_ALL_TESTS();
}
