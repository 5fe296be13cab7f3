// The window itself: commands, history, documents that are never lost, work beside the event loop.
#include <QAction>
#include <QApplication>
#include <QLineEdit>
#include <QListWidget>
#include <QMessageBox>
#include <QTest>
#include <QTimer>
#include <ctime>
#include <fstream>

#include "gui/gui_support.h"
#include "gui/shell/application.h"
#include "gui/shell/command_palette.h"

#include "base/error.h"

namespace marey::gui {
namespace {

namespace fs = std::filesystem;

class Shell : public DemoTest {};

TEST_F(Shell, UndoAndRedoFollowTheHistoryAndNameTheEdit) {
  m_workspace->document().edit("Seed", [](Experiment& e) { e.seed = 7; });
  m_workspace->document().edit("Samples", [](Experiment& e) { e.samples = 9; });
  EXPECT_EQ(m_window->menus().command("undo")->text(), "Undo Samples");
  m_window->menus().command("undo")->trigger();
  EXPECT_EQ(m_workspace->document().experiment().samples, 2);
  EXPECT_EQ(m_workspace->document().experiment().seed, 7U);
  EXPECT_EQ(m_window->menus().command("redo")->text(), "Redo Samples");
  m_window->menus().command("redo")->trigger();
  EXPECT_EQ(m_workspace->document().experiment().samples, 9);
  auto* list = child<QListWidget>(*m_window->showPanel("history"), "historyList");
  ASSERT_EQ(list->count(), 3);
  list->setCurrentRow(0);
  EXPECT_EQ(m_workspace->document().experiment().seed, 1U);
  EXPECT_FALSE(m_window->menus().command("undo")->isEnabled());
}

TEST_F(Shell, ADragIsOneEdit) {
  const size_t before = m_workspace->document().history().size();
  for (uint64_t seed = 10; seed < 20; ++seed)
    m_workspace->document().edit(
        "Seed", [=](Experiment& e) { e.seed = seed; }, true);
  EXPECT_EQ(m_workspace->document().history().size(), before + 1);
  m_workspace->document().undo();
  EXPECT_EQ(m_workspace->document().experiment().seed, 1U);
}

TEST_F(Shell, SavesWhatTheCommandLineReads) {
  const fs::path saved = file("saved.json");
  m_workspace->document().edit("Seed", [](Experiment& e) { e.seed = 42; });
  EXPECT_TRUE(m_workspace->modified());
  m_workspace->save(QString::fromStdString(saved));
  EXPECT_FALSE(m_workspace->modified());
  const Experiment read = readExperiment(saved);
  EXPECT_EQ(read.seed, 42U);
  EXPECT_TRUE(fs::exists(read.folder / read.systems.front().model))
      << "the model's name does not hold from the new folder";
}

TEST_F(Shell, AFolderThatCannotBeWrittenLosesNothing) {
  m_workspace->document().edit("Seed", [](Experiment& e) { e.seed = 42; });
  const Experiment before = m_workspace->document().experiment();
  EXPECT_THROW(m_workspace->save("/proc/no/such/folder/x.json"), FileError);
  EXPECT_EQ(m_workspace->document().experiment(), before);
  EXPECT_TRUE(m_workspace->modified());
}

TEST_F(Shell, AFileThatIsNoExperimentLeavesTheDocument) {
  std::ofstream(file("broken.json")) << "{ \"natural\": 3 }";
  m_window->files().openFiles({QString::fromStdString(file("broken.json"))});
  ASSERT_EQ(m_errors.size(), 1U);
  EXPECT_NE(m_errors.front().find("broken.json"), std::string::npos) << m_errors.front();
  auto* box = m_window->findChild<QMessageBox*>("errorBox");
  ASSERT_NE(box, nullptr);
  EXPECT_TRUE(box->informativeText().contains("broken.json")) << qPrintable(box->informativeText());
  EXPECT_EQ(m_workspace->document().experiment().systems.size(), 1U);
  EXPECT_EQ(m_workspace->motions().groups().size(), 1U);
}

TEST_F(Shell, AModelThatVanishedIsNamedAndTheWindowLives) {
  m_workspace->document().edit("Model", [](Experiment& e) { e.systems[0].model = "gone.marey"; });
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(waitUntil([this] { return !m_errors.empty(); }));
  EXPECT_NE(m_errors.front().find("gone.marey"), std::string::npos) << m_errors.front();
  EXPECT_EQ(m_workspace->motions().groups().size(), 1U) << "an empty sample set was left";
  m_workspace->document().undo();
  m_workspace->sampling().sampleCurrentPath();
  EXPECT_TRUE(waitUntil([this] {
    return m_workspace->motions().groups().size() == 2 &&
           m_workspace->motions().groups().back().complete;
  }));
}

TEST_F(Shell, ClosingDuringAJobEndsIt) {
  m_workspace->document().edit("More", [](Experiment& e) { e.samples = 100000; });
  m_workspace->save(QString::fromStdString(file("saved.json")));
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(
      waitUntil([this] { return !m_workspace->motions().groups().back().motions.empty(); }));
  EXPECT_TRUE(m_window->close());
  EXPECT_TRUE(waitUntil([this] { return m_jobs->idle(); }, 20.0));
}

TEST_F(Shell, ThePaletteFindsACommandByItsLettersAndRunsIt) {
  EXPECT_GT(matchScore("Write the report", "wrep"), matchScore("Wear the tarp", "wrep"));
  EXPECT_LT(matchScore("Save", "xyz"), 0);
  const Theme before = m_window->theme();
  m_window->menus().command("palette")->trigger();
  auto* palette = child<CommandPalette>(*m_window, "commandPalette");
  QTest::keyClicks(child<QLineEdit>(*palette, "commandQuery"), "light or dark");
  QTest::keyClick(child<QLineEdit>(*palette, "commandQuery"), Qt::Key_Return);
  settle();
  EXPECT_NE(m_window->theme(), before);
}

TEST_F(Shell, EveryKeyIsGivenOnce) {
  std::map<QString, QString> owners;
  for (const QAction* action : m_window->menus().commands()) {
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
  m_window->menus().command("resetLayout")->trigger();
  settle();
  EXPECT_TRUE(m_window->showPanel("library")->isVisible());
}

double clockMs(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// How long the GUI thread went without coming back to the event loop, at most.
struct Stall {
  double cpuMs = 0.0;   ///< of its own computing; other programs may be using the machine
  double wallMs = 0.0;  ///< by the clock on the wall: waiting for a lock or a disk counts too
};

Stall longestStall(const std::function<bool()>& until) {
  QTimer watchdog;
  Stall last{clockMs(CLOCK_THREAD_CPUTIME_ID), clockMs(CLOCK_MONOTONIC)}, longest;
  QObject::connect(&watchdog, &QTimer::timeout, [&] {
    const Stall now{clockMs(CLOCK_THREAD_CPUTIME_ID), clockMs(CLOCK_MONOTONIC)};
    longest.cpuMs = std::max(longest.cpuMs, now.cpuMs - last.cpuMs);
    longest.wallMs = std::max(longest.wallMs, now.wallMs - last.wallMs);
    last = now;
  });
  watchdog.start(1);
  EXPECT_TRUE(waitUntil(until, 120.0));
  return longest;
}

TEST_F(Shell, AThousandClipsDoNotHoldTheWindowUp) {
  m_workspace->document().edit("A thousand",
                               [](Experiment& e) { e.natural = {"walker:1000,4,1"}; });
  const Stall stall = longestStall([this] { return m_jobs->idle(); });
  EXPECT_EQ(m_workspace->motions().groups().front().motions.size(), 1000U);
  EXPECT_LT(stall.cpuMs, 100.0);
  // A thread that gets a tenth of a processor still comes back within a second.
  EXPECT_LT(stall.wallMs, 1000.0);
  RecordProperty("stall_cpu_ms", static_cast<int>(stall.cpuMs));
  RecordProperty("stall_wall_ms", static_cast<int>(stall.wallMs));
}

TEST_F(Shell, AnExceptionInASlotIsShownAndTheWindowLives) {
  QString error;
  QObject::connect(static_cast<Application*>(qApp), &Application::failed, m_window.get(),
                   [&](const QString& text) { error = text; });
  QTimer::singleShot(0, m_window.get(), [] { throw std::runtime_error("a slot that fails"); });
  EXPECT_TRUE(waitUntil([&] { return !error.isEmpty(); }, 5.0));
  EXPECT_EQ(error, "a slot that fails");
}

TEST_F(Shell, ASecondErrorDoesNotTakeTheFirstAway) {
  m_workspace->report("Reading", "no such file");
  m_workspace->report("Writing", "disk full");
  auto* box = m_window->findChild<QMessageBox*>("errorBox");
  ASSERT_NE(box, nullptr);
  EXPECT_TRUE(box->informativeText().contains("no such file"));
  EXPECT_TRUE(box->informativeText().contains("Writing: disk full"));
  box->close();
  m_workspace->report("Writing", "disk full");
  EXPECT_FALSE(box->informativeText().contains("no such file")) << "what was read comes again";
}

TEST_F(Shell, ThePaletteAndTheKeySheetKnowTheKeysOfPanels) {
  std::set<QString> known;
  for (const QAction* action : m_window->allCommands()) known.insert(action->text());
  size_t ofPanels = 0;
  for (const PanelSpec& spec : panels()) {
    for (const QAction* action : m_window->showPanel(spec.id)->findChildren<QAction*>()) {
      if (action->shortcut().isEmpty() || action->text().isEmpty()) continue;
      ++ofPanels;
      EXPECT_TRUE(known.contains(action->text())) << action->text().toStdString();
    }
  }
  EXPECT_EQ(m_window->allCommands().size(), m_window->menus().commands().size() + ofPanels);
}

}  // namespace
}  // namespace marey::gui
