// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace aquafarm::internal {

/// An open netCDF file. Error messages contain the path.
class NcFile {
 public:
  /// @throws InputError if the path is not a regular file, if the file cannot be read as netCDF, or
  ///   if it has a classic format and is truncated or damaged
  explicit NcFile(const std::string& path);
  ~NcFile();
  NcFile(const NcFile&) = delete;
  NcFile& operator=(const NcFile&) = delete;

  int id() const { return id_; }
  /// Throws InputError "sea.nc: what".
  [[noreturn]] void Fail(const std::string& what) const;
  /// Throws InputError "sea.nc: name: …" if the `status` of a netCDF call is an error.
  void Need(int status, const std::string& name) const;

  /// Returns the ids of all variables.
  std::vector<int> Variables() const;
  std::string Name(int variable) const;
  /// Returns a text attribute; "" if it is absent, not a single text, or an array (NC_CHAR) of more
  /// than 10,000 characters.
  std::string Text(int variable, const char* key) const;
  /// Returns an attribute with one number; nullopt if it is absent or has several numbers.
  /// @throws InputError if it is a text
  std::optional<double> Number(int variable, const char* key) const;
  /// Returns an attribute with two numbers; nullopt if there is no such attribute.
  std::optional<std::array<double, 2>> Pair(int variable, const char* key) const;
  /// Returns netCDF's default fill value for the variable's type; nullopt for bytes, characters,
  /// texts and 64-bit integers.
  std::optional<double> DefaultFill(int variable) const;

 private:
  void CheckLength() const;
  std::string path_;
  int id_{};
};

}  // namespace aquafarm::internal
