// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/bags/translate_message.h"

#include <gtest/gtest.h>

#include <string>

namespace aquafarm_sim {
namespace {

using Bytes = MessageTranslator::Bytes;

const char* const kOld = R"(# a comment
uint8 NONE = 0  # a constant
Header header
Part[] parts
string name  # text
float32[2] pair
===================================
MSG: std_msgs/Header
uint32 seq
===================================
MSG: test/Part
int16 id
)";

const char* const kNew = R"(Header header
float64 first
Part[] parts
string name
uint8[3] fixed
string[] list
float32[2] pair
===================================
MSG: std_msgs/Header
uint32 seq
===================================
MSG: test/Part
bool added
int16 id
Inner inner
===================================
MSG: test/Inner
string text
time stamp
)";

// seq 7, parts 1 and 2, "ab", a pair
const Bytes kMessage{7, 0, 0, 0,  2,  0, 0, 0, 1, 0, 2, 0, 2,
                     0, 0, 0, 97, 98, 1, 2, 3, 4, 5, 6, 7, 8};

TEST(MessageTranslator, FillsAddedFieldsWithZerosAndKeepsTheRest) {
  const MessageTranslator translator("test/Message", kOld, kNew);
  Bytes expected{7, 0, 0, 0};
  expected.insert(expected.end(), 8, 0);  // first
  expected.insert(expected.end(), {2, 0, 0, 0});
  for (const std::uint8_t id : {std::uint8_t{1}, std::uint8_t{2}}) {
    expected.insert(expected.end(), {0, id, 0});
    expected.insert(expected.end(), 4 + 8, 0);  // inner
  }
  expected.insert(expected.end(), {2, 0, 0, 0, 97, 98});
  expected.insert(expected.end(), 3 + 4, 0);  // fixed, list
  expected.insert(expected.end(), {1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_EQ(translator.Translate(kMessage), expected);
  const MessageTranslator back("test/Message", kNew, kOld);
  EXPECT_EQ(back.Translate(expected), kMessage);
}

TEST(MessageTranslator, RefusesAMessageOfAnotherLength) {
  const MessageTranslator translator("test/Message", kOld, kNew);
  for (std::size_t size = 0; size < kMessage.size(); ++size) {
    const Bytes part(kMessage.begin(), kMessage.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THROW(translator.Translate(part), TranslationError) << size;
  }
  Bytes longer = kMessage;
  longer.push_back(0);
  EXPECT_THROW(translator.Translate(longer), TranslationError);
  Bytes many = kMessage;
  many[7] = 0xFF;  // 4 G parts
  EXPECT_THROW(translator.Translate(many), TranslationError);
}

TEST(MessageTranslator, RefusesAFieldWithAnotherTypeAndADefinitionInPieces) {
  std::string other = kNew;
  other.replace(other.find("int16 id"), 8, "int32 id");
  EXPECT_THROW(MessageTranslator("test/Message", kOld, other), TranslationError);
  EXPECT_THROW(MessageTranslator("test/Message", "Part part", kNew), TranslationError);
  EXPECT_THROW(MessageTranslator("test/Message", "uint8", kNew), TranslationError);
  const std::string endless = "Part part\n====\nMSG: test/Part\nPart part\n";
  EXPECT_THROW(MessageTranslator("test/Message", endless, kNew), TranslationError);
}

}  // namespace
}  // namespace aquafarm_sim
