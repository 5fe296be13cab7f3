// Work in the background, and what the window shows of it: sample sets, jobs, natural scores.
#include <QAction>
#include <QComboBox>
#include <QLineEdit>
#include <QPushButton>
#include <QTableWidget>
#include <QTest>
#include <QToolButton>
#include <QTreeView>
#include <fstream>

#include "gui/gui_support.h"
#include "gui/shell/job_list.h"

#include "io/clip_io.h"

namespace marey::gui {
namespace {

namespace fs = std::filesystem;

class BackgroundWork : public DemoTest {
 protected:
  void sampleTwo() {
    m_workspace->sampling().sampleCurrentPath();
    ASSERT_TRUE(idle());
    ASSERT_EQ(m_workspace->motions().groups().size(), 2U);
  }
  /// Runs until it is cancelled.
  int startEndless(Lane lane, const char* title) {
    return m_jobs->start(lane, title, [](Progress& progress) {
      for (;;) {
        progress.throwIfCancelled();
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    });
  }
  bool runs(int job) const {
    for (const JobStatus& status : m_jobs->jobs())
      if (status.id == job) return true;
    return false;
  }
};

TEST_F(BackgroundWork, ASetStaysUntilTheFirstMotionsOfItsSuccessorAreThere) {
  sampleTwo();
  const int old = m_workspace->motions().groups().back().id;
  m_workspace->document().edit("Other", [](Experiment& e) { e.seed = 5; });
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_NE(m_workspace->motions().group(old), nullptr) << "it went before there was anything else";
  bool gap = false;
  QObject::connect(&m_workspace->motions(), &MotionGroups::changed, m_window.get(), [&] {
    size_t shown = 0;
    for (const MotionGroup& group : m_workspace->motions().groups())
      shown += group.natural() ? 0 : group.motions.size();
    gap = gap || shown == 0;
  });
  ASSERT_TRUE(idle());
  EXPECT_EQ(m_workspace->motions().group(old), nullptr);
  EXPECT_EQ(m_workspace->motions().groups().size(), 2U);
  EXPECT_FALSE(gap);
}

TEST_F(BackgroundWork, ASetWhoseSuccessorFailsStays) {
  sampleTwo();
  const int old = m_workspace->motions().groups().back().id;
  SampleRecipe recipe = *m_workspace->motions().groups().back().recipe;
  recipe.system.model = "gone.marey";
  m_workspace->sampling().sample(recipe, old);
  ASSERT_TRUE(idle());
  ASSERT_EQ(m_workspace->motions().groups().size(), 2U);
  EXPECT_EQ(m_workspace->motions().groups().back().id, old);
}

TEST_F(BackgroundWork, SamplingTwiceInHasteLeavesOneSetAndOneJob) {
  sampleTwo();
  m_workspace->document().edit("Many", [](Experiment& e) { e.samples = 50000; });
  m_workspace->sampling().sampleCurrentPath();
  m_workspace->document().edit("Few", [](Experiment& e) { e.samples = 3; });
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }, 30.0))
      << "the set that was replaced is still being drawn";
  ASSERT_EQ(m_workspace->motions().groups().size(), 2U);
  EXPECT_EQ(m_workspace->motions().groups().back().motions.size(), 3U);
}

TEST_F(BackgroundWork, RemovedMotionsCanBeBroughtBack) {
  auto* action = child<QAction>(*m_window, "bringBack");
  EXPECT_FALSE(action->isEnabled());
  sampleTwo();
  const MotionGroup drawn = m_workspace->motions().groups().back();
  m_workspace->motions().setAside(drawn.id);
  ASSERT_EQ(m_workspace->motions().groups().size(), 1U);
  ASSERT_TRUE(action->isEnabled());
  EXPECT_TRUE(action->text().contains(QString::fromStdString(drawn.name)));
  action->trigger();
  ASSERT_EQ(m_workspace->motions().groups().size(), 2U);
  const MotionGroup& back = m_workspace->motions().groups().back();
  EXPECT_EQ(back.motions.size(), drawn.motions.size());
  EXPECT_EQ(back.motions[1].clip, drawn.motions[1].clip);
  EXPECT_EQ(back.recipe->seed, drawn.recipe->seed);
  EXPECT_FALSE(action->isEnabled());
  m_workspace->motions().setAside(back.id);
  m_workspace->open(m_workspace->document().experiment(), {});
  EXPECT_FALSE(action->isEnabled()) << "they belong to the document that they were made in";
  ASSERT_TRUE(idle());
}

