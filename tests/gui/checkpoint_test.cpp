// The strip of pictures beside a training's loss, with two tiny models that are trained here, and
// the range of their training data in the path panel.
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTest>

#include "gui/gui_support.h"
#include "gui/training/checkpoint_strip.h"
#include "unit/model/tiny_run.h"

namespace marey::gui {
namespace {

namespace fs = std::filesystem;

/// A run of two steps with a snapshot after each.
void writeRun(const fs::path& folder) {
  TrainRequest request = test::tinyRequest(folder);
  request.config["training"]["checkpoint_every"] = 1;
  for (const int64_t step : {1, 2}) {
    request.steps = step;
    request.resume = step > 1;
    const TrainResult result = test::trainTiny(request);
    fs::create_directories(folder / "snapshots");
    fs::copy_file(result.last, folder / "snapshots" / fmt::format("step_{:07}.marey", step));
  }
  // These are the last snapshot once more.
  fs::remove(folder / "best.marey");
  fs::remove(folder / "last.marey");
}

class Checkpoints : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    openWindow();
    openSmallDemo();
    m_run = m_folder.path().toStdString() + "/run";
    writeRun(m_run);
  }
  std::string m_run;
};

TEST_F(Checkpoints, HavePicturesThatSelectTheirMotions) {
  m_window->showPanel("checkpoints");
  auto* folder = child<QLineEdit>(*m_window, "checkpointFolder");
  folder->setText(QString::fromStdString(m_run));
  Q_EMIT folder->editingFinished();
  auto* strip = child<CheckpointStrip>(*m_window, "checkpointStrip");
  ASSERT_EQ(strip->count(), 2);
  EXPECT_FALSE(strip->drawn(0)) << "nothing has been sampled";
  child<QPushButton>(*m_window, "checkpointSample")->click();
  ASSERT_TRUE(waitUntil([&] { return strip->drawn(0) && strip->drawn(1) && m_jobs->idle(); }));
  const auto& groups = m_workspace->motions().groups();
  ASSERT_EQ(groups.size(), 3U);
  EXPECT_EQ(render::colourOf(groups[1].colourIndex), render::colourOf(render::stageIndex(0.0)));
  EXPECT_EQ(render::colourOf(groups[2].colourIndex), render::colourOf(render::stageIndex(1.0)));
  const auto picture = [&](int i) { return strip->item(i)->icon().pixmap(132, 84).toImage(); };
  EXPECT_NE(picture(0), picture(1));
  strip->scrollToItem(strip->item(1));
  settle();
  QTest::mouseClick(strip->viewport(), Qt::LeftButton, {},
                    strip->visualItemRect(strip->item(1)).center());
  std::set<MotionId> wanted;
  for (int i = 0; i < static_cast<int>(groups[2].motions.size()); ++i)
    wanted.insert({groups[2].id, i});
  EXPECT_EQ(m_workspace->view().selection().motions, wanted);
  EXPECT_TRUE(m_errors.empty()) << m_errors.front();
}

TEST_F(Checkpoints, ThePathIsJudgedByTheTrainingDataOfAModelThatKnowsThem) {
  m_window->showPanel("path");
  auto* source = child<QLabel>(*m_window, "pathRangeSource");
  const auto text = [&] { return source->text().toStdString(); };
  // The model of the demonstration knows its training data, too.
  m_workspace->document().edit(QStringLiteral("None"), [](Experiment& e) { e.systems.clear(); });
  ASSERT_TRUE(idle());
  EXPECT_NE(text().find("natural motions"), std::string::npos) << text();
  m_workspace->document().edit(QStringLiteral("Model"), [this](Experiment& e) {
    e.systems.push_back({.name = "Tiny", .model = m_run + "/snapshots/step_0000002.marey"});
  });
  ASSERT_TRUE(idle());
  EXPECT_NE(text().find("training data of Tiny"), std::string::npos) << text();
  m_workspace->document().undo();
  ASSERT_TRUE(idle());
  EXPECT_NE(text().find("natural motions"), std::string::npos) << text();
}

}  // namespace
}  // namespace marey::gui
