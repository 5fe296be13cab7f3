// The window itself: commands, history, documents that are never lost, work beside the event loop.
#include <QAction>
#include <QApplication>
#include <QDir>
#include <QLineEdit>
#include <QListWidget>
#include <QMessageBox>
#include <QProcess>
#include <QStandardPaths>
#include <QTest>
#include <QTimer>
#include <ctime>
#include <fstream>

#include "gui/gui_support.h"
#include "shell/command_palette.h"

#include "base/error.h"

namespace marey::gui {
namespace {

namespace fs = std::filesystem;

class Shell : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    openWindow();
    openSmallDemo();
  }
  fs::path file(const char* name) const { return fs::path(m_folder.path().toStdString()) / name; }
};

TEST_F(Shell, UndoAndRedoFollowTheHistoryAndNameTheEdit) {
  m_workspace->edit("Seed", [](Experiment& e) { e.seed = 7; });
  m_workspace->edit("Samples", [](Experiment& e) { e.samples = 9; });
  EXPECT_EQ(m_window->command("undo")->text(), "Undo Samples");
  m_window->command("undo")->trigger();
  EXPECT_EQ(m_workspace->experiment().samples, 2);
  EXPECT_EQ(m_workspace->experiment().seed, 7U);
  EXPECT_EQ(m_window->command("redo")->text(), "Redo Samples");
  m_window->command("redo")->trigger();
  EXPECT_EQ(m_workspace->experiment().samples, 9);
  auto* list = child<QListWidget>(*m_window->showPanel("history"), "historyList");
  ASSERT_EQ(list->count(), 3);
  list->setCurrentRow(0);
  EXPECT_EQ(m_workspace->experiment().seed, 1U);
  EXPECT_FALSE(m_window->command("undo")->isEnabled());
}

TEST_F(Shell, ADragIsOneEdit) {
  const size_t before = m_workspace->history().size();
  for (uint64_t seed = 10; seed < 20; ++seed)
    m_workspace->edit(
        "Seed", [=](Experiment& e) { e.seed = seed; }, true);
  EXPECT_EQ(m_workspace->history().size(), before + 1);
  m_workspace->undo();
  EXPECT_EQ(m_workspace->experiment().seed, 1U);
}

TEST_F(Shell, SavesWhatTheCommandLineReads) {
  const fs::path saved = file("saved.json");
  m_workspace->edit("Seed", [](Experiment& e) { e.seed = 42; });
  EXPECT_TRUE(m_workspace->modified());
  m_workspace->save(QString::fromStdString(saved));
  EXPECT_FALSE(m_workspace->modified());
  const Experiment read = readExperiment(saved);
  EXPECT_EQ(read.seed, 42U);
  EXPECT_TRUE(fs::exists(read.folder / read.systems.front().model))
      << "the model's name does not hold from the new folder";
}

TEST_F(Shell, AFolderThatCannotBeWrittenLosesNothing) {
  m_workspace->edit("Seed", [](Experiment& e) { e.seed = 42; });
  const Experiment before = m_workspace->experiment();
  EXPECT_THROW(m_workspace->save("/proc/no/such/folder/x.json"), FileError);
  EXPECT_EQ(m_workspace->experiment(), before);
  EXPECT_TRUE(m_workspace->modified());
}

TEST_F(Shell, AFileThatIsNoExperimentLeavesTheDocument) {
  std::ofstream(file("broken.json")) << "{ \"natural\": 3 }";
  m_window->openFiles({QString::fromStdString(file("broken.json"))});
  ASSERT_EQ(m_errors.size(), 0U);
  auto* box = m_window->findChild<QMessageBox*>("errorBox");
  ASSERT_NE(box, nullptr);
  EXPECT_TRUE(box->informativeText().contains("broken.json")) << qPrintable(box->informativeText());
  EXPECT_EQ(m_workspace->experiment().systems.size(), 1U);
  EXPECT_EQ(m_workspace->groups().size(), 1U);
}

TEST_F(Shell, AModelThatVanishedIsNamedAndTheWindowLives) {
  m_workspace->edit("Model", [](Experiment& e) { e.systems[0].model = "gone.marey"; });
  m_workspace->sampleCurrentPath();
  ASSERT_TRUE(waitUntil([this] { return !m_errors.empty(); }));
  EXPECT_NE(m_errors.front().find("gone.marey"), std::string::npos) << m_errors.front();
  EXPECT_EQ(m_workspace->groups().size(), 1U) << "an empty sample set was left";
  m_workspace->undo();
  m_workspace->sampleCurrentPath();
  EXPECT_TRUE(waitUntil([this] {
    return m_workspace->groups().size() == 2 && m_workspace->groups().back().complete;
  }));
}

