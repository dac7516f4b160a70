// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Small tables as text: a header, then one line per row, fields separated by commas. A field may
/// be quoted; empty lines and lines that begin with # are skipped.

#include <cstddef>
#include <string>
#include <vector>

namespace aquafarm::agents {

class CsvRow {
 public:
  CsvRow(const std::vector<std::string>& header, std::vector<std::string> fields, std::string where)
      : header_(header), fields_(std::move(fields)), where_(std::move(where)) {}
  /// Returns "devices.csv:3".
  const std::string& where() const { return where_; }
  /// Returns a field; empty if the column or the field is absent.
  std::string Text(const std::string& column) const;
  /// @throws InputError if the field is empty, no number, or out of range
  double Number(const std::string& column, double low, double high) const;

 private:
  const std::vector<std::string>& header_;
  std::vector<std::string> fields_;
  std::string where_;
};

/// A table read from a file.
class CsvTable {
 public:
  /// @param needed columns that must be there @param known further columns that may be there
  /// @throws InputError with file, line, and the valid columns or the max number of rows
  CsvTable(const std::string& path, const std::vector<std::string>& needed,
           const std::vector<std::string>& known, std::size_t max_rows);
  const std::vector<CsvRow>& rows() const { return rows_; }

 private:
  std::vector<std::string> header_;
  std::vector<CsvRow> rows_;
};

}  // namespace aquafarm::agents
