#include "render/chart/chart.h"

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <zlib.h>

#include "base/error.h"
#include "render/baseline.h"
#include "render/chart/chart_frame.h"
#include "render/chart/ticks.h"

namespace marey::render {
namespace {

TEST(Ticks, AreRoundInsideTheRangeAndEquallyLabelled) {
  const Ticks ticks = niceTicks(-0.31, 1.04, 6);
  EXPECT_EQ(ticks.labels,
            (std::vector<std::string>{"\u22120.2", "0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_DOUBLE_EQ(ticks.step, 0.2);
  EXPECT_EQ(niceTicks(0.0, 1200.0, 4).labels,
            (std::vector<std::string>{"0", "200", "400", "600", "800", "1000", "1200"}));
  EXPECT_EQ(niceTicks(0.0, 200.0, 4).labels,
            (std::vector<std::string>{"0", "50", "100", "150", "200"}));
}

TEST(Ticks, StepsAreOneTwoOrFiveTimesAPowerOfTenForAnyRange) {
  for (int k = 0; k < 200; ++k) {
    const double low = std::sin(k) * std::pow(10.0, k % 7 - 3),
                 high = low + std::pow(1.37, k % 40) * 1e-3;
    const Ticks ticks = niceTicks(low, high, 5);
    const double mantissa = ticks.step / std::pow(10.0, std::floor(std::log10(ticks.step) + 1e-9));
    EXPECT_TRUE(std::abs(mantissa - 1) < 1e-6 || std::abs(mantissa - 2) < 1e-6 ||
                std::abs(mantissa - 5) < 1e-6)
        << mantissa;
    EXPECT_GE(ticks.values.size(), 2U);
    EXPECT_LE(ticks.values.size(), 10U);
    for (const double v : ticks.values)
      EXPECT_TRUE(v >= low - 1e-9 * ticks.step && v <= high + 1e-9 * ticks.step);
  }
}

TEST(Colours, NaturalIsNearBlackAndSystemsDiffer) {
  EXPECT_EQ(hexOf(naturalColour()), "#222222");
  EXPECT_EQ(hexOf(colourOf(0)), "#0072b2");
  EXPECT_EQ(hexOf(colourOf(12)), hexOf(colourOf(0)));
}

/// Distance in CIE L*a*b* (1976); 2 is just noticeable side by side, 20 clear from memory.
double labDistance(const Colour& a, const Colour& b) {
  const auto lab = [](const Colour& c) {
    const auto linear = [](double v) {
      return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    };
    const auto root = [](double v) {
      return v > 0.008856 ? std::cbrt(v) : 7.787 * v + 16.0 / 116.0;
    };
    const double r = linear(c.r), g = linear(c.g), b = linear(c.b);
    const double x = root((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
    const double y = root(0.2126 * r + 0.7152 * g + 0.0722 * b);
    const double z = root((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
    return Eigen::Vector3d(116.0 * y, 500.0 * (x - y), 200.0 * (y - z));
  };
  return (lab(a) - lab(b)).norm();
}

TEST(Colours, OfTwelveSystemsAndNaturalMotionDifferClearly) {
  for (int i = 0; i < 12; ++i) {
    EXPECT_GT(labDistance(colourOf(i), naturalColour()), 20.0) << i;
    for (int k = 0; k < i; ++k)
      EXPECT_GT(labDistance(colourOf(i), colourOf(k)), 20.0) << i << " and " << k;
  }
}

TEST(Colours, OfStagesGoFromDarkToLightBesideThoseOfSystems) {
  for (double share = 0.0; share < 0.95; share += 0.1)
    EXPECT_NE(colourOf(stageIndex(share)), colourOf(stageIndex(share + 0.1))) << share;
  const Colour early = colourOf(stageIndex(0.0)), late = colourOf(stageIndex(1.0));
  EXPECT_LT(early.r + early.g + early.b, late.r + late.g + late.b);
  EXPECT_EQ(hexOf(colourOf(stageIndex(0.5) + 1)), hexOf(colourOf((stageIndex(0.5) + 1) % 12)));
}

Series line(const std::string& name, const Colour& colour, double offset) {
  Series series{.kind = SeriesKind::Line, .name = name, .colour = colour};
  for (int i = 0; i <= 40; ++i) {
    series.x.push_back(0.1 * i);
    series.y.push_back(10.0 + offset + 3.0 * std::sin(0.3 * i));
  }
  return series;
}

Chart sampleChart() {
  Chart chart{.title = "Speed"};
  chart.x = {.label = "time", .unit = "s"};
  chart.y = {.label = "speed", .unit = "cm/s"};
  Series band = line("", colourOf(0), 0.0);
  band.kind = SeriesKind::Band;
  band.opacity = 0.2;
  for (const double v : band.y) {
    band.low.push_back(v - 2.0);
    band.high.push_back(v + 1.0);
  }
  chart.series = {band, line("MG", colourOf(0), 0.0), line("natural", naturalColour(), 4.0)};
  chart.series.push_back({.kind = SeriesKind::HorizontalRule,
                          .name = "floor",
                          .colour = grey(0.4),
                          .y = {9.0},
                          .dashed = true});
  return chart;
}

ChartGrid sampleGrid() {
  Chart densities{.title = "Density"}, gait{.title = "Contacts"};
  Series density{.kind = SeriesKind::Density, .name = "MG", .colour = colourOf(0), .opacity = 0.2};
  for (int i = 0; i <= 30; ++i) {
    density.x.push_back(i);
    density.y.push_back(std::exp(-0.02 * (i - 12) * (i - 12)));
  }
  densities.series = {density};
  densities.y.showTicks = false;
  gait.y.categories = {"left", "right"};
  gait.series = {{.kind = SeriesKind::Intervals,
                  .name = "natural",
                  .y = {0.5, 0.5, 1.5},
                  .low = {0, 2, 1},
                  .high = {1, 3, 2},
                  .width = 0.6}};
  Chart bars{.title = "Bars"};
  bars.series = {{.kind = SeriesKind::Bars,
                  .name = "MG",
                  .colour = colourOf(0),
                  .x = {1, 2, 3},
                  .y = {2, 5, 3},
                  .width = 0.8},
                 {.kind = SeriesKind::Dots,
                  .name = "natural",
                  .x = {1, 2, 3},
                  .y = {3, 4, 3},
                  .low = {2, 3, 2},
                  .high = {4, 5, 4}}};
  return {.title = "Kinds", .charts = {densities, gait, bars, sampleChart()}, .columns = 2};
}

TEST(Chart, EveryKindLooksAsItDid) {
  EXPECT_TRUE(matchesBaseline(drawImage(sampleGrid(), {600, 500}, 0.6), "chart_kinds", 0.95));
}

TEST(Chart, DirectLabelsLookAsTheyDid) {
  Chart chart = sampleChart();
  chart.legend = LegendPlace::Direct;
  EXPECT_TRUE(matchesBaseline(drawImage(single(chart), {400, 300}, 1.0), "chart_direct", 0.95));
}

TEST(Chart, EqualChartsGiveEqualBytesInEveryFormat) {
  const ChartSize size{400, 300};
  EXPECT_EQ(drawSvg(sampleGrid(), size, {{"seed", "1"}}, "f"),
            drawSvg(sampleGrid(), size, {{"seed", "1"}}, "f"));
  EXPECT_EQ(drawPdf(sampleGrid(), size, {{"seed", "1"}}),
            drawPdf(sampleGrid(), size, {{"seed", "1"}}));
  EXPECT_EQ(drawImage(sampleGrid(), size).pixels, drawImage(sampleGrid(), size).pixels);
}

TEST(Chart, AnSvgHasItsTextItsRecipeAndIdsOfItsOwn) {
  Chart chart = sampleChart();
  chart.title = "a < b & c";
  const std::string svg = drawSvg(single(chart), {400, 300}, {{"seed", "1<2"}}, "mine");
  EXPECT_NE(svg.find(">a &lt; b &amp; c</text>"), std::string::npos);
  EXPECT_NE(svg.find(">speed [cm/s]</text>"), std::string::npos);
  EXPECT_NE(svg.find("<metadata>{&quot;seed&quot;:&quot;1&lt;2&quot;}</metadata>"),
            std::string::npos);
  for (size_t at = svg.find("id=\""); at != std::string::npos; at = svg.find("id=\"", at + 1)) {
    EXPECT_EQ(svg.substr(at + 4, 5), "mine-");
  }
}

/// What the content stream of a PDF puts where, in points from the top left; after ISO 32000-1,
/// 8.4 (the matrix of coordinates), 8.5 (paths) and 9.4 (texts).
struct PdfMarks {
  std::vector<Eigen::Vector2d> path, texts;  ///< corners of paths; starts of shown texts
};

std::string inflated(const std::string& data) {
  std::string out(64 * data.size() + 4096, '\0');
  uLongf size = out.size();
  EXPECT_EQ(::uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                         reinterpret_cast<const Bytef*>(data.data()), data.size()),
            Z_OK);
  out.resize(size);
  return out;
}

/// The first stream of a file that shows text.
std::string contentOf(const std::string& pdf) {
  for (size_t at = pdf.find("\nstream\n"); at != std::string::npos;
       at = pdf.find("\nstream\n", at + 1)) {
    const size_t begin = at + 8;
    if (pdf.substr(begin, 1) != "\x78") continue;  // not deflated
    const std::string text = inflated(pdf.substr(begin, pdf.find("\nendstream", begin) - begin));
    if (text.find("\nBT") != std::string::npos || text.find(" BT") != std::string::npos)
      return text;
  }
  ADD_FAILURE() << "no page content";
  return {};
}

PdfMarks marksOf(const std::string& content) {
  const auto matrix = [](const std::vector<double>& v) {
    Eigen::Affine2d m;
    m.matrix() << v[0], v[2], v[4], v[1], v[3], v[5], 0, 0, 1;
    return m;
  };
  PdfMarks out;
  Eigen::Affine2d now = Eigen::Affine2d::Identity(), text = now;
  std::vector<Eigen::Affine2d> saved;
  std::vector<double> numbers;
  std::istringstream in(content);
  for (std::string word; in >> word;) {
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    if (*end == '\0') {
      numbers.push_back(number);
      continue;
    }
    const auto point = [&](size_t i) {
      return Eigen::Vector2d(now * Eigen::Vector2d(numbers[i], numbers[i + 1]));
    };
    if (word == "q") saved.push_back(now);
    if (word == "Q") {
      now = saved.back();
      saved.pop_back();
    }
    if (word == "cm") now = now * matrix(numbers);
    if (word == "Tm") text = now * matrix(numbers);
    if (word == "m" || word == "l") out.path.push_back(point(0));
    if (word == "c") out.path.push_back(point(4));
    if (word == "re") {
      out.path.push_back(point(0));
      out.path.emplace_back(now *
                            Eigen::Vector2d(numbers[0] + numbers[2], numbers[1] + numbers[3]));
    }
    if (word.ends_with("Tj") || word.ends_with("TJ")) out.texts.emplace_back(text.translation());
    numbers.clear();
  }
  return out;
}

TEST(Chart, APdfIsOnePageWithEverythingOnIt) {
  const ChartGrid grid = sampleGrid();
  const ChartSize size{600, 500};
  const std::string pdf = drawPdf(grid, size, {{"seed", "1"}});
  EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
  const std::regex page("/Type /Page[^s]"), box(R"(/MediaBox \[ 0 0 450 375 \])"),
      count("/Count 1\\b");
  const auto found = [&](const std::regex& what) {
    return std::distance(std::sregex_iterator(pdf.begin(), pdf.end(), what), std::sregex_iterator());
  };
  EXPECT_EQ(found(page), 1);
  EXPECT_EQ(found(count), 1);
  EXPECT_GE(found(box), 1);
  const PdfMarks marks = marksOf(contentOf(pdf));
  const auto onPage = [](const Eigen::Vector2d& p) {
    return p.x() >= 0.0 && p.x() <= 450.0 && p.y() >= 0.0 && p.y() <= 375.0;
  };
  size_t points = 0;
  for (const Chart& chart : grid.charts)
    for (const Series& series : chart.series)
      points += std::max(series.x.size(), series.low.size());
  EXPECT_GE(marks.path.size(), points);
  for (const auto& p : marks.path) EXPECT_TRUE(onPage(p)) << p.transpose();
  // Every text starts where the chart says it stands, which is on the page.
  const std::vector<ChartText> texts = textsOf(grid, size);
  EXPECT_GT(texts.size(), 20U);
  EXPECT_GE(marks.texts.size(), texts.size());
  constexpr double perPixel = 0.75, slack = 1.0;
  for (const ChartText& text : texts) {
    EXPECT_TRUE(onPage({perPixel * text.left, perPixel * text.top})) << text.text;
    EXPECT_TRUE(onPage({perPixel * text.right, perPixel * text.bottom})) << text.text;
    EXPECT_TRUE(std::any_of(marks.texts.begin(), marks.texts.end(), [&](const auto& p) {
      const double y = 375.0 - p.y();
      return p.x() >= perPixel * text.left - slack && p.x() <= perPixel * text.right + slack &&
             y >= perPixel * text.top - slack && y <= perPixel * text.bottom + slack;
    })) << text.text;
  }
}

TEST(Chart, ALineIsDrawnWhereItsDataAre) {
  // A flat line at half the range of the axis: its colour must appear in the middle row of the plot
  // and a flat line at a quarter of it must be that much lower.
  const auto rowOf = [](double value) {
    Chart chart;
    chart.x.range = {0.0, 1.0};
    chart.y = {.range = {{0.0, 1.0}}, .showTicks = false};
    chart.x.showTicks = false;
    chart.series = {{.kind = SeriesKind::Line,
                     .name = "",
                     .colour = {1, 0, 0, 1},
                     .x = {0, 1},
                     .y = {value, value},
                     .width = 2.0}};
    const Image image = drawImage(single(chart), {200, 220});
    for (int y = 0; y < image.height; ++y) {
      const uint8_t* p = image.at(100, y);
      if (p[0] > 200 && p[1] < 60) return y;
    }
    return -1;
  };
  const int top = rowOf(0.99), middle = rowOf(0.5), low = rowOf(0.01);
  ASSERT_GT(top, 0);
  EXPECT_NEAR(middle, (top + low) / 2.0, 1.0);
  EXPECT_NEAR(rowOf(0.25), (middle + low) / 2.0, 2.0);
}

TEST(Chart, MissingValuesBreakALineWithoutHarm) {
  Chart chart = sampleChart();
  chart.series[1].y[5] = NAN;
  EXPECT_NO_THROW(drawImage(single(chart), {400, 300}));
}

TEST(Chart, SeriesWhoseLengthsDisagreeAreRefusedByName) {
  Chart chart = sampleChart();
  chart.series[1].y.pop_back();
  try {
    drawSvg(single(chart), {400, 300});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'MG'"), std::string::npos) << error.what();
  }
  Chart band = sampleChart();
  band.series[0].low.pop_back();
  EXPECT_THROW(drawSvg(single(band), {400, 300}), InputError);
}

}  // namespace
}  // namespace marey::render
