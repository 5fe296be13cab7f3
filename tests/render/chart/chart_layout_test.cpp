// Geometry of charts on small pages: nothing turned inside out, no text over another one.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "render/chart/chart.h"
#include "render/chart/chart_frame.h"

namespace marey::render {
namespace {

Chart density(const std::string& joint) {
  Chart chart{.title = joint};
  chart.x = {.label = "speed", .unit = "cm/s", .range = {{0.0, 420.0}}};
  chart.y = {.label = "density", .range = {{0.0, 1.0}}, .showTicks = false};
  for (const char* name : {"Natural", "MG+ \u2013 still", "second \u2013 still"}) {
    Series series{.kind = SeriesKind::Density, .name = name};
    for (int i = 0; i <= 40; ++i) {
      series.x.push_back(10.5 * i);
      series.y.push_back(std::exp(-0.01 * (i - 20) * (i - 20)));
    }
    chart.series.push_back(series);
  }
  return chart;
}

ChartGrid densities(int count) {
  ChartGrid grid;
  for (int i = 0; i < count; ++i) grid.charts.push_back(density("RightToeBase"));
  grid.columns = count > 4 ? 3 : 2;
  return grid;
}

ChartGrid violins(int count) {
  ChartGrid grid = densities(count);
  for (Chart& chart : grid.charts) {
    chart.y = {.categories = {"Natural", "MG+ \u2013 still", "second \u2013 still"}};
    chart.legend = LegendPlace::None;
  }
  return grid;
}

/// Two models with one and the same floor, and the frame that surprised most, near both.
ChartGrid likelihood() {
  Chart chart;
  chart.x = {.label = "time", .unit = "s"};
  chart.y = {.label = "log-likelihood", .unit = "nats/frame"};
  chart.series.push_back({.name = "natural under MG+", .x = {0, 8}, .y = {640, 620}});
  chart.series.push_back({.name = "natural under second", .x = {0, 8}, .y = {600, 610}});
  for (const char* name : {"linear-Gaussian, MG+", "linear-Gaussian, second"})
    chart.series.push_back({.kind = SeriesKind::HorizontalRule, .name = name, .y = {405}});
  for (const double x : {0.1, 0.15, 7.9})
    chart.series.push_back(
        {.kind = SeriesKind::VerticalRule, .name = "worst frame, 564", .x = {x}});
  return single(chart);
}

ChartGrid footsteps() {
  Chart counts = density("");
  counts.y = {.label = "footsteps per minute"};
  counts.x = {.label = "speed tolerance", .unit = "cm/s", .range = {{0.0, 200.0}}};
  ChartGrid grid{.charts = {counts, density("")}, .columns = 2};
  grid.charts[1].title = grid.charts[0].title = "";
  return grid;
}

/// Pixels by which rectangles may touch: those of texts are an ascent and a descent high, more than
/// most letters fill.
constexpr double kTouch = 1.5;

void expectApart(const ChartGrid& grid, const ChartSize& size) {
  SCOPED_TRACE(std::to_string(size.width) + " x " + std::to_string(size.height));
  const std::vector<ChartText> texts = textsOf(grid, size);
  EXPECT_FALSE(texts.empty());
  for (size_t i = 0; i < texts.size(); ++i) {
    const ChartText& a = texts[i];
    EXPECT_GE(a.left, -kTouch) << a.text;
    EXPECT_GE(a.top, -kTouch) << a.text;
    EXPECT_LE(a.right, size.width + kTouch) << a.text;
    EXPECT_LE(a.bottom, size.height + kTouch) << a.text;
    for (size_t j = 0; j < i; ++j) {
      const ChartText& b = texts[j];
      const bool over = a.left + kTouch < b.right && b.left + kTouch < a.right &&
                        a.top + kTouch < b.bottom && b.top + kTouch < a.bottom;
      EXPECT_FALSE(over) << "'" << a.text << "' lies over '" << b.text << "'";
    }
  }
}

TEST(ChartLayout, TextsStandApartWhereAPageIsAsHighAsItNeedsToBe) {
  for (const double width : {210.0, 290.0, 420.0, 540.0, 900.0, 1400.0}) {
    for (const ChartGrid& grid :
         {densities(1), densities(4), densities(6), violins(4), likelihood(), footsteps()}) {
      const double least = leastHeight(grid, width);
      expectApart(grid, {width, least});
      expectApart(grid, {width, least + 160.0});
    }
  }
}

TEST(ChartLayout, PlotsAreReadableWhereAPageIsAsHighAsItNeedsToBe) {
  for (const double width : {210.0, 290.0, 540.0, 1400.0})
    for (const ChartGrid& grid : {densities(4), violins(4), likelihood(), footsteps()})
      for (const ChartFrame& frame : framesOf(grid, {width, leastHeight(grid, width)})) {
        EXPECT_GE(frame.right - frame.left, 80.0) << width;
        EXPECT_GE(frame.bottom - frame.top, 40.0) << width;
      }
}

TEST(ChartLayout, NoPageIsTooSmallForDensitiesToStandOnTheirAxis) {
  for (const double width : {60.0, 120.0, 207.0, 400.0})
    for (const double height : {40.0, 90.0, 130.0, 300.0})
      for (const ChartFrame& frame : framesOf(densities(5), {width, height})) {
        EXPECT_LT(frame.left, frame.right);
        EXPECT_LT(frame.pixelY(1.0), frame.pixelY(0.0)) << "upside down";
        EXPECT_LE(frame.pixelY(0.0), frame.bottom + 1e-9);
      }
}

TEST(ChartLayout, EveryRuleHasItsName) {
  for (const double height : {170.0, 400.0}) {
    size_t floors = 0, worst = 0;
    for (const ChartText& text : textsOf(likelihood(), {540, height})) {
      floors += text.text.starts_with("linear-Gaussian") ? 1 : 0;
      worst += text.text.starts_with("worst frame") ? 1 : 0;
    }
    EXPECT_EQ(floors, 2U);
    EXPECT_EQ(worst, 3U);
  }
}

TEST(ChartLayout, SharesOfRowsDivideTheHeightOfThePlots) {
  ChartGrid grid{.charts = {density("a"), density("b")}, .columns = 1, .rowShares = {1.0, 0.5}};
  const auto frames = framesOf(grid, {600, 500});
  const auto height = [&](size_t i) { return frames[i].bottom - frames[i].top; };
  EXPECT_NEAR(height(0), 2.0 * height(1), 1e-9);
  EXPECT_GT(frames[1].top, frames[0].bottom);
}

TEST(ChartLayout, ALongNameIsCutAtAWholeCharacter) {
  Chart chart = density("");
  for (int i = 0; i < 30; ++i) chart.title += "\u00e4\u2013";
  const auto texts = textsOf(single(chart), {200, 200});
  const auto cut = std::find_if(texts.begin(), texts.end(), [](const ChartText& text) {
    return text.text.ends_with("\u2026") && text.text.starts_with("\u00e4");
  });
  ASSERT_NE(cut, texts.end());
  EXPECT_LE(cut->right, 200.0);
  const std::string whole = cut->text.substr(0, cut->text.size() - 3);
  EXPECT_TRUE(whole.ends_with("\u00e4") || whole.ends_with("\u2013"));
}

}  // namespace
}  // namespace marey::render
