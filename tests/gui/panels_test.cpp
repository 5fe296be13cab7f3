// Every registered panel in a window: empty, with motions whose numbers are known by hand, and
// while work goes on. What is asked for is read from what the user sees.
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QSpinBox>
#include <QTableWidget>
#include <QTreeView>
#include <algorithm>
#include <map>

#include "gui/gui_support.h"

#include "base/atomic_file.h"

namespace marey::gui {
namespace {

/// Natural motion of six clips of 4 s, and "Frozen": two motions that stand in one pose for 2 s.
class EveryPanel : public WindowTest {
 protected:
  QWidget& open(const char* id) {
    QWidget* panel = m_window->showPanel(id);
    if (panel == nullptr) throw std::runtime_error(std::string("no panel '") + id + "'");
    EXPECT_TRUE(waitUntil([&] { return panel->isVisible(); }, 5.0)) << id;
    return *panel;
  }
  /// Waits until a label of a panel says it; `name` is its object name.
  void expectSaid(const char* id, const std::string& name, const QString& words) {
    auto* label = child<QLabel>(open(id), name.c_str());
    EXPECT_TRUE(
        waitUntil([&] { return label->isVisible() && label->text().contains(words); }, 15.0))
        << id << " says \"" << qPrintable(label->text()) << "\", not \"" << qPrintable(words)
        << "\"";
  }
  static QStringList rowOf(const QTableWidget& table, int row) {
    QStringList out;
    for (int column = 0; column < table.columnCount(); ++column)
      out << (table.item(row, column) ? table.item(row, column)->text() : QString());
    return out;
  }
  /// Rows of a table that have a text in a column, once there is one.
  std::vector<QStringList> rowsOf(const char* id, const char* table, int column,
                                  const QString& text) {
    auto* found = child<QTableWidget>(open(id), table);
    std::vector<QStringList> out;
    waitUntil(
        [&] {
          out.clear();
          for (int row = 0; row < found->rowCount(); ++row)
            if (rowOf(*found, row)[column] == text) out.push_back(rowOf(*found, row));
          return !out.empty();
        },
        15.0);
    EXPECT_FALSE(out.empty()) << id << " has no row of " << qPrintable(text);
    return out;
  }
  void openMotions() {
    openWindow();
    openSmallDemo();
    m_workspace->sampling().sampleCurrentPath();
    ASSERT_TRUE(idle());
    Clip still = *m_workspace->motions().groups().front().motions.front().clip;
    still = sliceFrames(still, 0, 40);
    still.transforms.reset();
    still.fps = 20.0;
    for (int frame = 1; frame < 40; ++frame)
      std::copy_n(still.positions.begin(), still.jointCount(),
                  still.positions.begin() + std::ptrdiff_t{frame} * still.jointCount());
    const auto clip = std::make_shared<const Clip>(std::move(still));
    MotionGroup frozen{.name = "Frozen", .system = "Frozen", .colourIndex = 1};
    frozen.motions = {{clip, {}, true}, {clip, {}, true}};
    m_workspace->motions().add(std::move(frozen));
    ASSERT_TRUE(idle());
  }
};

TEST_F(EveryPanel, SaysWhatToDoWhereThereIsNothing) {
  openWindow();
  const std::map<const char*, const char*> hints{
      {"likelihood", "No log-likelihoods yet"},
      {"footsteps", "No motion is used: open natural clips or sample a path to count footsteps."},
      {"distributions", "No motion is used: open natural clips or sample a path to see how its"},
      {"diversity", "Diversity compares pairs: use at least two motions of a group"},
      {"statistics", "No motion is used: open natural clips or sample a path first."}};
  for (const auto& [id, words] : hints) expectSaid(id, std::string(id) + "Hint", words);
  expectSaid("timeline", "timelineLabel", "0.00 of 0.00 s");
  EXPECT_EQ(child<QTreeView>(open("library"), "motionTree")->model()->rowCount(), 0);
  const auto* history = child<QListWidget>(open("history"), "historyList");
  ASSERT_EQ(history->count(), 1);
  EXPECT_EQ(history->item(0)->text(), "Start");
  EXPECT_EQ(child<QTableWidget>(open("sampling"), "systemTable")->rowCount(), 0);
  EXPECT_EQ(child<QComboBox>(open("path"), "pathChoice")->count(), 0);
  EXPECT_FALSE(child<QPushButton>(open("live"), "liveStart")->isEnabled());
  EXPECT_EQ(child<QTableWidget>(open("checkpoints"), "checkpointTable")->rowCount(), 0);
  EXPECT_TRUE(m_errors.empty()) << m_errors.front();
}

/// Where a picture is vermilion, the colour of the second system: a rectangle around it.
QRect vermilionIn(const render::Image& image, const QRect& within) {
  QRect out;
  for (int y = within.top(); y <= within.bottom(); ++y)
    for (int x = within.left(); x <= within.right(); ++x) {
      const auto* p = image.at(x, y);
      if (p[0] > p[1] + 60 && p[0] > p[2] + 100) out |= QRect(x, y, 1, 1);
    }
  return out;
}

TEST_F(EveryPanel, SceneShowsABodyThatGoesWhenItIsHidden) {
  openMotions();
  QWidget& view = *child<QWidget>(open("scene"), "sceneView");
  const int frozen = m_workspace->motions().groups().back().id;
  m_workspace->motions().showOnly({{frozen, 0}});
  settle(500);
  const render::Image with = pictureOf(view);
  m_workspace->motions().showOnly({});
  settle(500);
  const render::Image without = pictureOf(view);
  // The legend, which goes too, is above.
  const QRect below(0, with.height / 4, with.width, with.height - with.height / 4);
  const QRect body = vermilionIn(with, below);
  EXPECT_GT(body.height(), with.height / 8) << "nothing of the height of a body";
  EXPECT_LT(body.width(), with.width / 2) << "one body is not as wide as the view";
  EXPECT_TRUE(vermilionIn(without, below).isNull());
}

TEST_F(EveryPanel, LibraryListsEveryMotionOfEverySet) {
  openMotions();
  const QAbstractItemModel& tree = *child<QTreeView>(open("library"), "motionTree")->model();
  ASSERT_EQ(tree.rowCount(), 4);
  const std::pair<const char*, int> sets[] = {
      {"Natural", 6}, {"MG+ – still", 2}, {"Frozen", 2}, {"Models", 1}};
  for (int row = 0; row < 4; ++row) {
    const QModelIndex at = tree.index(row, 0);
    EXPECT_TRUE(at.data().toString().startsWith(QString::fromUtf8(sets[row].first)))
        << qPrintable(at.data().toString());
    EXPECT_EQ(tree.rowCount(at), sets[row].second) << row;
  }
}

TEST_F(EveryPanel, HistoryListsTheEditsByTheirNames) {
  openMotions();
  m_workspace->document().edit("Another seed", [](Experiment& e) { e.seed = 77; });
  m_workspace->document().edit("Three samples", [](Experiment& e) { e.samples = 3; });
  m_workspace->document().undo();
  const auto* list = child<QListWidget>(open("history"), "historyList");
  ASSERT_EQ(list->count(), 3);
  EXPECT_EQ(list->item(1)->text(), "Another seed");
  EXPECT_EQ(list->item(2)->text(), "Three samples");
  EXPECT_EQ(list->currentRow(), 1) << "what was undone is not what is shown";
}

TEST_F(EveryPanel, SamplingShowsTheDocumentsSettings) {
  openMotions();
  m_workspace->document().edit("Settings", [](Experiment& e) {
    e.seed = 4711;
    e.samples = 9;
  });
  QWidget& panel = open("sampling");
  EXPECT_EQ(child<QSpinBox>(panel, "sampleCount")->value(), 9);
  EXPECT_EQ(child<QLineEdit>(panel, "sampleSeed")->text(), "4711");
  EXPECT_EQ(child<QComboBox>(panel, "samplePath")->currentText(), "still");
  const auto* systems = child<QTableWidget>(panel, "systemTable");
  ASSERT_EQ(systems->rowCount(), 1);
  EXPECT_TRUE(rowOf(*systems, 0).contains("MG+")) << qPrintable(rowOf(*systems, 0).join('|'));
  EXPECT_EQ(child<QDoubleSpinBox>(panel, "temperature0")->value(), 0.8);
}

TEST_F(EveryPanel, PathListsThePathsAndShowsTheCurrentOne) {
  openMotions();
  m_workspace->document().setCurrentPath(1);
  QWidget& panel = open("path");
  const auto* choice = child<QComboBox>(panel, "pathChoice");
  ASSERT_EQ(choice->count(), 3);
  EXPECT_EQ(choice->itemText(0), "still");
  EXPECT_EQ(choice->itemText(2), "figure eight");
  EXPECT_EQ(choice->currentText(), "turn left");
  EXPECT_EQ(child<QDoubleSpinBox>(panel, "pathSeconds")->value(), 2.0);
}

TEST_F(EveryPanel, LiveOffersTheModels) {
  openMotions();
  QWidget& panel = open("live");
  const auto* models = child<QComboBox>(panel, "liveModels");
  EXPECT_GE(models->findText("MG+"), 0);
  EXPECT_TRUE(child<QPushButton>(panel, "liveStart")->isEnabled());
}

TEST_F(EveryPanel, CheckpointsListTheLossesOfTheLog) {
  openMotions();
  const auto run = file("run");
  std::filesystem::create_directories(run);
  writeFileAtomically(run / "log.csv",
                      "step,seconds,learning_rate,train_bits_per_frame,valid_bits_per_frame,"
                      "test_bits_per_frame,gradient_norm,skipped\n"
                      "100,60.0,0.001,-10,-12,nan,5,0\n200,120.0,0.001,-20,-30,-25,5,0\n"
                      "300,180.0,0.001,-22,-28,-25,5,0\n");
  for (const char* name : {"best.marey", "last.marey"}) writeFileAtomically(run / name, "x");
  QWidget& panel = open("checkpoints");
  auto* folder = child<QLineEdit>(panel, "checkpointFolder");
  folder->setText(QString::fromStdString(run.string()));
  Q_EMIT folder->editingFinished();
  const auto* table = child<QTableWidget>(panel, "checkpointTable");
  ASSERT_EQ(table->rowCount(), 2);
  EXPECT_EQ(rowOf(*table, 0), (QStringList{"best (step 200)", "2.0", "-20.0", "-30.0"}));
  EXPECT_EQ(rowOf(*table, 1), (QStringList{"last (step 300)", "3.0", "-22.0", "-28.0"}));
}

TEST_F(EveryPanel, LikelihoodIsTheMeanOfTheSamplesOwnScores) {
  openMotions();
  double sum = 0.0;
  size_t frames = 0;
  for (const Motion& motion : m_workspace->motions().groups()[1].motions)
    for (const double nats : motion.score->loglikNats) {
      sum += nats;
      ++frames;
    }
  ASSERT_GT(frames, 0U);
  const auto rows = rowsOf("likelihood", "likelihoodTable", 0, "MG+ – still, temperature 0.8");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0][2], QString::number(sum / static_cast<double>(frames), 'f', 1))
      << qPrintable(rows[0].join('|'));
}

