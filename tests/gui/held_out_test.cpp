// Motions along held-out control in the window: the numbers of the report, and what is not drawn
// again.
#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QStatusBar>
#include <QTableWidget>
#include <QTest>
#include <cmath>

#include "families.h"
#include "gui/gui_support.h"

#include "experiment/run.h"
#include "report/experiment_report.h"

namespace marey::gui {
namespace {

class HeldOut : public DemoTest {
 protected:
  bool idle() {
    return waitUntil([this] { return m_jobs->idle(); }, 120.0);
  }
  /// As a person chooses it in a panel.
  void choose(const char* box, int index) {
    auto* combo = child<QComboBox>(*m_window, box);
    combo->setCurrentIndex(index);
    Q_EMIT combo->activated(index);
  }
  ExperimentResult asReported() {
    Progress progress;
    return runExperiment(m_workspace->document().experiment(), modelFamilies(), progress);
  }
};

double numberAt(const QTableWidget& table, int row, int column) {
  const QVariant value = table.item(row, column)->data(Qt::UserRole);
  return value.isValid() ? value.toDouble() : std::nan("");
}

int rowNamed(const QTableWidget& table, const std::string& name) {
  for (int row = 0; row < table.rowCount(); ++row)
    if (table.item(row, 0)->text().toStdString() == name) return row;
  return -1;
}

int columnNamed(const report::Table& table, const std::string& name) {
  for (size_t i = 0; i < table.columns.size(); ++i)
    if (table.columns[i].name == name) return static_cast<int>(i);
  return -1;
}

TEST_F(HeldOut, TheTableHasTheNumbersOfTheReport) {
  m_workspace->document().edit("Two", [](Experiment& e) { e.heldOutSamples = 2; });
  m_window->showPanel("statistics");
  choose("statisticsCompare", 1);
  ASSERT_TRUE(idle());
  ASSERT_EQ(m_workspace->motions().groups().size(), 2U);
  EXPECT_EQ(m_workspace->motions().groups().back().motions.size(), 12U);
  auto* compute = child<QPushButton>(*m_window, "statisticsCompute");
  ASSERT_TRUE(waitUntil([&] { return compute->isEnabled(); }, 5.0));
  compute->click();
  auto* shown = child<QTableWidget>(*m_window, "statisticsTable");
  ASSERT_TRUE(waitUntil([&] { return shown->rowCount() > 0 && m_jobs->idle(); }, 120.0));

  EXPECT_TRUE(child<QLabel>(*m_window, "statisticsInput")->text().contains("6 natural clips"));
  const ExperimentResult result = asReported();
  const auto& heldOut = result.systems.front().heldOut;
  for (size_t i = 0; i < heldOut.size(); ++i)
    EXPECT_EQ(m_workspace->motions().groups().back().motions[i].clip->positions,
              heldOut[i].positions)
        << i;
  Progress progress;
  const report::Table table = report::statisticTables(result, progress).front();
  EXPECT_EQ(shown->rowCount(), static_cast<int>(table.rows.size()));
  const int natural = columnNamed(table, "natural"), floor = columnNamed(table, "noise floor");
  size_t numbers = 0;
  for (const auto& cells : table.rows) {
    const int row = rowNamed(*shown, cells[0].text);
    ASSERT_GE(row, 0) << cells[0].text << " is not in the window";
    const std::pair<int, int> columns[] = {{2, 2}, {4, natural}, {6, floor}};
    for (const auto& [here, there] : columns) {
      const auto& expected = cells[static_cast<size_t>(there)].number;
      const double found = numberAt(*shown, row, here);
      EXPECT_EQ(std::isfinite(found), expected.has_value()) << cells[0].text;
      if (expected) {
        EXPECT_EQ(found, *expected) << cells[0].text << ", column " << there;
      }
      numbers += expected ? 1 : 0;
    }
    // The report writes intervals as text.
    const double low = numberAt(*shown, row, 3);
    const std::string text = std::isfinite(low) ? fmt::format("{:.3g} to ", low) : "-";
    EXPECT_TRUE(cells[3].text.starts_with(text)) << cells[0].text << ": " << cells[3].text;
  }
  EXPECT_GT(numbers, 30U);
}

TEST_F(HeldOut, FootstepsAreThoseOfTheReportAndThePathIsAnotherChoice) {
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  m_window->showPanel("footsteps");
  auto* shown = child<QTableWidget>(*m_window, "footstepsTable");
  constexpr int kSteps = 2, kV95 = 4;
  const auto cell = [&](const char* set, int column) {
    for (int row = 0; row < shown->rowCount(); ++row)
      if (shown->item(row, 0)->text().startsWith(QLatin1String(set)) &&
          shown->item(row, 1)->text() == "all")
        return numberAt(*shown, row, column);
    return std::nan("");
  };
  const std::string system = m_workspace->document().experiment().systems.front().name;
  ASSERT_TRUE(waitUntil([&] { return shown->rowCount() == 6 && m_jobs->idle(); }, 30.0));
  // Speeds may agree; as many steps along six clips as along one path would be chance.
  const double onPath = cell(system.c_str(), kSteps);
  choose("footstepsCompare", 1);
  ASSERT_TRUE(
      waitUntil([&] { return m_jobs->idle() && cell(system.c_str(), kSteps) != onPath; }, 120.0));
  const report::Table table = report::footstepTable(asReported());
  const auto column = static_cast<size_t>(columnNamed(table, "v95"));
  EXPECT_EQ(cell("Natural", kV95), table.rows[0][column].number);
  EXPECT_EQ(cell(system.c_str(), kV95), table.rows[1][column].number);
  choose("footstepsCompare", 0);
  EXPECT_TRUE(waitUntil([&] { return cell(system.c_str(), kSteps) == onPath; }, 30.0));
}

TEST_F(HeldOut, OneChoiceHoldsInEveryPanelAndSaysWhatIsMissing) {
  m_window->showPanel("distributions");
  m_workspace->sampling().setSampled(m_workspace->document().experiment().systems.front().name,
                                     true);
  m_workspace->view().setComparison(Comparison::HeldOut);
  settle();
  EXPECT_EQ(child<QComboBox>(*m_window, "distributionsCompare")->currentIndex(), 1);
  EXPECT_TRUE(child<QLabel>(*m_window, "distributionsHint")->text().contains("held-out"));
  auto* sample = child<QPushButton>(*m_window, "distributionsHeldOut");
  ASSERT_TRUE(sample->isEnabled());
  sample->click();
  ASSERT_TRUE(idle());
  EXPECT_FALSE(sample->isEnabled()) << "there is nothing to be sampled again";
  m_workspace->document().edit("Warmer",
                               [](Experiment& e) { e.systems.front().temperature = 0.5; });
  EXPECT_TRUE(sample->isEnabled());
  const auto* counted = child<QLabel>(*m_window, "distributionsCounted");
  EXPECT_TRUE(waitUntil([&] { return counted->text().contains("out of date"); }, 30.0));
}

TEST_F(HeldOut, GoesWithTheNaturalMotionThatItFollows) {
  m_workspace->sampling().sampleHeldOut();
  ASSERT_TRUE(idle());
  ASSERT_EQ(m_workspace->motions().groups().size(), 2U);
  m_workspace->document().edit("Others", [](Experiment& e) { e.natural = {"walker:2,4,7"}; });
  ASSERT_TRUE(idle());
  ASSERT_EQ(m_workspace->motions().groups().size(), 1U);
  EXPECT_EQ(m_workspace->sampling().withoutHeldOut().size(), 1U);
}

TEST_F(HeldOut, ComesBackWithTheDocumentOnceNaturalMotionIsRead) {
  m_workspace->view().setComparison(Comparison::HeldOut);
  m_workspace->sampling().sampleHeldOut();
  ASSERT_TRUE(idle());
  const MotionGroup drawn = m_workspace->motions().groups().back();
  const auto saved = std::filesystem::path(m_folder.path().toStdString()) / "x.json";
  m_workspace->save(QString::fromStdString(saved.string()));
  m_workspace->open(readExperiment(saved), QString::fromStdString(saved.string()));
  EXPECT_EQ(m_workspace->view().comparison(), Comparison::HeldOut);
  m_workspace->kept().sampleOffered();  // too early: there is nothing to follow yet
  EXPECT_EQ(m_workspace->kept().offered().size(), 1U);
  ASSERT_TRUE(idle());
  m_workspace->kept().sampleOffered();
  ASSERT_TRUE(idle());
  EXPECT_TRUE(m_workspace->kept().offered().empty());
  const MotionGroup& back = m_workspace->motions().groups().back();
  ASSERT_EQ(back.motions.size(), drawn.motions.size());
  for (size_t i = 0; i < back.motions.size(); ++i)
    EXPECT_EQ(back.motions[i].clip->positions, drawn.motions[i].clip->positions);
  EXPECT_TRUE(m_workspace->sampling().withoutHeldOut().empty());
}

TEST_F(HeldOut, WhatWouldComeOutTheSameIsNotSampledAgain) {
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  const int first = m_workspace->motions().groups().back().id;
  m_workspace->sampling().sampleCurrentPath();
  EXPECT_TRUE(m_jobs->idle());
  EXPECT_EQ(m_workspace->motions().groups().back().id, first);
  EXPECT_TRUE(m_window->statusBar()->currentMessage().contains("Unchanged"));
  m_workspace->document().edit("Seed", [](Experiment& e) { e.seed += 1; });
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  EXPECT_NE(m_workspace->motions().groups().back().id, first);
}

}  // namespace
}  // namespace marey::gui