TEST_F(Shell, UnsavedWorkSurvivesACrash) {
  m_workspace->edit("Seed", [](Experiment& e) { e.seed = 4711; });
  const QDir folder(QStandardPaths::writableLocation(QStandardPaths::AppLocalDataLocation) +
                    "/autosave");
  ASSERT_TRUE(waitUntil([&] { return !folder.entryList({"*.json"}).isEmpty(); }, 10.0));
  EXPECT_TRUE(Autosave::recover().empty()) << "the copy of a window that is alive was taken";
  // A crash leaves the copy and a lock whose process is gone.
  const QString copy = folder.entryList({"*.json"}).front();
  QFile::copy(folder.filePath(copy), folder.filePath("crashed.json"));
  const auto recovered = Autosave::recover();
  ASSERT_EQ(recovered.size(), 1U);
  EXPECT_EQ(recovered.front().experiment.seed, 4711U);
  EXPECT_EQ(recovered.front().experiment.folder, m_workspace->experiment().folder);
  EXPECT_TRUE(Autosave::recover().empty()) << "it was given twice";
}

TEST_F(Shell, SavingRemovesTheCopy) {
  m_workspace->edit("Seed", [](Experiment& e) { e.seed = 4711; });
  const QDir folder(QStandardPaths::writableLocation(QStandardPaths::AppLocalDataLocation) +
                    "/autosave");
  ASSERT_TRUE(waitUntil([&] { return !folder.entryList({"*.json"}).isEmpty(); }, 10.0));
  m_workspace->save(QString::fromStdString(file("saved.json")));
  EXPECT_TRUE(folder.entryList({"*.json"}).isEmpty());
}

TEST_F(Shell, ClosingDuringAJobEndsIt) {
  m_workspace->edit("More", [](Experiment& e) { e.samples = 100000; });
  m_workspace->save(QString::fromStdString(file("saved.json")));
  m_workspace->sampleCurrentPath();
  ASSERT_TRUE(waitUntil([this] { return !m_workspace->groups().back().motions.empty(); }));
  EXPECT_TRUE(m_window->close());
  EXPECT_TRUE(waitUntil([this] { return m_jobs->idle(); }, 20.0));
}

TEST_F(Shell, ThePaletteFindsACommandByItsLettersAndRunsIt) {
  EXPECT_GT(matchScore("Write the report", "wrep"), matchScore("Wear the tarp", "wrep"));
  EXPECT_LT(matchScore("Save", "xyz"), 0);
  const Theme before = m_window->theme();
  m_window->command("palette")->trigger();
  auto* palette = child<CommandPalette>(*m_window, "commandPalette");
  QTest::keyClicks(child<QLineEdit>(*palette, "commandQuery"), "light or dark");
  QTest::keyClick(child<QLineEdit>(*palette, "commandQuery"), Qt::Key_Return);
  settle();
  EXPECT_NE(m_window->theme(), before);
}

TEST_F(Shell, EveryKeyIsGivenOnce) {
  std::map<QString, QString> owners;
  for (const QAction* action : m_window->commands()) {
    const QString keys = action->shortcut().toString();
    if (keys.isEmpty()) continue;
    EXPECT_TRUE(owners.emplace(keys, action->objectName()).second)
        << keys.toStdString() << " is given twice";
  }
  EXPECT_GT(owners.size(), 10U);
}

TEST_F(Shell, TheLayoutIsKeptAndCanBeReset) {
  m_window->showPanel("history");
  m_window->close();
  openWindow();
  EXPECT_TRUE(m_window->showPanel("history")->isVisible());
  m_window->command("resetLayout")->trigger();
  settle();
  EXPECT_TRUE(m_window->showPanel("library")->isVisible());
}

double threadCpuMs() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// The longest time that the GUI thread computed without coming back to the event loop; its own
/// processor time, since other programs may be using the machine.
double longestStallMs(const std::function<bool()>& until) {
  QTimer watchdog;
  double last = threadCpuMs(), longest = 0.0;
  QObject::connect(&watchdog, &QTimer::timeout, [&] {
    const double now = threadCpuMs();
    longest = std::max(longest, now - last);
    last = now;
  });
  watchdog.start(1);
  EXPECT_TRUE(waitUntil(until, 120.0));
  return longest;
}

TEST_F(Shell, AThousandClipsDoNotHoldTheWindowUp) {
  m_workspace->edit("A thousand", [](Experiment& e) { e.natural = {"walker:1000,4,1"}; });
  const double stall = longestStallMs([this] { return m_jobs->idle(); });
  EXPECT_EQ(m_workspace->groups().front().motions.size(), 1000U);
  EXPECT_LT(stall, 100.0);
  RecordProperty("stall_ms", static_cast<int>(stall));
}

}  // namespace
}  // namespace marey::gui