TEST_F(EveryPanel, FootstepsOfABodyThatStandsAreOneForEveryFoot) {
  openMotions();
  const auto rows = rowsOf("footsteps", "footstepsTable", 0, "Frozen");
  ASSERT_EQ(rows.size(), 3U) << "all feet, and each of two";
  for (const QStringList& row : rows) {
    // Two motions; 39 displacements at 20 fps, none of them faster than any tolerance.
    EXPECT_EQ(row[2], row[1] == "all" ? "4" : "2") << qPrintable(row.join('|'));
    EXPECT_EQ(row[4], "1.0");
    EXPECT_EQ(row[5], "1.95 ± 0.00");
  }
}

TEST_F(EveryPanel, DistributionsOfABodyThatStandsHaveNoWidth) {
  openMotions();
  const auto rows = rowsOf("distributions", "distributionsTable", 1, "Frozen");
  ASSERT_FALSE(rows.empty());
  for (const QStringList& row : rows)
    EXPECT_TRUE(row[3] == "0.00" || row[3] == "-0.00") << qPrintable(row.join('|'));
}

TEST_F(EveryPanel, DiversityOfMotionsThatAreAlikeIsNone) {
  openMotions();
  expectSaid("diversity", "diversityMeans", "Frozen 0.0 cm (2 motions, all the same");
  expectSaid("diversity", "diversityMeans", "Natural ");
}

