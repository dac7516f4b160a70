// SPDX-License-Identifier: BSD-3-Clause
// Truncated netCDF files of the classic formats, for which libnetcdf would read zeros.
#include <gtest/gtest.h>
#include <netcdf.h>
#include <unistd.h>

#include <filesystem>

#include "aquafarm/base/check.h"
#include "aquafarm/sea/sea_field.h"
#include "write_sea.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

constexpr std::array<int, 3> kKinds{0, NC_64BIT_OFFSET, NC_64BIT_DATA};

class CutFiles : public testing::Test {
 protected:
  CutFiles()
      : path_((fs::temp_directory_path() / ("cut." + std::to_string(getpid()) + ".nc")).string()) {}
  ~CutFiles() override { fs::remove(path_); }

  /// Truncates the file to `bytes` and returns the error about its length, or "is whole".
  std::string Left(std::uintmax_t bytes) const {
    fs::resize_file(path_, bytes);
    try {
      LoadSeaField(path_, {"so", {}, 0.0}, GeoFrame({30.05, 122.05}, 1000.0), 2, 2);
    } catch (const InputError& error) {
      const std::string what = std::string(error.what()).substr(path_.size() + 2);
      if (what.substr(0, 6) == "is cut") return what;
      EXPECT_EQ(what, "so: got dimension time, expected time, depth, latitude or longitude");
    }
    return "is whole";
  }
  std::uintmax_t size() const { return fs::file_size(path_); }
  static std::string Cut(std::uintmax_t got, std::uintmax_t expected) {
    return "is cut off: got " + std::to_string(got) + " bytes, expected " +
           std::to_string(expected);
  }

  /// Writes a field "so" of shorts along time, lat and lon (2 x 2 x columns). Time is unlimited if
  /// `records`. With `with_quality`, adds a variable of bytes along time. Time has no coordinate
  /// values, so a complete file is rejected for that reason.
  void Write(int kind, std::size_t columns, bool records, bool with_quality) const {
    int file = 0;
    std::array<int, 3> dims{};
    std::array<int, 4> variables{};
    ASSERT_EQ(nc_create(path_.c_str(), NC_CLOBBER | kind, &file), NC_NOERR);
    nc_def_dim(file, "time", records ? NC_UNLIMITED : 2, &dims[0]);
    nc_def_dim(file, "lat", 2, &dims[1]);
    nc_def_dim(file, "lon", columns, &dims[2]);
    nc_def_var(file, "lat", NC_DOUBLE, 1, &dims[1], &variables[0]);
    nc_def_var(file, "lon", NC_DOUBLE, 1, &dims[2], &variables[1]);
    nc_def_var(file, "so", NC_SHORT, 3, dims.data(), &variables[2]);
    if (with_quality) nc_def_var(file, "quality", NC_BYTE, 1, dims.data(), &variables[3]);
    ASSERT_EQ(nc_enddef(file), NC_NOERR);
    const std::array<double, 3> places{30.0, 30.1, 30.2};
    const std::array<double, 3> lengths{122.0, 122.1, 122.2};
    nc_put_var_double(file, variables[0], places.data());
    nc_put_var_double(file, variables[1], lengths.data());
    const std::array<std::size_t, 3> first{};
    const std::array<std::size_t, 3> count{2, 2, columns};
    const std::array<short, 12> values{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    ASSERT_EQ(nc_put_vara_short(file, variables[2], first.data(), count.data(), values.data()),
              NC_NOERR);
    if (with_quality) {
      const std::array<signed char, 2> marks{1, 2};
      nc_put_vara_schar(file, variables[3], first.data(), count.data(), marks.data());
    }
    nc_close(file);
  }

  const std::string path_;
};

TEST_F(CutFiles, WithAHeaderLongerThanTheCutAreRefused) {
  for (const int kind : kKinds) {
    WriteSea(path_, "so", {30.0, 30.1}, {122.0, 122.1}, {1.0F, 2.0F, 3.0F, 4.0F}, kind);
    int file = 0;
    ASSERT_EQ(nc_open(path_.c_str(), NC_WRITE, &file), NC_NOERR);
    nc_redef(file);
    const std::string history(5001, 'h');
    nc_put_att_text(file, NC_GLOBAL, "history", history.size(), history.c_str());
    nc_close(file);
    const std::uintmax_t whole = size();
    ASSERT_EQ(Left(whole), "is whole") << kind;
    EXPECT_EQ(Left(whole - 1), Cut(whole - 1, whole)) << kind;
    EXPECT_EQ(Left(whole - 16), Cut(whole - 16, whole)) << "all values of the field";
    EXPECT_EQ(Left(whole - 40), Cut(whole - 40, whole)) << "within the longitudes";
    for (const std::uintmax_t left :
         {std::uintmax_t{4900}, std::uintmax_t{60}, std::uintmax_t{5}}) {
      EXPECT_EQ(Left(left),
                "is cut off: got " + std::to_string(left) + " bytes, which end within its header")
          << kind;
    }
  }
}

// The padding of a variable to four bytes contains no values.
TEST_F(CutFiles, MayLackWhatFillsUpTheLastVariable) {
  for (const int kind : kKinds) {
    Write(kind, 3, false, true);  // quality has two bytes and two bytes of padding
    const std::uintmax_t whole = size();
    EXPECT_EQ(Left(whole - 2), "is whole") << kind;
    EXPECT_EQ(Left(whole - 3), Cut(whole - 3, whole - 2)) << kind;
  }
}

TEST_F(CutFiles, OfRecordsAreRefusedWithinTheLast) {
  for (const int kind : kKinds) {
    Write(kind, 3, true, true);  // records of 12 bytes, and of 1 byte with 3 bytes of padding
    const std::uintmax_t whole = size();
    EXPECT_EQ(Left(whole - 3), "is whole") << kind;
    EXPECT_EQ(Left(whole - 4), Cut(whole - 4, whole - 3)) << kind;
    EXPECT_EQ(Left(whole - 16), Cut(whole - 16, whole - 3)) << kind;
  }
}

// The records of a single record variable are contiguous.
TEST_F(CutFiles, OfRecordsOfOneVariableAreRefusedWithinTheLast) {
  for (const int kind : kKinds) {
    Write(kind, 1, true, false);
    const std::uintmax_t whole = size();
    EXPECT_EQ(Left(whole), "is whole") << kind;
    EXPECT_EQ(Left(whole - 1), Cut(whole - 1, whole)) << kind;
  }
}

}  // namespace
}  // namespace aquafarm
