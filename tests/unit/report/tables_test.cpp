#include "report/tables.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"

namespace marey::report {
namespace {

Table sample() {
  return {
      .id = "steps",
      .title = "Steps",
      .caption = "c",
      .columns = {{"System"}, {"v95", "cm/s", "tolerance"}, {"remark"}},
      .rows = {{{"a, \"b\""}, numberCell(1.0 / 3.0, 2), {"x"}}, {{"c"}, numberCell(NAN, 2), {""}}}};
}

TEST(Tables, CsvQuotesTextKeepsFullNumbersAndLeavesMissingOnesEmpty) {
  EXPECT_EQ(tableCsv(sample()),
            "System,v95 [cm/s],remark\r\n"
            "\"a, \"\"b\"\"\",0.3333333333333333,x\r\n"
            "c,,\r\n");
}

TEST(Tables, JsonHoldsNumbersNullsUnitsAndTheRecipe) {
  const Json json = tableJson(sample(), {{"seed", "3"}});
  EXPECT_EQ(json["columns"][1]["unit"], "cm/s");
  EXPECT_EQ(json["rows"][0][1].get<double>(), 1.0 / 3.0);
  EXPECT_TRUE(json["rows"][1][1].is_null());
  EXPECT_EQ(json["recipe"]["seed"], "3");
  EXPECT_EQ(tableSidecar(sample(), {{"seed", "3"}})["columns"][1]["note"], "tolerance");
}

TEST(Tables, HtmlEscapesTextAndAlignsNumbersRight) {
  Table table = sample();
  table.rows[0][0].text = "<script>";
  const std::string html = tableHtml(table);
  EXPECT_NE(html.find("&lt;script&gt;"), std::string::npos);
  EXPECT_EQ(html.find("<script>"), std::string::npos);
  EXPECT_NE(html.find("<td class=\"number\">0.33</td>"), std::string::npos);
  EXPECT_NE(html.find("<td>x</td>"), std::string::npos);
}

TEST(Tables, NumbersAreRoundedForPeopleWithATrueMinusAndNoMinusZero) {
  EXPECT_EQ(numberCell(-1.256, 2).text, "\u22121.26");
  EXPECT_EQ(numberCell(-0.001, 2).text, "0.00");
  EXPECT_EQ(numberCell(12.5, 0).text, "12");
  EXPECT_EQ(numberCell(INFINITY, 1).text, "\u2013");
  EXPECT_FALSE(numberCell(NAN, 1).number.has_value());
}

TEST(Tables, UnusableReportsAreRefusedWithTheName) {
  ReportData data;
  data.tables = {sample(), sample()};
  EXPECT_THROW(validate(data), InputError) << "two tables of one name";
  data.tables = {sample()};
  EXPECT_NO_THROW(validate(data));
  data.tables[0].rows[1].pop_back();
  EXPECT_THROW(validate(data), InputError) << "a short row";
  data.tables = {sample()};
  data.tables[0].id = "../steps";
  EXPECT_THROW(validate(data), InputError) << "an id that leaves the folder";
  data.tables.clear();
  data.gaits = {{"gait", 1.0, {{0, "LeftFoot", {}}}}};
  try {
    validate(data);
    FAIL() << "a system that does not exist";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("gait"), std::string::npos);
  }
  data.gaits.clear();
  data.scenes = {{.path = "slow", .title = "Slow"}};
  EXPECT_THROW(validate(data), InputError) << "a scene that nobody walks";
}

}  // namespace
}  // namespace marey::report