TEST_F(EveryPanel, StatisticsOfABodyThatStandsAreThoseOfOne) {
  openMotions();
  QWidget& panel = open("statistics");
  child<QPushButton>(panel, "statisticsCompute")->click();
  const auto* table = child<QTableWidget>(panel, "statisticsTable");
  ASSERT_TRUE(waitUntil([&] { return table->rowCount() > 0; }));
  int column = -1;
  for (int c = 0; c < table->columnCount(); ++c)
    if (table->horizontalHeaderItem(c)->text() == "Frozen") column = c;
  ASSERT_GE(column, 0);
  std::map<QString, QString> values;
  for (int row = 0; row < table->rowCount(); ++row)
    values[table->item(row, 0)->text()] = table->item(row, column)->text();
  std::string all;
  for (const auto& [name, value] : values) all += (name + "=" + value + "\n").toStdString();
  EXPECT_EQ(values["diversity"], "0") << all;
}

TEST_F(EveryPanel, TimelineIsAsLongAsTheLongestMotion) {
  openMotions();
  m_workspace->motions().showOnly({{m_workspace->motions().groups().back().id, 0}});
  // 40 frames at 20 fps: the last one is at 39 / 20 s.
  expectSaid("timeline", "timelineLabel", "0.00 of 1.95 s");
  m_workspace->view().setTime(0.5);
  expectSaid("timeline", "timelineLabel", "0.50 of 1.95 s");
  EXPECT_EQ(child<QSpinBox>(open("timeline"), "timelineFrame")->value(), 10);
}

