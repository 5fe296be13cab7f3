#include "base/csv.h"

#include <gtest/gtest.h>

namespace marey {
namespace {

TEST(CsvField, IsQuotedOnlyWhereItMustBe) {
  EXPECT_EQ(csvField("left foot [m]"), "left foot [m]");
  EXPECT_EQ(csvField(""), "");
  EXPECT_EQ(csvField("a,b"), "\"a,b\"");
  EXPECT_EQ(csvField("a \"b\""), "\"a \"\"b\"\"\"");
  EXPECT_EQ(csvField("two\nlines"), "\"two\nlines\"");
  EXPECT_EQ(csvField("two\rlines"), "\"two\rlines\"");
}

}  // namespace
}  // namespace marey
