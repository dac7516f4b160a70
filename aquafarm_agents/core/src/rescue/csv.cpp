// SPDX-License-Identifier: BSD-3-Clause
#include "rescue/csv.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <sstream>
#include <system_error>

#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/base/text.h"
#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

constexpr std::uintmax_t kMaxBytes = std::uintmax_t{1} << 20U;

std::string Trimmed(const std::string& text) {
  constexpr const char* kSpace = " \t\r";
  const std::size_t from = text.find_first_not_of(kSpace);
  if (from == std::string::npos) return "";
  return text.substr(from, text.find_last_not_of(kSpace) - from + 1);
}

// Splits a line into fields. Within quotes, a doubled quote stands for one quote.
std::vector<std::string> Split(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      const bool is_doubled = quoted && i + 1 < line.size() && line[i + 1] == '"';
      if (is_doubled) fields.back() += line[++i];
      if (!is_doubled) quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  for (std::string& field : fields) field = Trimmed(field);
  return fields;
}

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string CsvRow::Text(const std::string& column) const {
  const auto at = std::find(header_.begin(), header_.end(), column);
  const auto index = static_cast<std::size_t>(at - header_.begin());
  return index < fields_.size() ? fields_[index] : "";
}

double CsvRow::Number(const std::string& column, double low, double high) const {
  const double value = ParseNumber(Text(column), where_ + ": " + column);
  if (value >= low && value <= high) return value;
  throw InputError(where_ + ": " + column + ": got " + Text(column) + ", expected [" +
                   FormatNumber(low) + ", " + FormatNumber(high) + "]");
}

CsvTable::CsvTable(const std::string& path, const std::vector<std::string>& needed,
                   const std::vector<std::string>& known, std::size_t max_rows) {
  std::error_code unknown;  // ignored: ReadFile throws if the file cannot be read
  const auto bytes = std::filesystem::file_size(path, unknown);
  if (!unknown && bytes > kMaxBytes) {
    throw InputError(path + ": got " + std::to_string(bytes) + " bytes, expected at most " +
                     std::to_string(kMaxBytes) + "; shorten the file");
  }
  std::string text = ReadFile(path);
  if (text.compare(0, 3, "\xEF\xBB\xBF") == 0) text.erase(0, 3);  // byte order mark
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (Trimmed(line).empty() || Trimmed(line)[0] == '#') continue;
    const std::string where = path + ":" + std::to_string(number);
    std::vector<std::string> fields = Split(line);
    if (header_.empty()) {
      header_ = fields;
      for (const std::string& name : header_) {
        if (Contains(needed, name) || Contains(known, name)) continue;
        throw InputError(where + ": got a column '" + name + "', expected: " + Join(needed) +
                         "; optional: " + Join(known) + "; rename or remove this column");
      }
      for (const std::string& name : needed) {
        if (Contains(header_, name)) continue;
        throw InputError(where + ": got no column '" + name + "', expected: " + Join(needed) +
                         "; add it to the header");
      }
      continue;
    }
    if (fields.size() > header_.size()) {
      throw InputError(where + ": got " + std::to_string(fields.size()) +
                       " fields, expected at most " + std::to_string(header_.size()) +
                       "; put texts with commas in quotes");
    }
    if (rows_.size() == max_rows) {
      throw InputError(where + ": got row " + std::to_string(max_rows + 1) + ", expected at most " +
                       std::to_string(max_rows) + "; shorten the file");
    }
    rows_.emplace_back(header_, std::move(fields), where);
  }
  if (rows_.empty())
    throw InputError(path + ": got no rows, expected a header and at least one row");
}

}  // namespace aquafarm::agents