TEST_F(EveryPanel, GoesOnInTheMiddleOfAJob) {
  openWindow();
  openSmallDemo();
  m_workspace->document().edit("More", [](Experiment& e) { e.samples = 4000; });
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(
      waitUntil([this] { return m_workspace->motions().groups().back().motions.size() > 0; }));
  const QAbstractItemModel& tree = *child<QTreeView>(open("library"), "motionTree")->model();
  ASSERT_EQ(tree.rowCount(), 3) << "natural motion, the set, the models";
  EXPECT_EQ(tree.rowCount(tree.index(0, 0)), 6);
  EXPECT_GT(tree.rowCount(tree.index(1, 0)), 0);
  EXPECT_TRUE(child<QPushButton>(open("sampling"), "sampleCancel")->isEnabled());
  for (const char* id : {"footsteps", "distributions", "diversity", "statistics"})
    expectSaid(id, std::string(id) + "Counted", "Natural: 6 of 6");
  expectSaid("timeline", "timelineLabel", " of 3.95 s");
  for (const PanelSpec& spec : panels()) EXPECT_NE(m_window->showPanel(spec.id), nullptr);
  EXPECT_FALSE(m_jobs->idle());
  m_jobs->cancelAll();
  EXPECT_TRUE(waitUntil([this] { return m_jobs->idle(); }, 20.0));
  EXPECT_TRUE(m_errors.empty()) << m_errors.front();
}

TEST(PanelList, IsTheOneThatIsTestedHere) {
  std::vector<QString> ids;
  std::set<QString> titles;
  for (const PanelSpec& spec : panels()) {
    ids.push_back(spec.id);
    EXPECT_TRUE(titles.insert(spec.title).second) << spec.title.toStdString();
  }
  EXPECT_EQ(ids, (std::vector<QString>{"scene", "library", "history", "sampling", "path", "live",
                                       "checkpoints", "likelihood", "footsteps", "distributions",
                                       "diversity", "statistics", "timeline"}));
}

}  // namespace
}  // namespace marey::gui
