// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/base/cbor.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "aquafarm/base/check.h"

namespace aquafarm {
namespace {

constexpr std::size_t kMaxDepth = 16;

// Walks over the items of CBOR bytes without recursion.
class Walk {
 public:
  Walk(std::string_view bytes, const std::string& what) : bytes_(bytes), what_(what) {}

  // Checks the first item, with all that it contains.
  // @throws InputError if an item is nested too deeply, truncated, or of indefinite or reserved
  //   length
  void Check() {
    std::vector<std::uint64_t> left{1};  // items still to read, by level
    while (!left.empty()) {
      if (left.back() == 0) {
        left.pop_back();
        continue;
      }
      --left.back();
      const std::uint64_t inside = Next();
      if (inside == 0) continue;
      if (left.size() > kMaxDepth) Fail("nested too deeply");
      left.push_back(inside);
    }
  }

 private:
  // Reads the head of an item and skips the bytes of a string. Returns the number of items that the
  // item contains.
  std::uint64_t Next() {
    constexpr unsigned kIndefinite = 31;
    const unsigned head = Byte();
    const unsigned type = head >> 5U;
    const unsigned info = head & 31U;
    if (info == kIndefinite) Fail("an item of indefinite length");
    if (info > 27) Fail("a reserved length");
    const std::uint64_t number = info < 24 ? info : Number(std::size_t{1} << (info - 24U));
    switch (type) {
      case 2:  // byte string
      case 3:  // text string
        Skip(number);
        return 0;
      case 4:  // array
        return Contained(number, 1);
      case 5:  // map
        return Contained(number, 2);
      case 6:  // tag of the next item
        return 1;
      default:  // integers, floats and simple values
        return 0;
    }
  }

  // Returns number · items_each. Each contained item has at least one byte, so more items than
  // remaining bytes are an error. Without this check the parser would allocate memory for them.
  std::uint64_t Contained(std::uint64_t number, std::uint64_t items_each) {
    if (number > (bytes_.size() - at_) / items_each) Fail("they end early");
    return number * items_each;
  }

  unsigned Byte() {
    if (at_ == bytes_.size()) Fail("they end early");
    return static_cast<unsigned char>(bytes_[at_++]);
  }

  // Reads a number in network byte order.
  std::uint64_t Number(std::size_t size) {
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < size; ++i) number = number << 8U | Byte();
    return number;
  }

  void Skip(std::uint64_t size) {
    if (size > bytes_.size() - at_) Fail("they end early");
    at_ += static_cast<std::size_t>(size);
  }

  [[noreturn]] void Fail(const char* why) const {
    throw InputError(what_ + ": damaged bytes: " + why);
  }

  std::string_view bytes_;
  const std::string& what_;
  std::size_t at_{};
};

}  // namespace

nlohmann::json ParseCbor(std::string_view bytes, const std::string& what) {
  Walk(bytes, what).Check();
  try {
    return nlohmann::json::from_cbor(bytes);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(what + ": damaged bytes: " + error.what());
  }
}

}  // namespace aquafarm
