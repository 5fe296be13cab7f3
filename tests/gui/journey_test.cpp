// What a person does from the start to files, and the same from the command line.
#include <QAction>
#include <QComboBox>
#include <QProcess>
#include <QPushButton>
#include <QSpinBox>
#include <QTest>
#include <QTreeView>

#include "families.h"
#include "gui/gui_support.h"

#include "experiment/run.h"
#include "io/clip_io.h"

namespace marey::gui {
namespace {

namespace fs = std::filesystem;

class Journey : public DemoTest {
 protected:
  void click(const char* name) {
    auto* button = child<QPushButton>(*m_window, name);
    ASSERT_TRUE(button->isEnabled()) << name;
    QTest::mouseClick(button, Qt::LeftButton);
  }
};

TEST_F(Journey, SamplesEditsCancelsUndoesSavesAndReopens) {
  m_window->showPanel("sampling");
  click("sampleButton");
  ASSERT_TRUE(idle());
  ASSERT_EQ(m_workspace->motions().groups().size(), 2U);
  EXPECT_EQ(m_workspace->motions().groups()[1].motions.size(), 2U);

  child<QSpinBox>(*m_window, "sampleCount")->setValue(5000);
  click("sampleButton");
  ASSERT_TRUE(waitUntil([this] {
    return m_workspace->motions().groups().back().motions.size() >= 10;
  })) << "the first motions did not appear while the rest was computed";
  EXPECT_FALSE(m_jobs->idle());
  click("sampleCancel");
  ASSERT_TRUE(idle());
  EXPECT_FALSE(m_workspace->motions().groups().back().complete);
  EXPECT_GE(m_workspace->motions().groups().back().motions.size(), 10U)
      << "what was drawn was thrown away";

  m_window->menus().command("undo")->trigger();
  EXPECT_EQ(m_workspace->document().experiment().samples, 2);
  const QString file = m_folder.path() + "/journey.json";
  m_workspace->save(file);
  const Experiment saved = m_workspace->document().experiment();
  m_workspace->document().edit("Seed", [](Experiment& e) { e.seed = 99; });
  m_workspace->open(readExperiment(file.toStdString()), file);
  ASSERT_TRUE(idle());
  EXPECT_EQ(m_workspace->document().experiment(), saved);
}

TEST_F(Journey, SelectingInTheTreeLightsUpTheMotionAndTheOtherWayRound) {
  auto* tree = child<QTreeView>(*m_window->showPanel("library"), "motionTree");
  const auto group = tree->model()->index(0, 0);
  tree->expand(group);
  const auto second = tree->model()->index(1, 0, group);
  QTest::mouseClick(tree->viewport(), Qt::LeftButton, {}, tree->visualRect(second).center());
  const int id = m_workspace->motions().groups().front().id;
  EXPECT_EQ(m_workspace->view().selection().motions, (std::set<MotionId>{{id, 1}}));
  m_workspace->view().select({.motions = {{id, 2}}});
  EXPECT_TRUE(tree->selectionModel()->isRowSelected(2, group));
  EXPECT_FALSE(tree->selectionModel()->isRowSelected(1, group));
}

std::vector<ClipPtr> clipsOf(const MotionGroup& group) {
  std::vector<ClipPtr> out;
  for (const Motion& motion : group.motions) out.push_back(motion.clip);
  return out;
}

/// The last bit of every position.
void expectSameBits(const std::vector<ClipPtr>& got, const std::vector<ClipPtr>& wanted,
                    const std::string& what) {
  ASSERT_EQ(got.size(), wanted.size()) << what;
  for (size_t i = 0; i < got.size(); ++i)
    EXPECT_EQ(got[i]->positions, wanted[i]->positions) << what << ", motion " << i;
}

/// What `marey sample` writes for a recipe.
std::vector<ClipPtr> commandLineClips(const std::string& model, const SampleRecipe& recipe,
                                      const fs::path& out) {
  QProcess marey;
  marey.start(
      MAREY_BINARY,
      {"sample", QString::fromStdString(model), "--path", QString::fromStdString(recipe.path.path),
       "--seconds", QString::number(recipe.path.seconds), "-n", QString::number(recipe.samples),
       "--seed", QString::number(recipe.seed), "--temperature",
       QString::number(recipe.system.temperature), "--format", "npz", "--out",
       QString::fromStdString(out.string()), "--threads", "1", "--quiet"});
  EXPECT_TRUE(marey.waitForFinished(120000));
  EXPECT_EQ(marey.exitCode(), 0) << marey.readAllStandardError().toStdString();
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(out))
    if (entry.path().extension() == ".npz") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<ClipPtr> clips;
  for (const auto& file : files) clips.push_back(std::make_shared<const Clip>(io::readClip(file)));
  return clips;
}

TEST_F(Journey, TheSameRecipeGivesTheSameBitsHereAgainOnTheCommandLineAndInAReport) {
  m_workspace->document().edit("More", [](Experiment& e) { e.samples = 60; });
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  const SampleRecipe recipe = *m_workspace->motions().groups().back().recipe;
  const auto first = clipsOf(m_workspace->motions().groups().back());
  ASSERT_EQ(first.size(), 60U);
  // Another seed and back: what is unchanged need not be drawn again.
  for (const uint64_t seed : {recipe.seed + 1, recipe.seed}) {
    m_workspace->document().edit("Seed", [seed](Experiment& e) { e.seed = seed; });
    m_workspace->sampling().sampleCurrentPath();
    ASSERT_TRUE(idle());
  }
  const auto second = clipsOf(m_workspace->motions().groups().back());
  EXPECT_NE(second.front(), first.front()) << "nothing was sampled again";
  expectSameBits(second, first, "sampled again");
  expectSameBits(commandLineClips(m_workspace->document().modelFile(recipe.system), recipe,
                                  fs::path(m_folder.path().toStdString()) / "cli"),
                 first, "marey sample");
  Progress progress;
  const auto report =
      runExperiment(m_workspace->document().experiment(), modelFamilies(), progress);
  expectSameBits(report.systems.front().paths.at(recipe.path.name).clips, first, "marey report");
}

TEST_F(Journey, TheSameSeedGivesTheSameMotionsWhateverTheChunks) {
  m_workspace->document().edit("More", [](Experiment& e) { e.samples = 13; });
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  const MotionGroup many = m_workspace->motions().groups().back();
  ASSERT_EQ(many.motions.size(), 13U);
  m_workspace->motions().setPinned(many.id, true);
  m_workspace->document().edit("Fewer", [](Experiment& e) { e.samples = 3; });
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  ASSERT_EQ(m_workspace->motions().groups().size(), 3U) << "a pinned set was replaced";
  const MotionGroup& few = m_workspace->motions().groups().back();
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < few.motions[i].clip->positions.size(); ++k)
      ASSERT_EQ(few.motions[i].clip->positions[k], many.motions[i].clip->positions[k]);
}

}  // namespace
}  // namespace marey::gui
