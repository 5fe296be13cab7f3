// What a document keeps of how it was looked at, and what the panels say of files and models.
#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTest>
#include <QTextBrowser>
#include <QTreeView>
#include <fstream>

#include "gui/document/model_card.h"
#include "gui/document/motion_tree.h"
#include "gui/exchange/import_dialog.h"
#include "gui/gui_support.h"
#include "gui/plots/chart_view.h"
#include "gui/scene/scene_view.h"
#include "gui/shell/offer_bar.h"

#include "base/tensor_file.h"
#include "experiment/edits.h"
#include "io/clip_io.h"

namespace marey::gui {
namespace {

namespace fs = std::filesystem;

class KeptView : public DemoTest {
 protected:
  SceneView& scene() {
    m_window->showPanel("scene");
    return *child<SceneView>(*m_window, "sceneView");
  }
  /// Saved, forgotten and opened.
  void saveAndOpen(const fs::path& saved) {
    m_workspace->save(QString::fromStdString(saved.string()));
    m_workspace->open({}, {});
    ASSERT_TRUE(idle());
    m_workspace->open(readExperiment(saved), QString::fromStdString(saved.string()));
    ASSERT_TRUE(idle());
  }
  std::vector<bool> naturalTicks() const {
    std::vector<bool> out;
    for (const Motion& motion : m_workspace->motions().groups().front().motions)
      out.push_back(motion.visible);
    return out;
  }
  /// `count` clips of the walker as files of a folder.
  std::vector<std::string> walkerFiles(const std::string& folder, size_t count) {
    fs::create_directories(file(folder));
    std::vector<std::string> out;
    const Clip& clip = *m_workspace->motions().groups().front().motions.front().clip;
    for (size_t i = 0; i < count; ++i) {
      out.push_back(file(folder + "/walk" + std::to_string(10 + i) + ".npz").string());
      io::writeClip(clip, out.back());
    }
    return out;
  }
};

TEST_F(KeptView, TicksCameraAndColoursComeBackWithTheDocument) {
  SceneView& view = scene();
  const int natural = m_workspace->motions().groups().front().id;
  m_workspace->motions().setVisible(natural, false);
  m_workspace->motions().setVisible(MotionId{natural, 4}, true);
  m_workspace->document().setCurrentPath(1);
  m_workspace->sampling().setSampled(m_workspace->document().experiment().systems.front().name,
                                     false);
  child<QComboBox>(*m_window, "sceneColourBy")->setCurrentIndex(3);
  child<QCheckBox>(*m_window, "sceneShadow")->setChecked(false);
  view.setView(render::View::Top);
  view.scene().orbit(0.3, -0.4);
  child<QAction>(*m_window, "sceneSaveCamera1")->trigger();
  view.scene().zoom(1.5);
  const CameraPose camera = view.camera();
  ASSERT_NO_FATAL_FAILURE(saveAndOpen(file("x.json")));
  EXPECT_EQ(naturalTicks(), (std::vector<bool>{false, false, false, false, true, false}));
  EXPECT_EQ(m_workspace->document().currentPath(), 1);
  EXPECT_FALSE(
      m_workspace->sampling().sampled(m_workspace->document().experiment().systems.front().name));
  EXPECT_EQ(child<QComboBox>(*m_window, "sceneColourBy")->currentIndex(), 3);
  EXPECT_EQ(view.settings().colourBy, ColourBy::Speed);
  EXPECT_FALSE(view.settings().shadow);
  settle();
  const auto near = [](const CameraPose& a, const CameraPose& b) {
    double most = std::abs(a.heightM - b.heightM);
    for (size_t i = 0; i < 3; ++i)
      most = std::max({most, std::abs(a.eye[i] - b.eye[i]), std::abs(a.target[i] - b.target[i])});
    return most < 1e-4;
  };
  EXPECT_PRED2(near, view.camera(), camera) << "the motions that were read moved it";
  child<QAction>(*m_window, "sceneLoadCamera1")->trigger();
  EXPECT_FALSE(near(view.camera(), camera)) << "the slot was lost";
  EXPECT_FALSE(m_workspace->modified()) << "looking at a document changes nothing in it";
  EXPECT_TRUE(m_errors.empty()) << m_errors.front();
}

TEST_F(KeptView, SetsAreOfferedAndComeBackBitForBit) {
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  const MotionGroup drawn = m_workspace->motions().groups().back();
  m_workspace->motions().setPinned(drawn.id, true);
  m_workspace->motions().setVisible(MotionId{drawn.id, 1}, false);
  // A checkpoint: a model that the document does not have.
  SampleRecipe other = *drawn.recipe;
  other.system = {
      "step 5",
      m_workspace->document().modelFile(m_workspace->document().experiment().systems.front()), 0.5};
  m_workspace->sampling().sample(other, -1, 15);
  ASSERT_TRUE(idle());
  const Clip checkpoint = *m_workspace->motions().groups().back().motions.front().clip;
  ASSERT_NO_FATAL_FAILURE(saveAndOpen(file("x.json")));
  auto* bar = child<OfferBar>(*m_window, "offerBar");
  EXPECT_TRUE(bar->isVisible());
  EXPECT_TRUE(child<QLabel>(*m_window, "offerText")->text().contains("2 sample sets"));
  EXPECT_EQ(m_workspace->motions().groups().size(), 1U) << "nobody asked for it yet";
  child<QPushButton>(*m_window, "offerSample")->click();
  ASSERT_TRUE(idle());
  EXPECT_FALSE(bar->isVisible());
  ASSERT_EQ(m_workspace->motions().groups().size(), 3U);
  const MotionGroup& back = m_workspace->motions().groups()[1];
  EXPECT_TRUE(back.pinned);
  ASSERT_EQ(back.motions.size(), drawn.motions.size());
  for (size_t i = 0; i < back.motions.size(); ++i)
    EXPECT_EQ(back.motions[i].clip->positions, drawn.motions[i].clip->positions);
  EXPECT_TRUE(back.motions[0].visible);
  EXPECT_FALSE(back.motions[1].visible);
  EXPECT_EQ(m_workspace->motions().groups()[2].motions.front().clip->positions,
            checkpoint.positions);
  EXPECT_EQ(m_workspace->motions().groups()[2].colourIndex, 15);
}

TEST_F(KeptView, SamplesThatAreLeftOutStaySoWithTheirSet) {
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  const int drawn = m_workspace->motions().groups().back().id;
  m_workspace->motions().setPinned(drawn, true);
  m_workspace->save(QString::fromStdString(file("x.json").string()));
  ASSERT_FALSE(m_window->isWindowModified());
  m_workspace->setUsed({{drawn, 1}}, false);
  EXPECT_TRUE(m_window->isWindowModified()) << "what was left out would be lost in silence";
  ASSERT_NO_FATAL_FAILURE(saveAndOpen(file("x.json")));
  EXPECT_FALSE(m_window->isWindowModified());
  // Twice: what is offered is kept as it is, too.
  ASSERT_NO_FATAL_FAILURE(saveAndOpen(file("x.json")));
  child<QPushButton>(*m_window, "offerSample")->click();
  ASSERT_TRUE(idle());
  const std::vector<Motion>& motions = m_workspace->motions().groups().back().motions;
  ASSERT_EQ(motions.size(), 2U);
  EXPECT_TRUE(motions[0].used);
  EXPECT_FALSE(motions[1].used);
  EXPECT_TRUE(motions[1].visible) << "it was hidden, too";
  EXPECT_FALSE(m_window->isWindowModified());
}

TEST_F(KeptView, PinningASetIsAChangeOfTheDocument) {
  m_workspace->save(QString::fromStdString(file("x.json").string()));
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  EXPECT_FALSE(m_window->isWindowModified()) << "what can be sampled again is nothing to lose";
  m_workspace->motions().setPinned(m_workspace->motions().groups().back().id, true);
  EXPECT_TRUE(m_window->isWindowModified());
  m_workspace->motions().setPinned(m_workspace->motions().groups().back().id, false);
  EXPECT_FALSE(m_window->isWindowModified());
  m_workspace->motions().setPinned(m_workspace->motions().groups().back().id, true);
  ASSERT_NO_FATAL_FAILURE(saveAndOpen(file("x.json")));
  EXPECT_FALSE(m_window->isWindowModified());
  child<QPushButton>(*m_window, "offerSample")->click();
  ASSERT_TRUE(idle());
  EXPECT_FALSE(m_window->isWindowModified()) << "it is as it was saved";
  m_workspace->motions().remove(m_workspace->motions().groups().back().id);
  EXPECT_TRUE(m_window->isWindowModified());
}

TEST_F(KeptView, SetsThatWereNotDrawnAgainStayInTheDocumentUntilTheyAreLeftOut) {
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  ASSERT_NO_FATAL_FAILURE(saveAndOpen(file("x.json")));
  ASSERT_NO_FATAL_FAILURE(saveAndOpen(file("x.json")));
  EXPECT_EQ(m_workspace->kept().offered().size(), 1U);
  child<QPushButton>(*m_window, "offerDismiss")->click();
  m_workspace->save(QString::fromStdString(file("x.json").string()));
  EXPECT_TRUE(readExperiment(file("x.json")).view.sets.empty());
}

TEST_F(KeptView, ADocumentThatIsMovedWithItsDataOpens) {
  const auto walks = walkerFiles("study/walks", 2);
  fs::create_directories(file("study/models"));
  const std::string model = file("study/models/m.marey").string();
  fs::copy_file(
      m_workspace->document().modelFile(m_workspace->document().experiment().systems.front()),
      model);
  m_workspace->document().edit("Study", [&](Experiment& e) {
    e.natural = walks;
    e.systems.front().model = model;
  });
  ASSERT_TRUE(idle());
  m_workspace->save(QString::fromStdString(file("study/x.json").string()));
  fs::rename(file("study"), file("moved"));
  m_workspace->open(readExperiment(file("moved/x.json")), {});
  ASSERT_TRUE(idle());
  EXPECT_TRUE(m_errors.empty()) << m_errors.front();
  ASSERT_EQ(m_workspace->motions().groups().size(), 1U);
  EXPECT_EQ(m_workspace->motions().groups().front().motions.size(), 2U);
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  EXPECT_TRUE(m_errors.empty()) << m_errors.front();
  EXPECT_EQ(m_workspace->motions().groups().size(), 2U);
}

TEST_F(KeptView, SavingInAnotherFolderForgetsNeitherSetsNorTicks) {
  const auto walks = walkerFiles("study/walks", 3);
  m_workspace->document().edit("Study", [&](Experiment& e) { e.natural = walks; });
  ASSERT_TRUE(idle());
  m_workspace->motions().setVisible(m_workspace->motions().groups().front().id, false);
  m_workspace->motions().setVisible(MotionId{m_workspace->motions().groups().front().id, 2}, true);
  m_workspace->sampling().sampleCurrentPath();
  m_workspace->sampling().sampleHeldOut();
  ASSERT_TRUE(idle());
  const MotionGroup drawn = m_workspace->motions().groups()[1];
  m_workspace->save(QString::fromStdString(file("study/x.json").string()));
  EXPECT_EQ(m_workspace->motions().groups().front().motions[2].source,
            m_workspace->document().experiment().natural[2]);
  EXPECT_TRUE(m_workspace->sampling().withoutHeldOut().empty()) << "nothing in it has changed";
  fs::create_directories(file("other"));
  ASSERT_NO_FATAL_FAILURE(saveAndOpen(file("other/y.json")));
  EXPECT_EQ(naturalTicks(), (std::vector<bool>{false, false, true}));
  ASSERT_NO_FATAL_FAILURE(saveAndOpen(file("study/z.json")));
  child<QPushButton>(*m_window, "offerSample")->click();
  ASSERT_TRUE(idle());
  EXPECT_TRUE(m_errors.empty()) << m_errors.front();
  ASSERT_EQ(m_workspace->motions().groups().size(), 3U);
  const MotionGroup& back = m_workspace->motions().groups()[1];
  ASSERT_EQ(back.motions.size(), drawn.motions.size());
  EXPECT_EQ(back.motions[0].clip->positions, drawn.motions[0].clip->positions);
  EXPECT_EQ(m_workspace->motions().groups()[2].motions.size(), 3U);
  EXPECT_TRUE(m_workspace->sampling().withoutHeldOut().empty());
}

TEST_F(KeptView, ThirtyFilesAreOneGroupAndRemovingOneLeavesTheTicksOfOthers) {
  const auto files = walkerFiles("walks", 30);
  m_workspace->document().edit("Files", [&](Experiment& e) { addNatural(e, files); });
  ASSERT_TRUE(idle());
  MotionTree tree(*m_workspace);
  ASSERT_EQ(tree.rowCount(), 3) << "the walker, the files, the models";
  const QModelIndex branch = tree.index(1, MotionTree::Name);
  EXPECT_EQ(tree.rowCount(branch), 30);
  EXPECT_TRUE(tree.data(branch, Qt::DisplayRole).toString().contains("walks"));
  EXPECT_EQ(tree.sourcesOf(branch).size(), 30U);
  EXPECT_EQ(tree.sourcesOf(tree.index(4, 0, branch)), std::vector<std::string>{files[4]});
  const int natural = m_workspace->motions().groups().front().id;
  m_workspace->motions().setVisible(natural, false);
  m_workspace->motions().setVisible(MotionId{natural, 6 + 20}, true);
  m_workspace->document().edit("Remove", [&](Experiment& e) { removeNatural(e, files[3]); });
  ASSERT_TRUE(idle());
  std::vector<bool> expected(35, false);
  expected[6 + 19] = true;
  EXPECT_EQ(naturalTicks(), expected);
}

TEST_F(KeptView, AModelIsAddedWithItsTemperatureAndItsCardCanBeRead) {
  TensorFile model = readTensorFile(
      m_workspace->document().modelFile(m_workspace->document().experiment().systems.front()));
  model.metadata["card"] = "# Walker\n\nFor tests of *walking*.";
  model.metadata["recommended"] = {{"temperature", 0.65}};
  writeTensorFile(file("carded.marey"), model);
  m_window->files().openFiles({QString::fromStdString(file("carded.marey").string())});
  ASSERT_TRUE(idle());
  ASSERT_EQ(m_workspace->document().experiment().systems.size(), 2U);
  EXPECT_EQ(m_workspace->document().experiment().systems[1].temperature, 0.65);
  m_workspace->document().edit("Hotter", [](Experiment& e) { e.systems[1].temperature = 1.0; });
  showModelCard(*m_workspace, 1, m_window.get());
  ASSERT_TRUE(waitUntil([&] { return m_window->findChild<QDialog*>("modelCard") != nullptr; }));
  auto* dialog = child<QDialog>(*m_window, "modelCard");
  const QString text = child<QTextBrowser>(*dialog, "modelCardText")->toPlainText();
  EXPECT_TRUE(text.contains("For tests of walking")) << text.toStdString();
  EXPECT_TRUE(text.contains("0.65"));
  EXPECT_TRUE(text.contains("\"hidden\"")) << "its hyper-parameters";
  child<QPushButton>(*dialog, "modelCardUse")->click();
  EXPECT_EQ(m_workspace->document().experiment().systems[1].temperature, 0.65);
}

TEST_F(KeptView, TheFitKeyFillsTheView) {
  SceneView& view = scene();
  m_workspace->motions().setVisible(m_workspace->motions().groups().front().id, true);
  settle();
  view.scene().zoom(0.2);
  QTest::keyClick(&view, Qt::Key_F);
  double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
  for (const render::SceneMotion& motion : view.content().motions)
    for (int t = 0; t < motion.clip->frameCount(); ++t)
      for (int j = 0; j < motion.clip->jointCount(); ++j) {
        const auto at =
            view.scene().screenPoint(motion.clip->at(t, j), view.width(), view.height());
        low[0] = std::min(low[0], at.x), high[0] = std::max(high[0], at.x);
        low[1] = std::min(low[1], at.y), high[1] = std::max(high[1], at.y);
      }
  EXPECT_GE(std::min(low[0], low[1]), 0.0);
  EXPECT_LE(high[0], view.width());
  EXPECT_LE(high[1], view.height());
  const double filled =
      std::max((high[0] - low[0]) / view.width(), (high[1] - low[1]) / view.height());
  EXPECT_GT(filled, 0.8);
}

TEST_F(KeptView, ABrokenFilesReasonIsReadWhole) {
  std::ofstream(file("broken.bvh")) << "HIERARCHY\nROOT Hips\n{\nOFFSET zero 0 0\n";
  showImportDialog(*m_workspace, {QString::fromStdString(file("broken.bvh").string())},
                   m_window.get());
  ASSERT_TRUE(idle());
  auto* reason = child<QLabel>(*m_window, "importReason");
  ASSERT_TRUE(waitUntil([&] { return reason->isVisible(); }, 5.0));
  EXPECT_TRUE(reason->text().contains("zero")) << reason->text().toStdString();
  EXPECT_TRUE(reason->text().contains("broken.bvh"));
  EXPECT_TRUE(reason->wordWrap());
  EXPECT_TRUE(reason->textInteractionFlags().testFlag(Qt::TextSelectableByMouse));
  EXPECT_GE(reason->height(), reason->heightForWidth(reason->width())) << "it is cut";
}

TEST_F(KeptView, APlotNamesTheMotionUnderTheMouse) {
  m_window->showPanel("likelihood");
  auto* chart = child<ChartView>(*m_window, "likelihoodChart");
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  auto* single = child<QComboBox>(*m_window, "likelihoodView");
  single->setCurrentIndex(single->count() - 1);
  settle(600);
  ASSERT_TRUE(idle());
  std::set<QString> names;
  for (int y = 0; y < chart->height(); ++y)
    for (int x = 0; x < chart->width(); x += 8)
      for (const QString& line : chart->textAt({x, y}).split(u'\n')) names.insert(line);
  const std::string name = m_workspace->motions().groups().back().motions.front().clip->name;
  EXPECT_TRUE(names.count(QString::fromStdString(name))) << name;
}

}  // namespace
}  // namespace marey::gui