TEST_F(BackgroundWork, APinnedSetIsNeverReplaced) {
  sampleTwo();
  const int old = m_workspace->motions().groups().back().id;
  m_workspace->motions().setPinned(old, true);
  m_workspace->sampling().sample(*m_workspace->motions().group(old)->recipe, old);
  ASSERT_TRUE(idle());
  EXPECT_NE(m_workspace->motions().group(old), nullptr);
  EXPECT_EQ(m_workspace->motions().groups().size(), 3U);
}

TEST_F(BackgroundWork, TheFirstMotionsComeSoonAndTheRestInLargerParts) {
  m_workspace->document().edit("Many", [](Experiment& e) {
    e.samples = 75;
    e.paths[0].seconds = 0.5;
  });
  std::set<size_t> sizes;
  QObject::connect(&m_workspace->motions(), &MotionGroups::changed, m_window.get(), [&] {
    if (!m_workspace->motions().groups().back().natural())
      sizes.insert(m_workspace->motions().groups().back().motions.size());
  });
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  EXPECT_EQ(sizes, (std::set<size_t>{0, 10, 30, 70, 75}));
}

TEST_F(BackgroundWork, OnlyTickedModelsAreSampled) {
  m_workspace->document().edit("Another model", [](Experiment& e) {
    e.systems.push_back(e.systems.front());
    e.systems.back().name = "second";
  });
  auto* table = child<QTableWidget>(*m_window->showPanel("sampling"), "systemTable");
  table->item(0, 0)->setCheckState(Qt::Unchecked);
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  ASSERT_EQ(m_workspace->motions().groups().size(), 2U);
  EXPECT_EQ(m_workspace->motions().groups().back().system, "second");
  table->item(1, 0)->setCheckState(Qt::Unchecked);
  EXPECT_FALSE(child<QPushButton>(*m_window, "sampleButton")->isEnabled());
}

TEST_F(BackgroundWork, ASeedOf64BitsIsShownAndTaken) {
  auto* seed = child<QLineEdit>(*m_window->showPanel("sampling"), "sampleSeed");
  m_workspace->document().edit("Seed", [](Experiment& e) { e.seed = 18446744073709551615U; });
  EXPECT_EQ(seed->text(), "18446744073709551615");
  seed->setText("9007199254740993");
  QTest::keyClick(seed, Qt::Key_Return);
  EXPECT_EQ(m_workspace->document().experiment().seed, 9007199254740993U);
  seed->setText("99999999999999999999");
  QTest::keyClick(seed, Qt::Key_Return);
  EXPECT_EQ(m_workspace->document().experiment().seed, 9007199254740993U);
  EXPECT_EQ(seed->text(), "9007199254740993");
}

TEST_F(BackgroundWork, AClipsFirstFramesMayStartTheMotion) {
  io::writeClip(*m_workspace->motions().groups().front().motions.front().clip, file("walk.npz"));
  m_workspace->document().edit("Clip", [&](Experiment& e) {
    e.paths[0] = {.name = "clip", .path = "clip:" + file("walk.npz").string(), .seconds = 1.0};
    e.samples = 1;
  });
  auto* start = child<QComboBox>(*m_window->showPanel("sampling"), "sampleStart");
  ASSERT_TRUE(start->isEnabled());
  sampleTwo();
  const ClipPtr fromMean = m_workspace->motions().groups().back().motions.front().clip;
  start->setCurrentIndex(1);
  Q_EMIT start->activated(1);
  EXPECT_TRUE(m_workspace->document().experiment().paths[0].startFromClip);
  sampleTwo();
  const ClipPtr fromClip = m_workspace->motions().groups().back().motions.front().clip;
  EXPECT_NE(fromClip->positions, fromMean->positions);
  m_workspace->document().setCurrentPath(1);
  EXPECT_FALSE(start->isEnabled());
}

