// SPDX-License-Identifier: BSD-3-Clause
#include "sea/nc_classic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace aquafarm::internal {
namespace {

// Size of a value by type, from NC_BYTE = 1 to NC_UINT64 = 11 [bytes].
constexpr std::array<std::uint64_t, 12> kBytesOfType{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};

constexpr std::uint64_t kLastOldType = 6;  // NC_DOUBLE; versions 1 and 2 have no later type

// Tags of the lists in a header.
constexpr std::uint64_t kDimensions = 10;
constexpr std::uint64_t kVariables = 11;
constexpr std::uint64_t kAttributes = 12;

// Reads the big-endian words of a header. After the end of the file or an invalid word, all words
// are 0.
class HeaderReader {
 public:
  explicit HeaderReader(std::istream& file) : file_(file) {
    file.ignore(3);  // "CDF"
    version_ = file.get();
  }
  bool good() const { return file_.good(); }
  bool ended() const { return ended_; }
  /// Marks the header as damaged unless `valid`.
  void Need(bool valid) {
    if (!valid) file_.setstate(std::ios::failbit);
  }
  std::uint64_t Tag() { return Word(4); }
  std::uint64_t Count() { return Word(version_ == 5 ? 8 : 4); }
  std::uint64_t Offset() { return Word(version_ == 1 ? 4 : 8); }
  /// Reads a count. A count above 65,536 marks the header as damaged.
  std::uint64_t FewCount() { return AtMost(Count(), std::uint64_t{1} << 16U); }
  /// Reads the head of a list and returns its length. The head of an absent list consists of zeros.
  std::uint64_t ListCount(std::uint64_t tag) {
    const std::uint64_t got = Tag();
    const std::uint64_t count = FewCount();
    Need(got == tag || (got == 0 && count == 0));
    return good() ? count : 0;
  }
  std::uint64_t BytesOfType() {
    const std::uint64_t type =
        AtMost(Tag(), version_ == 5 ? kBytesOfType.size() - 1 : kLastOldType);
    Need(type > 0);
    return kBytesOfType[type];
  }
  void SkipName() {
    const std::uint64_t bytes = AtMost(Count(), kMaxNameBytes);
    Need(bytes > 0);
    Skip(bytes);
  }
  void SkipAttributes() {
    for (std::uint64_t left = ListCount(kAttributes); left > 0 && good(); --left) {
      SkipName();
      const std::uint64_t bytes = BytesOfType();
      Skip(AtMost(Count(), kMaxBytes) * bytes);
    }
  }

 private:
  static constexpr std::uint64_t kMaxNameBytes = 1024;  // four times libnetcdf's limit
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 40U;

  std::uint64_t AtMost(std::uint64_t value, std::uint64_t max) {
    if (value <= max) return value;
    file_.setstate(std::ios::failbit);
    return 0;
  }
  std::uint64_t Word(int bytes) {
    std::uint64_t word = 0;
    for (int i = 0; i < bytes; ++i) {
      word = word << 8U | static_cast<unsigned char>(file_.get());
    }
    ended_ = ended_ || file_.eof();
    return good() ? word : 0;
  }
  // Skips a name or values, which are padded to a multiple of four bytes.
  void Skip(std::uint64_t bytes) {
    const std::uint64_t filled = (AtMost(bytes, kMaxBytes * 8) + 3) / 4 * 4;
    if (good()) file_.seekg(static_cast<std::streamoff>(filled), std::ios::cur);
  }
  std::istream& file_;
  int version_{};
  bool ended_{};
};

struct Variable {
  double begin{};
  double bytes{1.0};  // size of all values, or of one record if it has records
  bool has_records{};
};

Variable ReadVariable(HeaderReader& header, const std::vector<double>& dimensions) {
  Variable variable;
  header.SkipName();
  const std::uint64_t rank = header.FewCount();
  for (std::uint64_t i = 0; i < rank && header.good(); ++i) {
    const std::uint64_t dimension = header.Count();
    header.Need(dimension < dimensions.size());
    const double length = dimension < dimensions.size() ? dimensions[dimension] : 0.0;
    if (i == 0 && length == 0.0) {
      variable.has_records = true;
    } else {
      variable.bytes *= length;
    }
  }
  header.SkipAttributes();
  variable.bytes *= static_cast<double>(header.BytesOfType());
  header.Count();  // the stored size, which is invalid for variables of 4 GiB or more
  variable.begin = static_cast<double>(header.Offset());
  return variable;
}

}  // namespace

std::optional<double> EndOfClassicValues(std::istream& file) {
  HeaderReader header(file);
  const std::uint64_t records = header.Count();
  std::vector<double> dimensions;
  for (std::uint64_t left = header.ListCount(kDimensions); left > 0 && header.good(); --left) {
    header.SkipName();
    dimensions.push_back(static_cast<double>(header.Count()));
  }
  header.SkipAttributes();
  std::vector<Variable> variables;
  for (std::uint64_t left = header.ListCount(kVariables); left > 0 && header.good(); --left) {
    variables.push_back(ReadVariable(header, dimensions));
  }
  if (header.ended()) return std::numeric_limits<double>::infinity();
  if (!header.good()) return std::nullopt;
  double record_bytes = 0.0;
  int with_records = 0;
  for (const Variable& variable : variables) {
    if (!variable.has_records) continue;
    ++with_records;
    record_bytes += std::ceil(variable.bytes / 4.0) * 4.0;
  }
  // All bits set: the file was written as a stream and the number of records is unknown.
  const bool streamed = records == 0xFFFFFFFFU || records == ~std::uint64_t{0};
  double end = 0.0;
  for (const Variable& variable : variables) {
    if (variable.has_records && (records == 0 || streamed)) continue;
    // The records of a single record variable are contiguous and not padded.
    const double apart = with_records == 1 ? variable.bytes : record_bytes;
    const double before = variable.has_records ? static_cast<double>(records - 1) * apart : 0.0;
    end = std::max(end, variable.begin + before + variable.bytes);
  }
  return end;
}

}  // namespace aquafarm::internal
