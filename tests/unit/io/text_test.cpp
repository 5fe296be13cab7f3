#include "io/text.h"

#include <cmath>

#include <gtest/gtest.h>

namespace marey::io {
namespace {

TEST(Text, LinesEndWithLfCrlfOrTheEndOfTheText) {
  LineReader lines("a\r\n\nb\n \t\nc", "f");
  EXPECT_EQ(lines.next(), "a");
  EXPECT_EQ(lines.next(), "");
  EXPECT_EQ(lines.nextFilled(), "b");
  EXPECT_EQ(lines.nextFilled(), "c");
  EXPECT_EQ(lines.line(), 5);
  EXPECT_FALSE(lines.next());
}

TEST(Text, AnUnreadLineComesAgainWithItsNumber) {
  LineReader lines("a\nb\n", "f");
  lines.next();
  lines.next();
  lines.unread();
  EXPECT_EQ(lines.next(), "b");
  EXPECT_EQ(lines.line(), 2);
}

TEST(Text, NumbersAreReadInEveryUsualSpelling) {
  std::string_view row = " 1\t-2.5 +3 .5 -.25 1e-3 3.64024e-015 7.";
  const double expected[] = {1, -2.5, 3, 0.5, -0.25, 1e-3, 3.64024e-15, 7};
  double value = 0.0;
  for (const double wanted : expected) {
    ASSERT_EQ(takeNumber(row, value), NumberResult::Number) << wanted;
    EXPECT_DOUBLE_EQ(value, wanted);
  }
  EXPECT_EQ(takeNumber(row, value), NumberResult::End);
}

TEST(Text, WhatIsNoFiniteNumberIsBad) {
  for (const char* text :
       {"nan", "inf", "-inf", "NaN", "1,5", "12a", "--1", "+-1", "0x10", "1e999", "-"}) {
    std::string_view row = text;
    double value = 0.0;
    EXPECT_EQ(takeNumber(row, value), NumberResult::Bad) << text;
    EXPECT_FALSE(parseNumber(text)) << text;
  }
}

TEST(Text, NumbersTooSmallToStoreAreZero) {
  EXPECT_EQ(parseNumber("1e-400"), 0.0);
  EXPECT_EQ(parseNumber("-2.5e-999"), 0.0);
}

TEST(Text, CommasSeparateOnlyWhereTheyMay) {
  std::string_view row = "1,2,\t3";
  double value = 0.0;
  EXPECT_EQ(takeNumber(row, value, false), NumberResult::Bad);
  for (const double wanted : {1.0, 2.0, 3.0}) {
    EXPECT_EQ(takeNumber(row, value, true), NumberResult::Number);
    EXPECT_EQ(value, wanted);
  }
}

TEST(Text, WordsAndExcerptsKeepTheirText) {
  EXPECT_EQ(words(" a\tbc  d ").size(), 3u);
  EXPECT_EQ(trim("\t x y \r"), "x y");
  EXPECT_TRUE(sameIgnoringCase("End", "eND"));
  EXPECT_FALSE(sameIgnoringCase("End", "Ends"));
  EXPECT_EQ(excerpt("a\x01z"), "'a?z'");
  EXPECT_EQ(excerpt(std::string(100, 'x')), "'" + std::string(40, 'x') + "...'");
}

}  // namespace
}  // namespace marey::io
