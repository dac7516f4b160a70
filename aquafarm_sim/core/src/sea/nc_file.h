// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace aquafarm::internal {

/// An open netCDF file; what the library says of an error goes behind the file and the variable.
class NcFile {
 public:
  /// @throws InputError for what is no regular file, no netCDF, or of a classic kind and cut short
  explicit NcFile(const std::string& path);
  ~NcFile();
  NcFile(const NcFile&) = delete;
  NcFile& operator=(const NcFile&) = delete;

  int id() const { return id_; }
  /// @throws InputError "sea.nc: what"
  [[noreturn]] void Refuse(const std::string& what) const;
  /// @throws InputError "sea.nc: name: …" for a status that is an error
  void Need(int status, const std::string& name) const;

  std::vector<int> Variables() const;
  std::string Name(int variable) const;
  /// An attribute of text, or "".
  std::string Text(int variable, const char* key) const;
  /// An attribute of one number. @throws InputError for text
  std::optional<double> Number(int variable, const char* key) const;
  /// An attribute of two numbers.
  std::optional<std::array<double, 2>> Pair(int variable, const char* key) const;
  /// What netCDF itself writes where nothing was put; bytes have no such value.
  std::optional<double> DefaultFill(int variable) const;

 private:
  void CheckLength() const;
  std::string path_;
  int id_{};
};

}  // namespace aquafarm::internal
