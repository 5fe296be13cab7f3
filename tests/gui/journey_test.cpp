// What a person does from the start to files, and the same from the command line.
#include <QAction>
#include <QComboBox>
#include <QProcess>
#include <QPushButton>
#include <QSpinBox>
#include <QTest>
#include <QTreeView>

#include "gui/gui_support.h"

#include "io/clip_io.h"

namespace marey::gui {
namespace {

namespace fs = std::filesystem;

class Journey : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    openWindow();
    openSmallDemo();
  }
  void click(const char* name) {
    auto* button = child<QPushButton>(*m_window, name);
    ASSERT_TRUE(button->isEnabled()) << name;
    QTest::mouseClick(button, Qt::LeftButton);
  }
  bool idle() {
    return waitUntil([this] { return m_jobs->idle(); });
  }
};

TEST_F(Journey, SamplesEditsCancelsUndoesSavesAndReopens) {
  m_window->showPanel("sampling");
  click("sampleButton");
  ASSERT_TRUE(idle());
  ASSERT_EQ(m_workspace->groups().size(), 2U);
  EXPECT_EQ(m_workspace->groups()[1].motions.size(), 2U);

  child<QSpinBox>(*m_window, "sampleCount")->setValue(5000);
  click("sampleButton");
  ASSERT_TRUE(waitUntil([this] { return m_workspace->groups().back().motions.size() >= 10; }))
      << "the first motions did not appear while the rest was computed";
  EXPECT_FALSE(m_jobs->idle());
  click("sampleCancel");
  ASSERT_TRUE(idle());
  EXPECT_FALSE(m_workspace->groups().back().complete);
  EXPECT_GE(m_workspace->groups().back().motions.size(), 10U) << "what was drawn was thrown away";

  m_window->command("undo")->trigger();
  EXPECT_EQ(m_workspace->experiment().samples, 2);
  const QString file = m_folder.path() + "/journey.json";
  m_workspace->save(file);
  const Experiment saved = m_workspace->experiment();
  m_workspace->edit("Seed", [](Experiment& e) { e.seed = 99; });
  m_workspace->open(readExperiment(file.toStdString()), file);
  ASSERT_TRUE(idle());
  EXPECT_EQ(m_workspace->experiment(), saved);
}

TEST_F(Journey, SelectingInTheTreeLightsUpTheMotionAndTheOtherWayRound) {
  auto* tree = child<QTreeView>(*m_window->showPanel("library"), "motionTree");
  const auto group = tree->model()->index(0, 0);
  tree->expand(group);
  const auto second = tree->model()->index(1, 0, group);
  QTest::mouseClick(tree->viewport(), Qt::LeftButton, {}, tree->visualRect(second).center());
  const int id = m_workspace->groups().front().id;
  EXPECT_EQ(m_workspace->selection().motions, (std::set<MotionId>{{id, 1}}));
  m_workspace->select({.motions = {{id, 2}}});
  EXPECT_TRUE(tree->selectionModel()->isRowSelected(2, group));
  EXPECT_FALSE(tree->selectionModel()->isRowSelected(1, group));
}

TEST_F(Journey, SamplesAreThoseOfTheCommandLine) {
  m_workspace->sampleCurrentPath();
  ASSERT_TRUE(idle());
  const MotionGroup& group = m_workspace->groups().back();
  const SampleRecipe& recipe = *group.recipe;
  const fs::path out = fs::path(m_folder.path().toStdString()) / "cli";
  QProcess marey;
  marey.start(MAREY_BINARY,
              {"sample", QString::fromStdString(m_workspace->modelFile(recipe.system)), "--path",
               QString::fromStdString(recipe.path.path), "--seconds", "2", "-n", "2", "--seed", "1",
               "--temperature", QString::number(recipe.system.temperature), "--format", "npz",
               "--out", QString::fromStdString(out), "--quiet"});
  ASSERT_TRUE(marey.waitForFinished(120000));
  ASSERT_EQ(marey.exitCode(), 0) << marey.readAllStandardError().toStdString();
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(out))
    if (entry.path().extension() == ".npz") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_EQ(files.size(), group.motions.size());
  for (size_t i = 0; i < files.size(); ++i) {
    const Clip clip = io::readClip(files[i]);
    const Clip& shown = *group.motions[i].clip;
    ASSERT_EQ(clip.positions.size(), shown.positions.size());
    for (size_t k = 0; k < clip.positions.size(); ++k)
      ASSERT_LT((clip.positions[k] - shown.positions[k]).norm(), 1e-5F) << files[i] << " " << k;
  }
}

TEST_F(Journey, TheSameSeedGivesTheSameMotionsWhateverTheChunks) {
  m_workspace->edit("More", [](Experiment& e) { e.samples = 13; });
  m_workspace->sampleCurrentPath();
  ASSERT_TRUE(idle());
  const MotionGroup many = m_workspace->groups().back();
  ASSERT_EQ(many.motions.size(), 13U);
  m_workspace->setPinned(many.id, true);
  m_workspace->edit("Fewer", [](Experiment& e) { e.samples = 3; });
  m_workspace->sampleCurrentPath();
  ASSERT_TRUE(idle());
  ASSERT_EQ(m_workspace->groups().size(), 3U) << "a pinned set was replaced";
  const MotionGroup& few = m_workspace->groups().back();
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < few.motions[i].clip->positions.size(); ++k)
      ASSERT_LT((few.motions[i].clip->positions[k] - many.motions[i].clip->positions[k]).norm(),
                1e-4F);
}

}  // namespace
}  // namespace marey::gui
