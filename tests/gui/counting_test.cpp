// What is shown and what is counted are two things, one odd file stops nothing, and charts can be
// read where the window opens.
#include <QComboBox>
#include <QHeaderView>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QTableWidget>
#include <QTest>
#include <QTreeView>
#include <fstream>

#include "gui/gui_support.h"
#include "gui/plots/chart_view.h"
#include "gui/training/loss_chart.h"

namespace marey::gui {
namespace {

namespace fs = std::filesystem;

class Counting : public DemoTest {
 protected:
  bool idle() {
    settle(300);
    return waitUntil([this] { return m_jobs->idle(); });
  }
  void sample() {
    m_workspace->sampling().sampleCurrentPath();
    ASSERT_TRUE(idle());
  }
  /// Every cell of the Statistics table, computed anew.
  QStringList statistics() {
    QWidget* panel = m_window->showPanel("statistics");
    settle();
    child<QPushButton>(*panel, "statisticsCompute")->click();
    EXPECT_TRUE(idle());
    QStringList out;
    const auto* table = child<QTableWidget>(*panel, "statisticsTable");
    for (int row = 0; row < table->rowCount(); ++row)
      for (int column = 0; column < table->columnCount(); ++column)
        out << (table->item(row, column) ? table->item(row, column)->text() : QString());
    return out;
  }
  QString counted(const char* panel) {
    return child<QLabel>(*m_window, (std::string(panel) + "Counted").c_str())->text();
  }
  const render::ChartGrid& shownChart(const char* panel) {
    m_window->showPanel(QString::fromLatin1(panel));
    EXPECT_TRUE(idle());
    settle(200);
    return child<ChartView>(*m_window, (std::string(panel) + "Chart").c_str())->grid();
  }
  /// A motion of another skeleton, as another model would sample it.
  Motion oddMotion() {
    Clip clip = *m_workspace->motions().groups().front().motions.front().clip;
    Skeleton body = *clip.skeleton;
    body.names.back() = "Tail";
    clip.skeleton = std::make_shared<const Skeleton>(body);
    return {std::make_shared<const Clip>(std::move(clip)), {}, true};
  }
};

TEST_F(Counting, HidingMotionsChangesNoNumber) {
  sample();
  const QStringList all = statistics();
  ASSERT_GT(all.size(), 20);
  const QString before = counted("statistics");
  EXPECT_TRUE(before.contains("Natural: 6 of 6")) << qPrintable(before);
  const int natural = m_workspace->motions().groups().front().id,
            samples = m_workspace->motions().groups().back().id;
  m_workspace->motions().setVisible(natural, false);
  m_workspace->motions().setVisible(MotionId{samples, 0}, false);
  EXPECT_EQ(statistics(), all);
  EXPECT_EQ(counted("statistics"), before);
  m_workspace->motions().setVisible(MotionId{natural, 2}, true);
  EXPECT_EQ(statistics(), all);
}

TEST_F(Counting, LeavingAClipOutIsAnEditOfTheDocument) {
  sample();
  const QStringList all = statistics();
  const int natural = m_workspace->motions().groups().front().id;
  const std::string name = m_workspace->motions().motion({natural, 1})->clip->name;
  auto* tree = child<QTreeView>(*m_window->showPanel("library"), "motionTree");
  const auto row = tree->model()->index(1, 4, tree->model()->index(0, 0));
  ASSERT_EQ(row.data(Qt::CheckStateRole), Qt::Checked);
  tree->model()->setData(row, Qt::Unchecked, Qt::CheckStateRole);
  EXPECT_EQ(m_workspace->document().experiment().naturalLeftOut, std::vector<std::string>{name});
  EXPECT_TRUE(m_workspace->motions().motion({natural, 1})->visible) << "it was hidden, too";
  EXPECT_NE(statistics(), all);
  EXPECT_TRUE(counted("statistics").contains("Natural: 5 of 6"));
  const fs::path file = fs::path(m_folder.path().toStdString()) / "x.json";
  m_workspace->save(QString::fromStdString(file));
  m_workspace->open(readExperiment(file), QString::fromStdString(file));
  ASSERT_TRUE(idle());
  EXPECT_FALSE(
      m_workspace->motions().motion({m_workspace->motions().groups().front().id, 1})->used);
  m_workspace->document().edit("All again", [](Experiment& e) { e.naturalLeftOut.clear(); });
  EXPECT_TRUE(m_workspace->motions().motion({m_workspace->motions().groups().front().id, 1})->used);
}

TEST_F(Counting, SamplesThatAreLeftOutComeBack) {
  sample();
  const QStringList all = statistics();
  const MotionId first{m_workspace->motions().groups().back().id, 0};
  m_workspace->setUsed({first}, false);
  EXPECT_NE(statistics(), all);
  m_workspace->setUsed({first}, true);
  EXPECT_EQ(statistics(), all);
}

TEST_F(Counting, OneOddFileIsNamedAndTheOthersGoOn) {
  const fs::path odd = fs::path(m_folder.path().toStdString()) / "odd.bvh";
  writeSmallBvh(odd);
  m_workspace->document().edit(
      "Add", [&](Experiment& e) { e.natural.insert(e.natural.begin(), odd.string()); });
  ASSERT_TRUE(idle());
  ASSERT_EQ(m_workspace->motions().groups().front().motions.size(), 7U);
  ASSERT_EQ(m_errors.size(), 1U) << "nobody was told";
  EXPECT_NE(m_errors.front().find("odd"), std::string::npos) << m_errors.front();
  EXPECT_GT(m_workspace->motions().skeleton()->jointCount(), 2) << "the odd one stands for all";
  const std::string system = m_workspace->document().experiment().systems.front().name;
  m_workspace->natural().score(system);
  ASSERT_TRUE(idle());
  const auto* scores = m_workspace->natural().scores(system);
  ASSERT_NE(scores, nullptr) << "one file ended scoring";
  size_t scored = 0;
  for (const ClipScore& score : *scores) scored += score.loglikNats.empty() ? 0 : 1;
  EXPECT_EQ(scored, 6U);
  EXPECT_GT(statistics().size(), 20);
  for (const char* panel : {"likelihood", "footsteps", "distributions", "diversity"}) {
    EXPECT_FALSE(shownChart(panel).charts.empty()) << panel;
    EXPECT_TRUE(counted(panel).contains("Natural: 6 of 7 (1 of another skeleton)"))
        << qPrintable(counted(panel));
  }
}

TEST_F(Counting, AModelOfAnotherSkeletonBlanksNoPanel) {
  sample();
  MotionGroup other{.name = "Dog", .system = "Dog", .colourIndex = 1};
  other.motions = {oddMotion(), oddMotion()};
  m_workspace->motions().add(std::move(other));
  EXPECT_GT(statistics().size(), 20);
  EXPECT_TRUE(counted("statistics").contains("Dog: not compared with natural motion"))
      << qPrintable(counted("statistics"));
  EXPECT_FALSE(shownChart("distributions").charts.empty());
  EXPECT_TRUE(counted("distributions").contains("Dog: another skeleton"))
      << qPrintable(counted("distributions"));
  EXPECT_FALSE(shownChart("footsteps").charts.empty());
  EXPECT_FALSE(shownChart("diversity").charts.empty());
}

TEST_F(Counting, DensitiesOfFourJointsStandOnTheirAxisWhereTheWindowOpens) {
  sample();
  QWidget* panel = m_window->showPanel("distributions");
  ASSERT_TRUE(idle());
  auto* joints = child<QListWidget>(*panel, "distributionsJoints");
  joints->clearSelection();
  for (const int joint : {0, 3, 7, 11}) joints->item(joint)->setSelected(true);
  auto* chart = child<ChartView>(*panel, "distributionsChart");
  for (const int view : {0, 1, 2}) {
    child<QComboBox>(*panel, "distributionsView")->setCurrentIndex(view);
    ASSERT_TRUE(idle());
    settle(200);
    ASSERT_EQ(chart->frames().size(), 4U) << view;
    for (const render::ChartFrame& frame : chart->frames()) {
      EXPECT_GE(frame.right - frame.left, 60.0) << view;
      EXPECT_GE(frame.bottom - frame.top, 40.0) << view << ": a plot turned upside down";
      EXPECT_LE(frame.bottom, chart->height());
    }
    if (view > 0) continue;  // names of rows and ticks leave no room beside each other
    EXPECT_GT(chart->frames()[1].left, chart->frames()[0].right) << view << ": one a row";
    EXPECT_LT(chart->height(), 300) << view;
  }
  EXPECT_FALSE(child<QTableWidget>(*panel, "distributionsTable")->isVisible());
  child<QComboBox>(*panel, "distributionsView")->setCurrentIndex(3);
  EXPECT_TRUE(child<QTableWidget>(*panel, "distributionsTable")->isVisible());
  EXPECT_FALSE(chart->isVisible());
}

TEST_F(Counting, TheHeaderOfTheMotionsIsReadableWhereTheWindowOpens) {
  const auto* header = child<QTreeView>(*m_window->showPanel("library"), "motionTree")->header();
  for (int column = 1; column < header->count(); ++column)
    if (!header->isSectionHidden(column)) {
      EXPECT_GE(header->sectionSize(column) - 8,
                header->fontMetrics().horizontalAdvance(
                    header->model()->headerData(column, Qt::Horizontal).toString()))
          << column;
    }
  EXPECT_GE(header->sectionSize(0), 100) << "nothing is left for names";
}

TEST_F(Counting, FilesOfAFolderThatAreNotReadAreNamedInMotions) {
  fs::create_directory(file("clips"));
  writeSmallBvh(file("clips/a.bvh"));
  std::ofstream(file("clips/broken.bvh")) << "HIERARCHY\nno\n";
  std::ofstream(file("clips/labels.npz")) << "no archive";
  QStringList news;
  QObject::connect(m_workspace.get(), &Workspace::noticed, m_window.get(),
                   [&](const QString& what) { news << what; });
  m_workspace->document().edit("Add", [&](Experiment& e) { e.natural = {file("clips").string()}; });
  ASSERT_TRUE(idle());
  EXPECT_TRUE(m_errors.empty()) << m_errors.front();
  ASSERT_EQ(m_workspace->motions().groups().front().motions.size(), 1U);
  EXPECT_TRUE(news.join(' ').contains("2 files not read")) << qPrintable(news.join(' '));
  const auto* tree = child<QTreeView>(*m_window->showPanel("library"), "motionTree");
  const QModelIndex row = tree->model()->index(0, 0);
  EXPECT_TRUE(row.data().toString().contains("see tip")) << qPrintable(row.data().toString());
  const QString tip = row.data(Qt::ToolTipRole).toString();
  EXPECT_TRUE(tip.contains("broken.bvh")) << qPrintable(tip);
  EXPECT_TRUE(tip.contains("labels.npz")) << qPrintable(tip);
}

TEST_F(Counting, TheLegendOfTheLossFitsItsWidth) {
  LossChart chart;
  for (const int width : {180, 240, 320, 600}) {
    chart.resize(width, 200);
    const auto words = chart.legend();
    ASSERT_EQ(words.size(), 4U);
    for (size_t i = 0; i < words.size(); ++i) {
      EXPECT_LE(words[i].place.right(), width) << width;
      EXPECT_LE(words[i].place.bottom(), chart.plot().top());
      for (size_t j = 0; j < i; ++j) EXPECT_FALSE(words[i].place.intersects(words[j].place));
    }
  }
}

}  // namespace
}  // namespace marey::gui