TEST_F(BackgroundWork, AnotherDocumentEndsItsOwnWorkOnly) {
  const int writing = startEndless(Lane::Exports, "Writing");
  m_workspace->document().edit("Many", [](Experiment& e) { e.samples = 50000; });
  m_workspace->sampling().sampleCurrentPath();
  m_workspace->open(m_workspace->document().experiment(), {});
  ASSERT_TRUE(waitUntil([this] { return m_jobs->jobs().size() == 1; }, 20.0));
  EXPECT_TRUE(runs(writing)) << "an export was thrown away";
  // And what is written holds nothing up.
  m_workspace->document().edit("Few", [](Experiment& e) { e.samples = 2; });
  m_workspace->sampling().sampleCurrentPath();
  EXPECT_TRUE(waitUntil([this] { return m_workspace->motions().groups().back().complete; }, 20.0));
  m_workspace->save(QString::fromStdString(file("saved.json").string()));
  EXPECT_TRUE(m_window->close());
  EXPECT_TRUE(waitUntil([this] { return m_jobs->idle(); }, 20.0)) << "closing left it running";
}

TEST_F(BackgroundWork, EscInAFieldOfTextCancelsNothing) {
  const int reading = startEndless(Lane::Files, "Reading");
  auto* filter = child<QLineEdit>(*m_window->showPanel("library"), "motionFilter");
  m_window->activateWindow();
  filter->setFocus();
  ASSERT_TRUE(waitUntil([&] { return filter->hasFocus(); }, 5.0));
  QTest::keyClick(filter, Qt::Key_Escape);
  settle(150);
  EXPECT_TRUE(runs(reading));
  filter->clearFocus();
  QTest::keyClick(m_window.get(), Qt::Key_Escape);
  EXPECT_TRUE(waitUntil([&] { return !runs(reading); }, 5.0));
}

TEST_F(BackgroundWork, OneJobOfSeveralCanBeStopped) {
  const int first = startEndless(Lane::Exports, "First"),
            second = startEndless(Lane::Models, "Second");
  child<QToolButton>(*m_window, "listJobs")->click();
  auto* list = child<JobList>(*m_window, "jobList");
  child<QToolButton>(*list, ("cancelJob" + std::to_string(second)).c_str())->click();
  EXPECT_TRUE(waitUntil([&] { return !runs(second); }, 5.0));
  EXPECT_TRUE(runs(first));
}

TEST_F(BackgroundWork, ResultsForAWidgetThatIsGoneAreDropped) {
  auto context = std::make_unique<QObject>();
  bool called = false, ended = false;
  m_jobs->start(
      Lane::Files, "Short", [](Progress&) {}, [&] { called = true; }, context.get());
  QObject::connect(m_jobs.get(), &JobQueue::ended, m_window.get(), [&] { ended = true; });
  context.reset();
  EXPECT_TRUE(waitUntil([&] { return ended; }, 5.0));
  EXPECT_FALSE(called);
}

TEST_F(BackgroundWork, ScoringThatWasCancelledCanBeAskedForAgain) {
  const std::string system = m_workspace->document().experiment().systems.front().name;
  m_workspace->natural().score(system);
  m_jobs->cancelAll();
  ASSERT_TRUE(idle());
  EXPECT_EQ(m_workspace->natural().scores(system), nullptr);
  m_workspace->natural().score(system);
  ASSERT_TRUE(idle());
  EXPECT_NE(m_workspace->natural().scores(system), nullptr);
  // Scores belong to the model, whatever the system is called or points at.
  m_workspace->document().edit("Rename", [](Experiment& e) { e.systems[0].name = "other"; });
  EXPECT_NE(m_workspace->natural().scores("other"), nullptr);
  m_workspace->document().edit("Model", [](Experiment& e) { e.systems[0].model = "gone.marey"; });
  EXPECT_EQ(m_workspace->natural().scores("other"), nullptr);
}

