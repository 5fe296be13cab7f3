// Documents in the window: made, saved, opened, recovered; edits that the file could not hold.
#include <QAction>
#include <QDialogButtonBox>
#include <QDir>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QLineEdit>
#include <QMessageBox>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QStandardPaths>
#include <QTest>
#include <QTimer>
#include <fstream>

#include "gui/gui_support.h"
#include "gui/shell/commands.h"

#include "base/error.h"

namespace marey::gui {
namespace {

namespace fs = std::filesystem;

class Documents : public DemoTest {
 protected:
  void TearDown() override {
    m_answers.clear();
    DemoTest::TearDown();
  }
  QDir autosaves() const {
    return QDir(QStandardPaths::writableLocation(QStandardPaths::AppLocalDataLocation) +
                "/autosave");
  }
  /// A copy as a crash of another window would leave it.
  void leaveCopy(const char* name, uint64_t seed) {
    autosaves().mkpath(".");
    Experiment e = m_workspace->document().experiment();
    e.seed = seed;
    const Json copy = {{"file", ""}, {"folder", e.folder.string()}, {"experiment", toJson(e)}};
    writeJson(autosaves().filePath(name).toStdString(), copy);
  }
  /// Presses a button of every box of that name as soon as it is asked.
  void answer(const char* box, QMessageBox::StandardButton button) {
    auto timer = std::make_unique<QTimer>();
    QObject::connect(timer.get(), &QTimer::timeout, [this, box, button] {
      auto* asked = m_window->findChild<QMessageBox*>(box);
      if (asked != nullptr && asked->isVisible()) asked->button(button)->click();
    });
    timer->start(20);
    m_answers.push_back(std::move(timer));
  }

