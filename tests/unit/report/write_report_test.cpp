#include <cstdlib>
#include <filesystem>
#include <regex>
#include <set>

#include "unit/report/walker_report.h"
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json.h"
#include "report/figures.h"
#include "report/page.h"
#include "report/pdf.h"
#include "report/report.h"

namespace marey::report {
namespace {

namespace fs = std::filesystem;

class Report : public testing::Test {
 protected:
  // One folder per test and process: tests run side by side, and other users' may.
  fs::path m_folder =
      fs::temp_directory_path() / (std::string("marey_report_") + std::to_string(::getpid()) + "_" +
                                   testing::UnitTest::GetInstance()->current_test_info()->name());
  ReportOptions m_small{.pdf = false, .sceneWidth = 160, .sceneHeight = 100};
  Progress m_progress;
  void SetUp() override { fs::remove_all(m_folder); }
  void TearDown() override { fs::remove_all(m_folder); }
};

std::set<std::string> allMatches(const std::string& text, const std::string& pattern) {
  std::set<std::string> found;
  const std::regex regex(pattern);
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it)
    found.insert((*it)[1]);
  return found;
}

/// The page without base64 data, which no expression needs to search.
std::string pageText(const fs::path& html) {
  const std::string all = readFile(html), marker = "base64,";
  std::string text;
  size_t at = 0;
  for (size_t found = all.find(marker); found != std::string::npos; found = all.find(marker, at)) {
    text += all.substr(at, found - at);
    at = all.find('"', found);
  }
  return text + all.substr(at);
}

TEST_F(Report, WritesThePageEveryFigureAndEveryTable) {
  const ReportData data = walkerReport({"slow", "turn-left"}, 2, 3.0);
  const ReportFiles files = writeReport(data, m_folder, m_progress, m_small);
  EXPECT_TRUE(fs::exists(files.html));
  for (const fs::path& file : files.figures) EXPECT_GT(fs::file_size(file), 500U) << file;
  for (const fs::path& file : files.tables) EXPECT_GT(fs::file_size(file), 20U) << file;
  // Two scenes, one likelihood, footsteps, gait and two quantities, each as SVG and PNG.
  EXPECT_EQ(files.figures.size(), 2U * 7U);
  EXPECT_EQ(files.tables.size(), 3U * data.tables.size());
  EXPECT_TRUE(files.pdf.empty());
}

TEST_F(Report, ThePageLoadsNothingRunsNothingAndItsLinksLead) {
  const ReportFiles files =
      writeReport(walkerReport({"slow"}, 2, 3.0), m_folder, m_progress, m_small);
  const std::string page = pageText(files.html);
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("<link"), std::string::npos);
  EXPECT_EQ(page.find("url(http"), std::string::npos);
  EXPECT_TRUE(allMatches(page, "src=\"((?!data:)[^\"]*)\"").empty());
  const std::set<std::string> ids = allMatches(page, " id=\"([^\"]+)\"");
  const std::set<std::string> targets = allMatches(page, "href=\"#([^\"]+)\"");
  EXPECT_GE(targets.size(), 6U);
  for (const std::string& target : targets) EXPECT_TRUE(ids.contains(target)) << target;
  EXPECT_EQ(page.find("{{"), std::string::npos) << "a template tag was left";
}

TEST_F(Report, IdsAreUniqueOverAllFiguresOfThePage) {
  const ReportFiles files =
      writeReport(walkerReport({"slow"}, 1, 3.0), m_folder, m_progress, m_small);
  const std::string page = pageText(files.html);
  std::multiset<std::string> ids;
  const std::regex regex(" id=\"([^\"]+)\"");
  for (std::sregex_iterator it(page.begin(), page.end(), regex), end; it != end; ++it)
    ids.insert((*it)[1]);
  for (const std::string& id : ids) EXPECT_EQ(ids.count(id), 1U) << id;
}

TEST_F(Report, EveryFigureAndTableCarriesTheRecipe) {
  const ReportData data = walkerReport({"slow"}, 1, 3.0);
  const ReportFiles files = writeReport(data, m_folder, m_progress, m_small);
  const std::string hash = "0f5e9c2d7b1a4c3e8d6f0a1b2c3d4e5f";
  for (const fs::path& file : files.figures) {
    const std::string bytes = readFile(file);
    const std::string recipe =
        file.extension() == ".png" ? render::pngRecipe(bytes, file.string()) : bytes;
    EXPECT_NE(recipe.find(hash), std::string::npos) << file;
  }
  for (const fs::path& file : files.tables) {
    if (file.extension() != ".json") continue;
    EXPECT_EQ(readJson(file)["recipe"]["experiment"], hash) << file;
  }
  EXPECT_NE(pageText(files.html).find(hash), std::string::npos);
}

TEST_F(Report, TheSameDataGiveTheSamePage) {
  const ReportData data = walkerReport({"slow"}, 1, 2.0);
  const std::string first = readFile(writeReport(data, m_folder, m_progress, m_small).html);
  EXPECT_EQ(first, readFile(writeReport(data, m_folder, m_progress, m_small).html));
}

