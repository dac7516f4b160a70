// SPDX-License-Identifier: BSD-3-Clause
// Truncated lines and contradictory values are rejected or reported. They are never read as smaller
// numbers.
#include <gtest/gtest.h>

#include "storm_samples.h"

namespace aquafarm {
namespace {

// The complete line of In-Fa with radii of 50 and 30 kt.
const std::string kInFa =
    "21072506 002 5 300 1225 970      065     90080 0080 20325 0240         #        ";

TEST(Jma, ALineThatEndsWithinAPointIsRefused) {
  const std::string text = Sample("jma.txt");
  const StormFix whole = ParseStormFile(text, "x").tracks[0].fixes[1];
  for (std::size_t size = 13; size < kInFa.size(); ++size) {
    const std::string cut = With(text, kInFa, kInFa.substr(0, size));
    const std::string refusal = Refusal(cut);
    if (refusal == "was read") {
      const StormFix fix = ParseStormFile(cut, "x").tracks[0].fixes[1];
      EXPECT_EQ(fix.wind_mps, whole.wind_mps) << size;
      ASSERT_EQ(fix.rings.size(), whole.rings.size()) << size;
      for (std::size_t i = 0; i < fix.rings.size(); ++i) {
        EXPECT_EQ(fix.rings[i].radius_km, whole.rings[i].radius_km) << size;
      }
    } else {
      EXPECT_EQ(refusal.substr(0, 4), "x:3:") << size;
    }
  }
  EXPECT_EQ(Refusal(With(text, kInFa, kInFa.substr(0, 35))),
            "x:3: got a line of 35 columns, expected at least 36, which contain the wind");
  EXPECT_EQ(Refusal(With(text, kInFa, kInFa.substr(0, 60))),
            "x:3: got a line of 60 columns, expected 62 or more where there are radii of 30 kt");
  EXPECT_EQ(Refusal(With(text, kInFa, kInFa.substr(0, 52))),
            "x:3: got radii of 50 kt alone, expected those of 30 kt as well");
  EXPECT_EQ(Refusal(With(text, kInFa, kInFa.substr(0, 36))),
            "x:3: got a line of 36 columns, expected at least 62, which contain the "
            "radii of a storm");
}

// Points below a padded header are padded; points below a header that ends with its date are not.
TEST(Jma, APointThatIsShorterThanItsHeaderIsSaid) {
  const std::string head =
      "66666 2106  002 0011 2106 0 6                IN-FA              20220101";
  const std::string rest(8, ' ');
  const std::string storm = "21072500 002 5 300 1225  970     065     90080 0080 20325 0240";
  const auto said = [&](const std::string& header, const std::string& point) {
    return Warnings(header + "\n" + storm + "         #" + rest + "\n" + point + "\n");
  };
  const std::string grade_7 = "21072506 002 7 300 1225  970     065     90080 0080 20325 0240";
  struct Case {
    bool filled;
    std::size_t columns;
    bool said;
  };
  for (const Case& one : {Case{true, 80, false},
                          {true, 72, false},
                          {true, 71, true},
                          {true, 62, true},
                          {true, 41, true},
                          {true, 36, true},
                          {false, 72, false},
                          {false, 71, true},
                          {false, 62, false},
                          {false, 41, true},
                          {false, 36, false}}) {
    const std::string point = (grade_7 + "         #" + rest).substr(0, one.columns);
    const std::string size = std::to_string(one.columns);
    EXPECT_EQ(said(head + (one.filled ? rest : ""), point),
              !one.said ? ""
                        : "x:3: got a point of " + size + " columns under a header of " +
                              (one.filled ? "80" : "72") + ": was the line cut off?\n")
        << size;
  }
}

TEST(Jma, WhatContradictsItselfIsIgnoredWithAWarning) {
  const std::string text = Sample("jma.txt");
  EXPECT_EQ(Warnings(With(text, "0011 2106", "0011 9999")),
            "x:1: number: got '2106' and '9999', expected the same twice; '2106' is used\n");
  const std::string direction = With(text, "90240", "00240");
  EXPECT_EQ(Warnings(direction),
            "x:4: direction of the longest radius: got 0, expected 1 to 9 with a radius of 30 kt; "
            "the radii are ignored\n");
  EXPECT_EQ(ParseStormFile(direction, "x").tracks[0].fixes[2].Ring(30), nullptr);
}

TEST(Atcf, ARowThatEndsWithinItsRadiiIsRefused) {
  const std::string text = Sample("atcf.dat");
  const std::string radii = "NEQ,  110,   90,    0,  100,";
  const std::size_t end = text.find('\n', text.find(radii));
  const auto cut = [&](const std::string& kept) {
    std::string damaged = text;
    const std::size_t at = damaged.find(radii);
    return damaged.replace(at, end - at, kept);
  };
  EXPECT_EQ(Refusal(cut("NEQ,  110,   90,    0,  100,")), "was read");
  EXPECT_EQ(Refusal(cut("NEQ,  110,   90")).substr(0, 19), "x:2: radius: got ''");
  EXPECT_EQ(Refusal(cut("NES,  110,   90,    ,     ,")), "was read") << "a semicircle has two";
  EXPECT_EQ(Refusal(cut("NES,  110")).substr(0, 19), "x:2: radius: got ''");
  EXPECT_EQ(Refusal(cut("AAA,  110,     ,    ,     ,")), "was read") << "a circle has one";
  const std::string words =
      " fields, expected at least 18, up to the comma after the radii, as in other rows";
  EXPECT_NE(Refusal(cut("NEQ,  110,   90,    0,  10")).find("x:2: got 17" + words),
            std::string::npos);
  EXPECT_NE(Refusal(cut("AAA,  110")).find("x:2: got 14" + words), std::string::npos);
}

TEST(Atcf, ARowThatEndsBeforeTheRadiusOfItsGreatestWindIsSaid) {
  const std::string row =
      "WP, 08, 2014070312,   , BEST,   0, 109N, 1440E,  30, 1000, TD,  34, NEQ, "
      " 10,   10,   10,   10, ";
  const std::string next = With(row, "2014070312", "2014070318");
  const std::string rest = "1006,  200,  45,";
  EXPECT_EQ(Warnings(row + rest + "\n" + next + rest + "\n"), "");
  EXPECT_EQ(Warnings(row + "\n" + next + "\n"), "") << "all end there";
  EXPECT_EQ(Warnings(row + rest + "\n" + next + "\n"), "") << "some rows are so by right";
  EXPECT_EQ(Warnings(row + rest + "\n" + next + "1006,  200,  4\n"),
            "x:2: got 20 fields, but other rows have up to 21: was the row cut off?\n");
}

TEST(Atcf, ATimeThatIsThereTwiceWithAnotherPlaceIsSaid) {
  const std::string text = Sample("atcf.dat");
  EXPECT_EQ(Warnings(text), "");
  const std::string moved =
      With(text, "131N, 1414E,  70,  970, TY,  50", "231N, 1414E,  70,  970, TY,  50");
  EXPECT_NE(Warnings(moved).find("x:3: time: 2014-07-04T06:00:00Z occurs twice"), std::string::npos)
      << Warnings(moved);
  EXPECT_NE(Refusal(With(text, "BEST,   0, 131N", "BEST,  12, 131N")).find("TAU"),
            std::string::npos);
}

TEST(Cma, APointThatIsShorterThanTheOthersIsSaid) {
  const std::string head = "66666 2106   02 0011 2106 0 3 In-fa   20220410\n";
  const std::string whole = "2021072500 4 297 1230  968      35\n";
  EXPECT_EQ(Warnings(head + whole + "2021072506 4 300 1222  970      33\n"), "");
  EXPECT_NE(
      Warnings(head + whole + "2021072506 4 300 1222  970      3\n")
          .find("x:3: got a point of 33 columns, but other points have 34: was the line cut off?"),
      std::string::npos);
}

TEST(Bulletin, AQuadrantThatIsNotSaidHasTheRadiusOfAll) {
  const auto ring = [](const std::string& quadrants) {
    const StormFile file = ParseStormFile(
        "[{\"tfbh\": \"202106\", \"name\": \"In-fa\", \"points\": [{\"time\": \"2021-07-25 "
        "14:00:00\","
        "\"lat\": 30, \"lng\": 122, \"speed\": 38, \"radius7\": 280, \"radius7_quad\": " +
            quadrants + "}]}]",
        "x");
    std::string all;
    for (const double radius : file.tracks.at(0).fixes.at(0).Ring(34)->radius_km) {
      all += std::to_string(static_cast<int>(radius)) + " ";
    }
    return all + std::to_string(file.warnings.size());
  };
  EXPECT_EQ(ring("{\"ne\": 300, \"se\": null, \"sw\": 200, \"nw\": null}"), "300 280 200 280 1");
  EXPECT_EQ(ring("{\"ne\": 300, \"se\": 250, \"sw\": 200, \"nw\": 0}"), "300 250 200 0 0");
  EXPECT_EQ(ring("{\"ne\": null, \"se\": null, \"sw\": null, \"nw\": null}"), "280 280 280 280 0");
  EXPECT_EQ(ring("{\"NE\": 300, \"SE\": 250, \"SW\": 200, \"NW\": 100}"), "300 250 200 100 0");
  EXPECT_EQ(ring("{\"north\": 300}"), "280 280 280 280 1");
}

}  // namespace
}  // namespace aquafarm
