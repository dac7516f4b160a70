// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "aquafarm/base/check.h"

namespace aquafarm {

/// Rejects bytes that are nested deeper than any saved state or checkpoint, because the parser
/// recurses as deep as the bytes specify.
class CborDepth final : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit CborDepth(std::string what) : what_(std::move(what)) {}

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return ++depth_ <= kDeepest; }
  bool key(string_t&) override { return true; }
  bool end_object() override { return depth_-- > 0; }
  bool start_array(std::size_t) override { return ++depth_ <= kDeepest; }
  bool end_array() override { return depth_-- > 0; }
  bool parse_error(std::size_t, const std::string&,
                   const nlohmann::detail::exception& error) override {
    throw InputError(what_ + ": damaged bytes: " + error.what());
  }

 private:
  static constexpr int kDeepest = 16;
  const std::string what_;
  int depth_{};
};

/// Parses CBOR bytes. @param what the bytes are, for messages
/// @throws InputError if the bytes are not CBOR or are nested too deeply
inline nlohmann::json ParseCbor(std::string_view bytes, const std::string& what = "state") {
  CborDepth depth(what);
  if (!nlohmann::json::sax_parse(bytes, &depth, nlohmann::json::input_format_t::cbor)) {
    throw InputError(what + ": damaged bytes: nested too deeply");
  }
  return nlohmann::json::from_cbor(bytes);
}

}  // namespace aquafarm
