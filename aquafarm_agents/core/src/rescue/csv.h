// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Small tables in CSV files of up to 1 MiB: a header, then one line per row, with commas between
/// the fields. A field may be quoted. Empty lines and lines that start with # are skipped.

#include <cstddef>
#include <string>
#include <vector>

namespace aquafarm::agents {

class CsvRow {
 public:
  CsvRow(const std::vector<std::string>& header, std::vector<std::string> fields, std::string where)
      : header_(header), fields_(std::move(fields)), where_(std::move(where)) {}
  /// Returns file and line, such as "devices.csv:3".
  const std::string& where() const { return where_; }
  /// Returns a field; empty if the table lacks the column or the row lacks the field.
  std::string Text(const std::string& column) const;
  /// Returns a number. @throws InputError if the field is not a number in [low, high]
  double Number(const std::string& column, double low, double high) const;

 private:
  const std::vector<std::string>& header_;
  std::vector<std::string> fields_;
  std::string where_;
};

/// A table read from a file.
class CsvTable {
 public:
  /// @param needed required columns
  /// @param known optional columns
  /// @throws InputError if the file cannot be read or is too large, if a column is missing or
  ///   unknown, if a row has too many fields, or if the number of rows is not in [1, max_rows]
  CsvTable(const std::string& path, const std::vector<std::string>& needed,
           const std::vector<std::string>& known, std::size_t max_rows);
  const std::vector<CsvRow>& rows() const { return rows_; }

 private:
  std::vector<std::string> header_;
  std::vector<CsvRow> rows_;
};

}  // namespace aquafarm::agents