TEST_F(Report, TextOfTheDataIsEscaped) {
  ReportData data;
  data.title = "a <b> & \"c\"";
  data.notes = {{"n", "x < y"}};
  const std::string page = pageText(writeReport(data, m_folder, m_progress, m_small).html);
  EXPECT_EQ(page.find("a <b>"), std::string::npos);
  EXPECT_NE(page.find("a &lt;b&gt; &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_NE(page.find("x &lt; y"), std::string::npos);
}

TEST_F(Report, ACancelledReportLeavesNoFolder) {
  std::stop_source stop;
  stop.request_stop();
  Progress progress({}, stop.get_token());
  EXPECT_THROW(writeReport(walkerReport({"slow"}, 1, 2.0), m_folder, progress, m_small),
               CancelledError);
  EXPECT_FALSE(fs::exists(m_folder));
}

TEST_F(Report, AFigureThatCannotBeDrawnLeavesTheOldReport) {
  ReportData data = walkerReport({"slow"}, 1, 2.0);
  const std::string before = readFile(writeReport(data, m_folder, m_progress, m_small).html);
  data.title = "another";
  data.footsteps[0].curves[0].count.pop_back();
  EXPECT_THROW(writeReport(data, m_folder, m_progress, m_small), InputError);
  EXPECT_EQ(before, readFile(m_folder / "report.html"));
}

TEST_F(Report, WithoutThePdfProgramThereIsANoteThatNamesIt) {
  fs::create_directories(m_folder);
  writeFileAtomically(m_folder / "p.html", "<p>x</p>");
  const PdfResult result =
      writePdf(m_folder / "p.html", m_folder / "p.pdf", 5.0, "no-such-weasyprint");
  EXPECT_FALSE(result.written);
  EXPECT_NE(result.note.find("no-such-weasyprint is not installed"), std::string::npos)
      << result.note;
  EXPECT_FALSE(fs::exists(m_folder / "p.pdf"));
}

TEST_F(Report, APdfProgramThatFailsOrHangsIsReported) {
  fs::create_directories(m_folder);
  const auto script = [&](const std::string& name, const std::string& body) {
    writeFileAtomically(m_folder / name, "#!/bin/sh\n" + body + "\n");
    fs::permissions(m_folder / name, fs::perms::owner_all);
    return (m_folder / name).string();
  };
  const PdfResult failed = writePdf("in.html", m_folder / "p.pdf", 5.0, script("fails", "exit 3"));
  EXPECT_NE(failed.note.find("status 3"), std::string::npos) << failed.note;
  const PdfResult hung =
      writePdf("in.html", m_folder / "p.pdf", 0.3, script("hangs", "exec sleep 30"));
  EXPECT_NE(hung.note.find("longer than 0.3 s"), std::string::npos) << hung.note;
}

TEST_F(Report, APdfIsWrittenWhereWeasyprintIsInstalled) {
  if (std::system("command -v weasyprint >/dev/null 2>&1") != 0) {
    if (std::getenv("CI") != nullptr) FAIL() << "weasyprint is not installed";
    GTEST_SKIP() << "weasyprint is not installed";
  }
  m_small.pdf = true;
  ReportData data = walkerReport({"slow"}, 1, 2.0);
  data.distributions.clear();
  const ReportFiles files = writeReport(data, m_folder, m_progress, m_small);
  EXPECT_EQ(files.pdfNote, "");
  EXPECT_EQ(readFile(files.pdf).substr(0, 5), "%PDF-");
}

TEST(Figures, AFewFramesOfNoLikelihoodDoNotHideTheOthers) {
  ReportData data;
  data.systems = {{"s", 0}};
  std::vector<double> nats(100, 40.0);
  for (size_t t = 0; t < nats.size(); ++t) nats[t] += t % 2 == 0 ? 5.0 : -5.0;
  nats[70] = -40000.0;
  data.likelihoods = {{"p", "nats per frame, cm", 20.0, {{0, {nats}}}, {}}};
  const auto cut = figuresOf(data);
  ASSERT_TRUE(cut[0].chart->charts[0].y.range);
  EXPECT_GT(cut[0].chart->charts[0].y.range->first, 0.0);
  EXPECT_LT(cut[0].chart->charts[0].y.range->first, 35.0);
  EXPECT_GT(cut[0].chart->charts[0].y.range->second, 45.0);
  EXPECT_NE(cut[0].caption.find("cut: single frames go down to -40000"), std::string::npos);
  // A drop that can be drawn is drawn.
  data.likelihoods[0].groups[0].nats[0][70] = 28.0;
  EXPECT_FALSE(figuresOf(data)[0].chart->charts[0].y.range);
}

TEST(Figures, TheLikelihoodBandIsThe5To95PercentRangeOfTheRuns) {
  ReportData data;
  data.systems = {{"s", 0}};
  data.likelihoods = {{"p", "nats per frame, cm", 20.0, {{0, {{3}, {1}, {2}, {10}}}}, 39.9}};
  const auto figures = figuresOf(data);
  ASSERT_EQ(figures.size(), 1U);
  const auto& series = figures[0].chart->charts[0].series;
  ASSERT_EQ(series.size(), 3U);
  // numpy.percentile([3, 1, 2, 10], [5, 50, 95])
  EXPECT_NEAR(series[0].low[0], 1.15, 1e-12);
  EXPECT_NEAR(series[0].high[0], 8.95, 1e-12);
  EXPECT_NEAR(series[1].y[0], 2.5, 1e-12);
  EXPECT_EQ(series[2].y[0], 39.9);
  EXPECT_EQ(series[2].name, "linear-Gaussian");
}

TEST(Figures, NaturalMotionIsNearBlackAndSolidSamplesAreSeeThrough) {
  const ReportData data = walkerReport({"slow"}, 3, 1.0);
  const Figure figure = sceneFigure(data, data.scenes[0], 1);
  ASSERT_EQ(figure.scene->motions.size(), 7U);
  EXPECT_EQ(figure.scene->motions[0].colour, render::naturalColour());
  EXPECT_EQ(figure.scene->motions[0].opacity, 1.0);
  for (size_t i = 1; i < 7; ++i) {
    EXPECT_LT(figure.scene->motions[i].opacity, 0.7);
    EXPECT_NE(figure.scene->motions[i].colour, render::naturalColour());
  }
}

}  // namespace
}  // namespace marey::report
