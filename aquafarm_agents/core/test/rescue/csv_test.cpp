// SPDX-License-Identifier: BSD-3-Clause
#include "rescue/csv.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

class CsvTables : public ::testing::Test {
 protected:
  ~CsvTables() override { std::filesystem::remove(path_); }

  /// Reads a text as a table of the columns a and b; returns its rows, or the words of the refusal.
  std::string Read(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    try {
      const CsvTable table(path_, {"a"}, {"b"}, 3);
      std::string rows;
      for (const CsvRow& row : table.rows()) rows += row.Text("a") + "|" + row.Text("b") + ";";
      return rows;
    } catch (const InputError& error) {
      const std::string words = error.what();
      return words.substr(words.find(path_) + path_.size());
    }
  }

  const std::string path_ = ::testing::TempDir() + "csv_test.csv";
};

TEST_F(CsvTables, HaveQuotedFieldsCommentsAndMissingFields) {
  EXPECT_EQ(Read("\xEF\xBB\xBF"
                 "a,b\r\n# none\r\n\"x, \"\"y\"\"\",2\r\nz\r\n"),
            "x, \"y\"|2;z|;");
}

TEST_F(CsvTables, WithTooMuchAreRefused) {
  EXPECT_EQ(Read("a,b\n1\n2\n3\n"), "1|;2|;3|;");
  EXPECT_EQ(Read("a,b\n1\n2\n3\n4\n"), ":5: got row 4, expected at most 3; shorten the file");
  EXPECT_EQ(Read("a,b\n1,2,3\n"),
            ":2: got 3 fields, expected at most 2; put texts with commas in quotes");
  EXPECT_EQ(Read(std::string((1 << 20) + 1, 'a')),
            ": got 1048577 bytes, expected at most 1048576; shorten the file");
}

TEST_F(CsvTables, WithoutRowsOrWithOtherColumnsAreRefused) {
  EXPECT_EQ(Read("a,b\n"), ": got no rows, expected a header and at least one row");
  EXPECT_EQ(Read("a,c\n1,2\n"),
            ":1: got a column 'c', expected: a; optional: b; rename or remove this column");
  EXPECT_EQ(Read("b\n1\n"), ":1: got no column 'a', expected: a; add it to the header");
}

}  // namespace
}  // namespace aquafarm::agents
