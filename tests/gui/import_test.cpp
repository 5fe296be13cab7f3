// Motion files through the import dialog.
#include <QAbstractItemModel>
#include <QComboBox>
#include <QDialog>
#include <QElapsedTimer>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTableView>
#include <QTest>
#include <QThread>
#include <cstdio>
#include <ctime>
#include <fstream>

#include "gui/exchange/import_dialog.h"
#include "gui/exchange/import_model.h"
#include "gui/gui_support.h"

#include "io/clip_io.h"
#include "motion/walker.h"

namespace marey::gui {
namespace {

namespace fs = std::filesystem;

class Import : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    openWindow();
    m_motion = fs::path(m_folder.path().toStdString()) / "motion";
    fs::create_directory(m_motion);
  }
  /// Short walks as BVH.
  void writeWalks(int count) {
    const Clip walk = walkerDataSet(1, 1.0, 7).front().clip;
    const Clip part = sliceFrames(walk, 0, 12);
    const fs::path first = m_motion / "walk_0000.bvh";
    io::writeClip(part, first);
    for (int i = 1; i < count; ++i)
      fs::copy_file(first, m_motion / fmt::format("walk_{:04}.bvh", i));
  }
  void open(const QStringList& files) {
    showImportDialog(*m_workspace, files, m_window.get());
    m_dialog = child<QDialog>(*m_window, "importDialog");
    m_table = child<QTableView>(*m_dialog, "importTable");
  }
  /// A closed dialog is deleted later, by an event loop that a test does not run.
  bool dialogShown() {
    const auto* dialog = m_window->findChild<QDialog*>("importDialog");
    return dialog != nullptr && dialog->isVisible();
  }
  QPushButton* add() { return child<QPushButton>(*m_dialog, "importAdd"); }
  bool examined() {
    return waitUntil([this] { return add()->isEnabled(); });
  }
  std::string cell(int row, int column) const {
    return m_table->model()->index(row, column).data().toString().toStdString();
  }
  void pick(const char* box, const QString& value) {
    auto* combo = child<QComboBox>(*m_dialog, box);
    combo->setCurrentIndex(combo->findData(value));
    Q_EMIT combo->activated(combo->currentIndex());
  }

  fs::path m_motion;
  QDialog* m_dialog = nullptr;
  QTableView* m_table = nullptr;
};

double threadMs() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct Stall {
  double workMs = 0.0;  ///< of this thread: other programs of the machine do not count
  double wallMs = 0.0;
};

/// The longest turn of the event loop while `ready` is waited for.
Stall longestStall(const std::function<bool()>& ready, double seconds) {
  QElapsedTimer total, turn;
  total.start();
  Stall longest;
  while (!ready() && static_cast<double>(total.elapsed()) < 1000.0 * seconds) {
    turn.start();
    const double begin = threadMs();
    QApplication::processEvents(QEventLoop::AllEvents);
    longest.workMs = std::max(longest.workMs, threadMs() - begin);
    longest.wallMs = std::max(longest.wallMs, 1e-6 * static_cast<double>(turn.nsecsElapsed()));
    QThread::msleep(1);
  }
  return longest;
}

TEST_F(Import, WhatAFolderLeavesOutIsListedWithItsReason) {
  writeWalks(2);
  std::ofstream(m_motion / "labels.npz") << "no archive";
  std::ofstream(m_motion / "notes.doc") << "mine";
  fs::create_symlink(m_motion / "gone.bvh", m_motion / "link.bvh");
  open({QString::fromStdString(m_motion)});
  ASSERT_TRUE(examined());
  ASSERT_EQ(m_table->model()->rowCount(), 4);
  const auto* reason = child<QLabel>(*m_dialog, "importReason");
  std::string reasons;
  for (int row = 2; row < 4; ++row) {
    const QModelIndex index = m_table->model()->index(row, 0);
    EXPECT_EQ(index.data(Qt::CheckStateRole), Qt::Unchecked) << row;
    m_table->selectRow(row);
    reasons += cell(row, 0) + ": " + reason->text().toStdString() + "\n";
  }
  EXPECT_NE(reasons.find("labels.npz: error: no motion"), std::string::npos) << reasons;
  EXPECT_NE(reasons.find("link.bvh: error: a link to nothing"), std::string::npos) << reasons;
  const std::string state = child<QLabel>(*m_dialog, "importState")->text().toStdString();
  EXPECT_NE(state.find("2 of 4 files not read"), std::string::npos) << state;
  EXPECT_NE(state.find("doc"), std::string::npos) << state;
  EXPECT_EQ(add()->text(), "Add 2 files");
  add()->click();
  ASSERT_TRUE(waitUntil([this] { return !dialogShown() && m_jobs->idle(); }));
  EXPECT_EQ(m_workspace->document().experiment().natural,
            std::vector<std::string>{m_motion.string()})
      << "the folder leaves them out by itself";
}

TEST_F(Import, AThousandFilesLeaveTheWindowResponsive) {
  writeWalks(1000);
  QElapsedTimer clock;
  clock.start();
  open({QString::fromStdString(m_motion)});
  EXPECT_EQ(m_table->model()->rowCount(), 0) << "files were listed on the event loop";
  EXPECT_LE(m_jobs->jobs().size(), 2U) << "a job per file";
  const Stall stall = longestStall([this] { return add()->isEnabled(); }, 240.0);
  ASSERT_TRUE(add()->isEnabled());
  EXPECT_EQ(m_table->model()->rowCount(), 1000);
  EXPECT_LT(stall.workMs, 100.0);
  std::printf(
      "1000 files examined in %lld ms; longest turn of the event loop %.0f ms, of it work "
      "%.0f ms\n",
      static_cast<long long>(clock.elapsed()), stall.wallMs, stall.workMs);
}