  std::vector<std::unique_ptr<QTimer>> m_answers;
};

TEST_F(Documents, AnyLengthOfAPathCanBeSavedAndOpened) {
  for (const int path : {0, 2}) {
    m_workspace->document().setCurrentPath(path);
    for (const double seconds : {0.0, 0.1, 3.0}) {
      child<QDoubleSpinBox>(*m_window->showPanel("path"), "pathSeconds")->setValue(seconds);
      m_workspace->save(QString::fromStdString(file("x.json")));
      EXPECT_EQ(readExperiment(file("x.json")), m_workspace->document().experiment()) << seconds;
    }
  }
}

TEST_F(Documents, AnEditThatNoFileCouldHoldIsRefused) {
  const Experiment before = m_workspace->document().experiment();
  m_workspace->document().edit("Samples", [](Experiment& e) { e.samples = 0; });
  m_workspace->document().edit("Twins", [](Experiment& e) { e.paths[1].name = e.paths[0].name; });
  EXPECT_EQ(m_workspace->document().experiment(), before);
  ASSERT_EQ(m_errors.size(), 2U);
  EXPECT_NE(m_errors[0].find("samples"), std::string::npos) << m_errors[0];
}

TEST_F(Documents, UnsavedWorkSurvivesACrashUntilItIsDiscarded) {
  m_workspace->document().edit("Seed", [](Experiment& e) { e.seed = 4711; });
  ASSERT_TRUE(waitUntil([&] { return !autosaves().entryList({"*.json"}).isEmpty(); }, 10.0));
  EXPECT_TRUE(Autosave::recover().kept.empty()) << "the copy of a window that is alive was taken";
  const QString copy = autosaves().entryList({"*.json"}).front();
  QFile::copy(autosaves().filePath(copy), autosaves().filePath("crashed.json"));
  {
    const Recovery found = Autosave::recover();
    ASSERT_EQ(found.kept.size(), 1U);
    EXPECT_EQ(found.kept.front().experiment.seed, 4711U);
    EXPECT_EQ(found.kept.front().experiment.folder, m_workspace->document().experiment().folder);
    EXPECT_TRUE(Autosave::recover().kept.empty()) << "two windows were offered one copy";
  }
  const Recovery again = Autosave::recover();
  ASSERT_EQ(again.kept.size(), 1U) << "only looking at it deleted it";
  Autosave::discard(again.kept.front());
  EXPECT_FALSE(autosaves().exists("crashed.json"));
}

TEST_F(Documents, RecoveringOneCopyKeepsTheOthers) {
  leaveCopy("a.json", 11);
  leaveCopy("b.json", 12);
  answer("recoveryBox", QMessageBox::Open);
  m_window->files().start({});
  EXPECT_EQ(m_workspace->document().experiment().seed, 11U);
  EXPECT_TRUE(m_workspace->modified());
  EXPECT_FALSE(autosaves().exists("a.json"));
  EXPECT_TRUE(autosaves().exists("b.json")) << "a copy that nobody was asked about is gone";
  int copies = 0;
  for (const QString& name : autosaves().entryList({"*.json"}))
    copies += readJson(autosaves().filePath(name).toStdString())["experiment"]["seed"] == 11;
  EXPECT_EQ(copies, 1) << "what was recovered is not on the disk";
}

TEST_F(Documents, UndoDoesNotGoBehindWhatWasRecovered) {
  const fs::path saved = file("mine.json");
  m_workspace->save(QString::fromStdString(saved));
  const Experiment before = m_workspace->document().experiment();
  autosaves().mkpath(".");
  Experiment kept = before;
  kept.seed = 4711;
  writeJson(
      autosaves().filePath("crashed.json").toStdString(),
      {{"file", saved.string()}, {"folder", before.folder.string()}, {"experiment", toJson(kept)}});
  answer("recoveryBox", QMessageBox::Open);
  m_window->files().start({});
  ASSERT_EQ(m_workspace->document().experiment(), kept);
  EXPECT_TRUE(m_workspace->modified()) << "the file does not hold it";
  EXPECT_FALSE(m_window->menus().command("undo")->isEnabled());
  m_window->menus().command("undo")->trigger();
  m_workspace->document().undo();
  EXPECT_EQ(m_workspace->document().experiment(), kept);
  m_window->menus().command("save")->trigger();
  EXPECT_EQ(readExperiment(saved), kept);
  EXPECT_FALSE(m_workspace->modified());
}

TEST_F(Documents, AnEmptyDocumentAsksBeforeItReplacesAFileThatIsNot) {
  const fs::path saved = file("mine.json");
  m_workspace->save(QString::fromStdString(saved));
  const Experiment before = m_workspace->document().experiment();
  m_workspace->document().edit("All away", [](Experiment& e) {
    e.natural.clear();
    e.systems.clear();
    e.paths.clear();
  });
  answer("replaceBox", QMessageBox::Cancel);
  m_window->menus().command("save")->trigger();
  EXPECT_EQ(readExperiment(saved), before) << "the user's file is empty";
  EXPECT_TRUE(m_workspace->modified());
  m_answers.clear();
  answer("replaceBox", QMessageBox::Save);
  m_window->menus().command("save")->trigger();
  EXPECT_TRUE(readExperiment(saved).systems.empty());
}

TEST_F(Documents, ACopyThatCannotBeReadIsSetAsideAndNamed) {
  autosaves().mkpath(".");
  std::ofstream(autosaves().filePath("cut.json").toStdString()) << "{\"file\": ";
  m_window->files().start({});
  EXPECT_TRUE(autosaves().exists("cut.json.broken"));
  EXPECT_FALSE(autosaves().exists("cut.json"));
  auto* box = m_window->findChild<QMessageBox*>("errorBox");
  ASSERT_NE(box, nullptr);
  EXPECT_TRUE(box->informativeText().contains("cut.json.broken"));
}

TEST_F(Documents, SavingRemovesTheCopy) {
  m_workspace->document().edit("Seed", [](Experiment& e) { e.seed = 4711; });
  ASSERT_TRUE(waitUntil([&] { return !autosaves().entryList({"*.json"}).isEmpty(); }, 10.0));
  m_workspace->save(QString::fromStdString(file("saved.json")));
  EXPECT_TRUE(autosaves().entryList({"*.json"}).isEmpty());
}

TEST_F(Documents, ANewExperimentIsEmptyAndCanBeSavedAndOpened) {
  EXPECT_TRUE(m_window->menus().command("report")->isEnabled());
  m_window->menus().command("new")->trigger();
  EXPECT_TRUE(m_workspace->document().experiment().natural.empty());
  EXPECT_TRUE(m_workspace->motions().groups().empty());
  EXPECT_FALSE(m_window->menus().command("report")->isEnabled()) << "there is nothing to report";
  m_workspace->document().edit("Seed", [](Experiment& e) { e.seed = 2; });
  EXPECT_TRUE(m_errors.empty()) << m_errors.front();
  m_workspace->save(QString::fromStdString(file("new.json")));
  EXPECT_EQ(readExperiment(file("new.json")).seed, 2U);
}

TEST_F(Documents, FilesOfTheCommandLineGoIntoADocumentOfTheirOwn) {
  const std::string model =
      m_workspace->document().modelFile(m_workspace->document().experiment().systems.front());
  m_workspace->open({}, {});
  m_window->files().start({QString::fromStdString(model)});
  ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
  EXPECT_TRUE(m_workspace->document().experiment().natural.empty())
      << "the demo's walkers are there too";
  ASSERT_EQ(m_workspace->document().experiment().systems.size(), 1U);
  EXPECT_EQ(m_workspace->document().experiment().systems.front().model, model);
}

TEST_F(Documents, AFileThatIsNoModelIsRefusedAndTheDocumentStays) {
  std::ofstream(file("no.marey")) << "not a model";
  m_window->files().openFiles({QString::fromStdString(file("no.marey"))});
  ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
  ASSERT_EQ(m_errors.size(), 1U);
  EXPECT_NE(m_errors.front().find("no.marey"), std::string::npos);
  EXPECT_EQ(m_workspace->document().experiment().systems.size(), 1U);
}

TEST_F(Documents, ANaturalFileThatVanishedIsNamedAndReadOnceItIsBack) {
  std::string vanished = file("walk.bvh").string();
  m_workspace->document().edit("Add", [&](Experiment& e) { e.natural.push_back(vanished); });
  ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
  ASSERT_EQ(m_errors.size(), 1U);
  EXPECT_NE(m_errors.front().find("walk.bvh"), std::string::npos);
  ASSERT_EQ(m_workspace->motions().groups().size(), 1U);
  EXPECT_EQ(m_workspace->motions().groups().front().motions.size(), 6U)
      << "the good clips are gone too";
  writeSmallBvh(vanished);
  m_window->menus().command("reloadNatural")->trigger();
  ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
  EXPECT_EQ(m_workspace->motions().groups().front().motions.size(), 7U);
  // Its body is no model's: that is told once, and nothing else breaks.
  ASSERT_EQ(m_errors.size(), 2U);
  EXPECT_NE(m_errors.back().find("another skeleton"), std::string::npos) << m_errors.back();
  m_workspace->natural().score(m_workspace->document().experiment().systems.front().name);
  ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
  EXPECT_EQ(m_errors.size(), 2U);
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
  EXPECT_EQ(m_workspace->motions().groups().size(), 2U);
}

TEST_F(Documents, SettingsAreOneEdit) {
  addPanelCommands(*m_window, *m_workspace);
  const size_t before = m_workspace->document().history().size();
  m_window->menus().command("documentSettings")->trigger();
  auto* dialog = child<QDialog>(*m_window, "documentSettings");
  child<QLineEdit>(*dialog, "settingsTitle")->setText("Walks");
  child<QPlainTextEdit>(*dialog, "settingsNotes")->setPlainText("two\nlines");
  child<QDoubleSpinBox>(*dialog, "settingsToleranceStep")->setValue(0.3);
  dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok)->click();
  EXPECT_EQ(m_workspace->document().experiment().title, "Walks");
  EXPECT_EQ(m_workspace->document().experiment().notes, "two\nlines");
  EXPECT_EQ(m_workspace->document().experiment().toleranceStepCmS, 0.3);
  EXPECT_EQ(m_workspace->document().experiment().fps, 20.0);
  EXPECT_EQ(m_workspace->document().history().size(), before + 1);
}

TEST_F(Documents, SavingUnderAShortNameAsksBeforeItReplacesAFile) {
  std::ofstream(file("there.json")) << "mine";
  m_workspace->document().edit("Seed", [](Experiment& e) { e.seed = 3; });
  bool asked = false, named = false;
  QTimer hand;
  QObject::connect(&hand, &QTimer::timeout, [&] {
    auto* dialog = m_window->findChild<QFileDialog*>("saveDialog");
    if (dialog == nullptr || !dialog->isVisible()) return;
    if (auto* question = dialog->findChild<QMessageBox*>()) {
      asked = true;
      question->button(QMessageBox::No)->click();
      dialog->reject();
      return;
    }
    if (named) return;
    named = true;
    child<QLineEdit>(*dialog, "fileNameEdit")
        ->setText(QString::fromStdString(file("there").string()));
    // Not from here: a timer does not fire again inside its own slot.
    QTimer::singleShot(0, dialog, [dialog] { QMetaObject::invokeMethod(dialog, "accept"); });
  });
  hand.start(50);
  m_window->menus().command("saveAs")->trigger();
  EXPECT_TRUE(asked);
  std::ifstream in(file("there.json"));
  std::string content;
  in >> content;
  EXPECT_EQ(content, "mine");
}

}  // namespace
}  // namespace marey::gui
