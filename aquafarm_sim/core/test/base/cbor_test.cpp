// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/base/cbor.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>

#include "aquafarm/base/check.h"

namespace aquafarm {
namespace {

std::string BytesOf(const nlohmann::json& json) {
  const auto bytes = nlohmann::json::to_cbor(json);
  return {bytes.begin(), bytes.end()};
}

std::string ErrorOf(const std::string& bytes) {
  try {
    ParseCbor(bytes, "state");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Cbor, ReadsWhatTheLibraryWrites) {
  nlohmann::json json = {
      {"text", std::string(70000, 'x')},
      {"empty", nlohmann::json::array()},
      {"none", nullptr},
      {"flags", {true, false}},
      {"blob", nlohmann::json::binary({0x7f, 0x7f, 0x5f, 0xff})},
      {"numbers",
       {0, 23, 24, 255, 256, 65536, -1, -300, 1.5, 1e300, std::numeric_limits<std::uint64_t>::max(),
        std::numeric_limits<std::int64_t>::min()}}};
  for (int i = 0; i < 300; ++i) json["many"].push_back({{"i", i}});
  EXPECT_EQ(ParseCbor(BytesOf(json)), json);
}

TEST(Cbor, AcceptsSixteenLevelsAndNoMore) {
  nlohmann::json json = 1;
  for (int level = 0; level < 16; ++level) json = nlohmann::json::array({json});
  EXPECT_EQ(ParseCbor(BytesOf(json)), json);
  EXPECT_EQ(ErrorOf(BytesOf(nlohmann::json::array({json}))),
            "state: damaged bytes: nested too deeply");
  EXPECT_EQ(ErrorOf(std::string(8'000'000, '\x81')), "state: damaged bytes: nested too deeply");
  EXPECT_EQ(ErrorOf(std::string(8'000'000, '\xc0')), "state: damaged bytes: nested too deeply")
      << "tags";
}

// The parser recurses once for each of these bytes and would overflow the stack.
TEST(Cbor, RefusesStringsOfIndefiniteLength) {
  for (const char head : {'\x7f', '\x5f', '\x9f', '\xbf'}) {
    EXPECT_EQ(ErrorOf(std::string(8'000'000, head)),
              "state: damaged bytes: an item of indefinite length");
  }
}

TEST(Cbor, RefusesEveryTruncation) {
  const std::string bytes =
      BytesOf({{"list", {1, 2.5, "three"}}, {"blob", nlohmann::json::binary({1, 2, 3})}});
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_EQ(ErrorOf(bytes.substr(0, size)), "state: damaged bytes: they end early") << size;
  }
  EXPECT_NE(ErrorOf(bytes + "\x01"), "") << "bytes after the end";
  EXPECT_EQ(ErrorOf("\x9b\xff\xff\xff\xff\xff\xff\xff\xff"),
            "state: damaged bytes: they end early");
  EXPECT_EQ(ErrorOf("\x1c"), "state: damaged bytes: a reserved length");
}

}  // namespace
}  // namespace aquafarm