TEST_F(Import, OverridesGoToTheFileThatWasChosen) {
  writeWalks(2);
  open({QString::fromStdString(m_motion)});
  ASSERT_TRUE(examined());
  ASSERT_EQ(m_table->model()->rowCount(), 2);
  m_table->selectRow(1);
  pick("importUnit", "m");
  ASSERT_TRUE(examined());
  EXPECT_NE(cell(0, ImportModel::Unit), "m");
  EXPECT_EQ(cell(1, ImportModel::Unit), "m");
}

TEST(ImportTable, AFileOfSeveralClipsMovesLaterRowsDownAndKeepsThemTheirFiles) {
  ImportModel model(nullptr);
  model.setFiles({{.path = "a.npz"}, {.path = "b.bvh"}});
  const QPersistentModelIndex chosen(model.index(1, 0));
  io::DoctorReport report;
  report.format = "npz";
  model.setReports(0, {report, report, report});
  ASSERT_EQ(model.rowCount(), 4);
  EXPECT_EQ(chosen.row(), 3);
  EXPECT_EQ(model.fileAt(chosen.row()), 1U);
  EXPECT_EQ(model.clipAt(2), 2U);
  EXPECT_EQ(model.fileAt(2), 0U);
  model.setReports(0, {report});
  EXPECT_EQ(chosen.row(), 1);
  EXPECT_EQ(model.fileAt(1), 1U);
  EXPECT_EQ(model.examined(), 1U);
}

TEST_F(Import, UsingASettingForAllFilesLeavesTheirTicks) {
  writeWalks(3);
  std::ofstream(m_motion / "walk_9999.bvh") << "HIERARCHY\nnothing";
  open({QString::fromStdString(m_motion)});
  ASSERT_TRUE(examined());
  auto* model = m_table->model();
  ASSERT_TRUE(model->setData(model->index(1, 0), Qt::Unchecked, Qt::CheckStateRole));
  settle(50);
  EXPECT_EQ(add()->text().toStdString(), "Add 2 files");
  m_table->selectRow(0);
  pick("importEuler", "XYZ");
  ASSERT_TRUE(examined());
  QTest::mouseClick(child<QPushButton>(*m_dialog, "importForAll"), Qt::LeftButton);
  ASSERT_TRUE(examined());
  EXPECT_EQ(add()->text().toStdString(), "Add 2 files, 2 converted");
  EXPECT_EQ(model->index(1, 0).data(Qt::CheckStateRole).toInt(), Qt::Unchecked);
  EXPECT_EQ(model->index(3, 0).data(Qt::CheckStateRole).toInt(), Qt::Unchecked);
  EXPECT_EQ(cell(0, ImportModel::Euler), "XYZ") << "the doctor shows the order that is used";
}

TEST_F(Import, AnotherEulerOrderIsConvertedAndAdded) {
  writeWalks(1);
  open({QString::fromStdString(m_motion / "walk_0000.bvh")});
  ASSERT_TRUE(examined());
  m_table->selectRow(0);
  pick("importEuler", "XYZ");
  ASSERT_TRUE(examined());
  child<QLineEdit>(*m_dialog, "importFolder")
      ->setText(QString::fromStdString(m_motion / "converted"));
  QTest::mouseClick(add(), Qt::LeftButton);
  ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
  const auto& natural = m_workspace->document().experiment().natural;
  ASSERT_EQ(natural.size(), 1U);
  const Clip added = io::readClip(m_workspace->document().experiment().folder / natural.front());
  const Clip wanted =
      io::readClip(m_motion / "walk_0000.bvh", io::ReadOptions{.eulerOrder = "XYZ"});
  const Clip asFound = io::readClip(m_motion / "walk_0000.bvh");
  float most = 0.0F;
  for (size_t k = 0; k < wanted.positions.size(); ++k) {
    ASSERT_LT((added.positions[k] - wanted.positions[k]).norm(), 1e-5F);
    most = std::max(most, (added.positions[k] - asFound.positions[k]).norm());
  }
  EXPECT_GT(most, 1e-3F) << "the order made no difference";
}

TEST_F(Import, ClosingTheDialogEndsItsWorkAndAddsNothing) {
  constexpr int kFiles = 1000;
  writeWalks(kFiles);
  open({QString::fromStdString(m_motion)});
  // In the midst of looking into them.
  ASSERT_TRUE(waitUntil(
      [this] { return m_table->model()->rowCount() == kFiles && !m_jobs->idle(); }, 20.0));
  QTest::mouseClick(child<QPushButton>(*m_dialog, "importClose"), Qt::LeftButton);
  // Time of the processor: others may want it too.
  const std::clock_t begin = std::clock();
  ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 1.0);
  settle();
  EXPECT_FALSE(dialogShown());
  EXPECT_TRUE(m_workspace->document().experiment().natural.empty());
  EXPECT_TRUE(m_errors.empty());
}

TEST_F(Import, WhatIsNotThereIsToldAndLeavesNoDialog) {
  showImportDialog(*m_workspace, {QString::fromStdString(m_motion / "none.bvh")}, m_window.get());
  ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
  settle();
  EXPECT_FALSE(dialogShown());
  ASSERT_EQ(m_errors.size(), 1U);
  EXPECT_NE(m_errors.front().find("none.bvh"), std::string::npos);
}

}  // namespace
}  // namespace marey::gui
