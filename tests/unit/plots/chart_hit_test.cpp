// What the mouse finds in a chart, and charts as tables.
#include "gui/plots/chart_hit.h"

#include <limits>

#include "gui/plots/chart_files.h"
#include <gtest/gtest.h>

#include "base/error.h"

namespace marey::gui {
namespace {

using render::Chart;
using render::ChartGrid;
using render::Series;
using render::SeriesKind;

ChartGrid twoLines() {
  Chart chart{.title = "Lines, two"};
  chart.x.range = {0.0, 10.0};
  chart.y.range = {0.0, 10.0};
  chart.series = {{.kind = SeriesKind::Line, .name = "rising", .x = {0, 10}, .y = {0, 10}},
                  {.kind = SeriesKind::Line, .name = "flat", .x = {0, 10}, .y = {2, 2}}};
  return single(chart);
}

std::optional<ChartHit> at(const ChartGrid& grid, double x, double y) {
  const auto frames = framesOf(grid, {500, 300});
  return hitAt(grid, frames, frames[0].pixelX(x), frames[0].pixelY(y));
}

TEST(ChartHit, FindsTheNearestLineAndItsValue) {
  const ChartGrid grid = twoLines();
  const auto rising = at(grid, 7.0, 7.1), flat = at(grid, 7.0, 2.1);
  ASSERT_TRUE(rising && rising->curve && flat && flat->curve);
  EXPECT_EQ(rising->curve->series, 0);
  EXPECT_NEAR(rising->curveY, 7.0, 1e-6);
  EXPECT_NEAR(rising->x, 7.0, 1e-6);
  EXPECT_EQ(flat->curve->series, 1);
  EXPECT_FALSE(at(grid, 7.0, 4.5)->curve) << "nothing is near there";
}

TEST(ChartHit, OutsideThePlotThereIsNothing) {
  const ChartGrid grid = twoLines();
  EXPECT_FALSE(hitAt(grid, framesOf(grid, {500, 300}), 1.0, 1.0));
}

TEST(ChartHit, FindsTheRowOfACloudAndItsPoints) {
  ChartGrid grid = twoLines();
  Series cloud{.kind = SeriesKind::Cloud, .name = "cloud", .x = {0, 5, 10}};
  cloud.cloud = std::make_shared<render::CloudLines>(
      std::vector<float>{1, 1, 1, 5, 5, 5, 9, std::numeric_limits<float>::quiet_NaN(), 9});
  grid.charts[0].series = {cloud};
  const auto hit = at(grid, 3.0, 5.0);
  ASSERT_TRUE(hit && hit->curve);
  EXPECT_EQ(*hit->curve, (CurveRef{0, 0, 1}));
  EXPECT_FALSE(at(grid, 3.0, 9.0)->curve) << "the line is broken there";
  EXPECT_EQ(pointsOf(grid, *hit->curve).y, (std::vector<double>{5, 5, 5}));
  EXPECT_THROW(pointsOf(grid, {0, 0, 3}), std::out_of_range);
}

TEST(ChartHit, ALineComesBeforeTheBandBehindIt) {
  ChartGrid grid = twoLines();
  grid.charts[0].series.push_back(
      {.kind = SeriesKind::Band, .x = {0, 10}, .low = {1, 1}, .high = {9, 9}});
  EXPECT_EQ(at(grid, 7.0, 7.1)->curve->series, 0);
  EXPECT_EQ(at(grid, 3.0, 7.0)->curve->series, 2);
}

TEST(ChartHit, AnUprightRuleIsFoundWhereNoLineIsNear) {
  ChartGrid grid = twoLines();
  grid.charts[0].series.push_back({.kind = SeriesKind::VerticalRule, .name = "worst", .x = {7.0}});
  const auto rule = at(grid, 7.0, 4.5), line = at(grid, 7.0, 7.1);
  ASSERT_TRUE(rule && rule->curve && line && line->curve);
  EXPECT_EQ(rule->curve->series, 2);
  EXPECT_EQ(line->curve->series, 0);
}

TEST(ChartCsv, HasALinePerPointAndQuotesCommas) {
  EXPECT_EQ(chartCsv(twoLines()),
            "chart,series,line,x,y,low,high\n"
            "\"Lines, two\",rising,,0,0,,\n\"Lines, two\",rising,,10,10,,\n"
            "\"Lines, two\",flat,,0,2,,\n\"Lines, two\",flat,,10,2,,\n");
}

TEST(ChartFiles, OtherEndingsAreRefused) {
  EXPECT_THROW(saveChart(twoLines(), {}, {}, "chart.doc"), UsageError);
}

}  // namespace
}  // namespace marey::gui
