// SPDX-License-Identifier: BSD-3-Clause
#include "sea/nc_file.h"

#include <netcdf.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "aquafarm/base/check.h"
#include "base/files.h"
#include "base/text.h"
#include "input/file_type.h"
#include "sea/nc_classic.h"

namespace aquafarm::internal {
namespace {

// Detects the type of a file from its first 64 KiB.
DetectedFile DetectTypeOfBeginning(const std::string& path) {
  std::string text(std::size_t{64} << 10U, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return DetectFileType(text);
}

}  // namespace

NcFile::NcFile(const std::string& path) : path_(path) {
  NeedRegularFile(path);
  CheckLength();
  const int status = nc_open(path.c_str(), NC_NOWRITE, &id_);
  if (status == NC_ENOTNC) {
    const DetectedFile look = DetectTypeOfBeginning(path);
    throw InputError(path + ": got " +
                     (look.kind == FileKind::kNetcdf ? "a damaged netCDF file" : look.words) +
                     ", expected a netCDF file");
  }
  if (status != NC_NOERR) {
    throw InputError(path + ": cannot read as netCDF: " + nc_strerror(status));
  }
}

NcFile::~NcFile() { nc_close(id_); }

void NcFile::Fail(const std::string& what) const { throw InputError(path_ + ": " + what); }

void NcFile::Need(int status, const std::string& name) const {
  if (status != NC_NOERR) Fail(name + ": " + nc_strerror(status));
}

// Rejects truncated and damaged files of the classic formats. Without this check, libnetcdf 4.9.0
// reads zeros after the end of such a file, reports "invalid argument" if the file ends within its
// header, and crashes on some damaged headers. HDF5 detects truncated files itself.
void NcFile::CheckLength() const {
  std::ifstream file(path_, std::ios::binary);
  std::array<char, 4> magic{};
  file.read(magic.data(), magic.size());
  const bool kind = magic[3] == 1 || magic[3] == 2 || magic[3] == 5;
  if (!file || std::string_view(magic.data(), 3) != "CDF" || !kind) return;
  file.seekg(0);
  const std::optional<double> end = EndOfClassicValues(file);
  std::error_code error;
  const auto size = static_cast<double>(std::filesystem::file_size(path_, error));
  if (!end) Fail("got a damaged netCDF file, expected a netCDF file");
  if (error || size >= *end) return;  // libnetcdf reports all other errors
  Fail("is cut off: got " + Format(size) + " bytes, " +
       (std::isfinite(*end) ? "expected " + Format(*end) : "which end within its header"));
}

std::string NcFile::Name(int variable) const {
  std::array<char, NC_MAX_NAME + 1> name{};
  Need(nc_inq_varname(id_, variable, name.data()), "variable");
  return name.data();
}

std::string NcFile::Text(int variable, const char* key) const {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  if (nc_inq_att(id_, variable, key, &type, &length) != NC_NOERR || length > 10000) return "";
  if (type == NC_STRING && length == 1) {
    char* words = nullptr;
    Need(nc_get_att_string(id_, variable, key, &words), key);
    const std::string text = words == nullptr ? "" : words;
    nc_free_string(1, &words);
    return text;
  }
  if (type != NC_CHAR) return "";
  std::string text(length, '\0');
  Need(nc_get_att_text(id_, variable, key, text.data()), key);
  return text.substr(0, text.find('\0'));
}

std::optional<double> NcFile::Number(int variable, const char* key) const {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  if (nc_inq_att(id_, variable, key, &type, &length) != NC_NOERR) return std::nullopt;
  if (type == NC_CHAR || type == NC_STRING) {
    Fail(Name(variable) + ": " + key + ": got the text " + Quoted(Text(variable, key)) +
         ", expected a number");
  }
  if (length != 1) return std::nullopt;
  double value = 0.0;
  const int status = nc_get_att_double(id_, variable, key, &value);
  return status == NC_NOERR ? std::optional<double>(value) : std::nullopt;
}

std::optional<std::array<double, 2>> NcFile::Pair(int variable, const char* key) const {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  std::array<double, 2> values{};
  if (nc_inq_att(id_, variable, key, &type, &length) != NC_NOERR || type == NC_CHAR ||
      type == NC_STRING || length != 2 ||
      nc_get_att_double(id_, variable, key, values.data()) != NC_NOERR) {
    return std::nullopt;
  }
  return values;
}

std::optional<double> NcFile::DefaultFill(int variable) const {
  nc_type type = NC_NAT;
  Need(nc_inq_vartype(id_, variable, &type), "type");
  switch (type) {
    case NC_SHORT:
      return NC_FILL_SHORT;
    case NC_USHORT:
      return NC_FILL_USHORT;
    case NC_INT:
      return NC_FILL_INT;
    case NC_UINT:
      return NC_FILL_UINT;
    case NC_FLOAT:
    case NC_DOUBLE:
      return NC_FILL_DOUBLE;
    default:
      return std::nullopt;
  }
}

std::vector<int> NcFile::Variables() const {
  int count = 0;
  Need(nc_inq_nvars(id_, &count), "variables");
  std::vector<int> variables(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) variables[static_cast<std::size_t>(i)] = i;
  return variables;
}

}  // namespace aquafarm::internal
