// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace aquafarm::internal {

/// An open netCDF file. Errors of the library are reported with the file and the variable.
class NcFile {
 public:
  /// @throws InputError if the path is not a regular file or not netCDF, or if the file has a
  ///         classic format and is truncated
  explicit NcFile(const std::string& path);
  ~NcFile();
  NcFile(const NcFile&) = delete;
  NcFile& operator=(const NcFile&) = delete;

  int id() const { return id_; }
  /// Always throws. @throws InputError "sea.nc: what"
  [[noreturn]] void Fail(const std::string& what) const;
  /// @throws InputError "sea.nc: name: …" if `status` is an error
  void Need(int status, const std::string& name) const;

  std::vector<int> Variables() const;
  std::string Name(int variable) const;
  /// Returns a text attribute; "" if it is absent.
  std::string Text(int variable, const char* key) const;
  /// Returns an attribute with one number; nullopt if absent. @throws InputError for text
  std::optional<double> Number(int variable, const char* key) const;
  /// Returns an attribute with two numbers; nullopt if absent.
  std::optional<std::array<double, 2>> Pair(int variable, const char* key) const;
  /// Returns netCDF's default fill value for the variable's type; nullopt if there is none (bytes).
  std::optional<double> DefaultFill(int variable) const;

 private:
  void CheckLength() const;
  std::string path_;
  int id_{};
};

}  // namespace aquafarm::internal