TEST_F(BackgroundWork, AnEditTellsOnlyWhatItChanged) {
  int motions = 0, visibility = 0;
  QObject::connect(&m_workspace->motions(), &MotionGroups::changed, m_window.get(),
                   [&] { ++motions; });
  QObject::connect(&m_workspace->motions(), &MotionGroups::visibilityChanged, m_window.get(),
                   [&] { ++visibility; });
  m_workspace->document().edit("Seed", [](Experiment& e) { e.seed = 77; });
  m_workspace->document().edit("Temperature",
                               [](Experiment& e) { e.systems[0].temperature = 0.4; });
  EXPECT_EQ(motions + visibility, 0);
  m_workspace->document().edit("Feet", [](Experiment& e) { e.toleranceStepCmS = 0.3; });
  EXPECT_EQ(motions, 1);
  visibility = 0;
  const int group = m_workspace->motions().groups().front().id;
  m_workspace->motions().showOnly({{group, 4}, {group, 5}});
  EXPECT_EQ(visibility, 1);
  EXPECT_EQ(m_workspace->motions().visibleMotions(),
            (std::vector<MotionId>{{group, 4}, {group, 5}}));
  m_workspace->view().setTime(2.0);
  m_workspace->motions().setVisible(group, false);
  EXPECT_EQ(m_workspace->view().time(), 0.0) << "the time is beyond all that is shown";
}

TEST_F(BackgroundWork, SystemsKeepColoursOfTheirOwn) {
  m_workspace->document().edit("Another model", [](Experiment& e) {
    e.systems.push_back(e.systems.front());
    e.systems.back().name = "second";
  });
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  ASSERT_EQ(m_workspace->motions().groups().size(), 3U);
  m_workspace->document().edit("Rename", [](Experiment& e) { e.systems[0].name = "first"; });
  EXPECT_EQ(m_workspace->motions().groups()[1].system, "first") << "its motions lost their model";
  m_workspace->document().edit("Remove", [](Experiment& e) { e.systems.erase(e.systems.begin()); });
  EXPECT_EQ(m_workspace->motions().groups()[2].colourIndex, 0);
  EXPECT_NE(m_workspace->motions().groups()[1].colourIndex, 0) << "two systems look the same";
}

TEST_F(BackgroundWork, TheTreeGroupsBySourceAndListsModels) {
  m_workspace->document().edit("Source",
                               [](Experiment& e) { e.natural.emplace_back("walker:2,4,7"); });
  ASSERT_TRUE(idle());
  auto* tree = child<QTreeView>(*m_window->showPanel("library"), "motionTree");
  const auto* model = tree->model();
  ASSERT_EQ(model->rowCount(), 3);
  EXPECT_EQ(model->rowCount(model->index(0, 0)), 6);
  EXPECT_EQ(model->rowCount(model->index(1, 0)), 2);
  EXPECT_EQ(model->index(0, 0, model->index(2, 0)).data().toString().toStdString(),
            m_workspace->document().experiment().systems.front().name);
  // The box of a source is its own motions'.
  tree->model()->setData(model->index(1, 0), Qt::Checked, Qt::CheckStateRole);
  const int group = m_workspace->motions().groups().front().id;
  EXPECT_TRUE(m_workspace->motions().motion({group, 6})->visible);
  EXPECT_TRUE(m_workspace->motions().motion({group, 7})->visible);
  EXPECT_FALSE(m_workspace->motions().motion({group, 5})->visible);
  m_workspace->view().select({.motions = {{group, 7}}});
  EXPECT_TRUE(tree->selectionModel()->isRowSelected(1, model->index(1, 0)));
}

TEST_F(BackgroundWork, FilteringTheTreeSelectsNothingElse) {
  m_window->showPanel("library");
  const int group = m_workspace->motions().groups().front().id;
  m_workspace->view().select({.motions = {{group, 1}, {group, 2}}});
  auto* filter = child<QLineEdit>(*m_window, "motionFilter");
  QTest::keyClicks(filter, "zzz");
  EXPECT_EQ(m_workspace->view().selection().motions.size(), 2U);
  filter->clear();
  auto* tree = child<QTreeView>(*m_window, "motionTree");
  EXPECT_TRUE(tree->selectionModel()->isRowSelected(2, tree->model()->index(0, 0)));
}

}  // namespace
}  // namespace marey::gui
