// The window with real motion capture that lies beside the project, and the model that was trained
// on such: held-out clips and a hundred samples along a drawn path are open together.
#include <QAction>
#include <QComboBox>
#include <QPushButton>
#include <QTableWidget>
#include <QTest>
#include <chrono>
#include <cstdlib>
#include <filesystem>

#include "gui/gui_support.h"
#include "gui/path/path_view.h"
#include "gui/scene/scene_view.h"
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>

namespace marey::gui {
namespace {

namespace fs = std::filesystem;
constexpr int kSamples = 100;

double nowMs() {
  const std::chrono::duration<double, std::milli> now =
      std::chrono::steady_clock::now().time_since_epoch();
  return now.count();
}

class RealDataWindow : public WindowTest {
 protected:
  void SetUp() override {
    const fs::path list = fs::path(MAREY_SHARED_DIR) / "data" / "bandai" / "test.txt";
    if (!fs::exists(list)) {
      if (std::getenv("CI") != nullptr) FAIL() << "the data is not there: " << list;
      GTEST_SKIP() << "real motion data is not there: " << list;
    }
    WindowTest::SetUp();
    Experiment document;
    document.title = "Held-out clips";
    document.natural = {"@" + list.string()};
    document.systems = {
        {"MG+", std::string(MAREY_SOURCE_DIR) + "/resources/models/moglow-plus-small.marey", 0.8}};
    document.paths = {{.name = "Drawn", .path = "preset:turn-left", .seconds = 6.0}};
    document.samples = kSamples;
    document.heldOutSamples = 0;
    openWindow();
    m_workspace->open(document, {});
    ASSERT_TRUE(idle());
  }

  bool idle() {
    return waitUntil([this] { return m_jobs->idle(); }, 240.0);
  }

  /// Makes the preset a path of way-points and drags its last one aside.
  void drawPath() {
    QWidget* panel = m_window->showPanel("path");
    settle();
    QTest::mouseClick(child<QPushButton>(*panel, "pathMakeEditable"), Qt::LeftButton);
    ASSERT_TRUE(idle());
    auto* top = child<PathView>(*panel, "pathView");
    settle();
    const WayPoint last = m_workspace->document().experiment().paths.front().wayPoints.back();
    const QPoint from = top->toScreen(last.x, last.z).toPoint(), to = from + QPoint(-35, 20);
    QTest::mousePress(top, Qt::LeftButton, {}, from);
    for (const QPoint& at : {from + (to - from) / 2, to}) {
      QMouseEvent move(QEvent::MouseMove, at, top->mapToGlobal(at), Qt::NoButton, Qt::LeftButton,
                       Qt::NoModifier);
      QApplication::sendEvent(top, &move);
    }
    QTest::mouseRelease(top, Qt::LeftButton, {}, to);
    EXPECT_NE(m_workspace->document().experiment().paths.front().wayPoints.back(), last);
  }

  /// Wall time from each of some new times until the screen has the scene of that time: what the
  /// scene draws first after it, and then the window's swap.
  std::vector<double> scrub() {
    auto* scene = child<SceneView>(*m_window, "sceneView");
    bool drawn = false, shown = false;
    vtkNew<vtkCallbackCommand> watch;
    watch->SetClientData(&drawn);
    watch->SetCallback([](vtkObject* /*window*/, unsigned long /*event*/, void* flag,
                          void* /*data*/) { *static_cast<bool*>(flag) = true; });
    const auto observer = scene->renderWindow()->AddObserver(vtkCommand::EndEvent, watch);
    const auto swaps =
        QObject::connect(scene, &QOpenGLWidget::frameSwapped, [&] { shown = shown || drawn; });
    std::vector<double> ms;
    for (int i = 1; i <= 40; ++i) {
      settle(20);
      drawn = shown = false;
      const double begin = nowMs();
      m_workspace->view().setTime(0.125 * i);
      EXPECT_TRUE(waitUntil([&] { return shown; }, 10.0));
      ms.push_back(nowMs() - begin);
    }
    QObject::disconnect(swaps);
    scene->renderWindow()->RemoveObserver(observer);
    return ms;
  }

  /// Keeps a picture where MAREY_PICTURES names a folder, for a look by eye.
  void keepPicture(const std::string& name) {
    const char* folder = std::getenv("MAREY_PICTURES");
    if (folder == nullptr) return;
    settle(300);
    m_window->grab().save(QString::fromStdString(std::string(folder) + "/" + name + ".png"));
  }
};

TEST_F(RealDataWindow, HoldsHeldOutClipsAndAHundredSamplesAlongADrawnPath) {
  ASSERT_TRUE(m_errors.empty()) << m_errors.front();
  ASSERT_EQ(m_workspace->motions().groups().size(), 1U);
  EXPECT_EQ(m_workspace->motions().groups().front().motions.size(), 101U);
  drawPath();
  const double begin = nowMs();
  m_workspace->sampling().sampleCurrentPath();
  ASSERT_TRUE(idle());
  std::printf("sampling and scoring %d motions of 6 s: %.0f ms\n", kSamples, nowMs() - begin);
  ASSERT_EQ(m_workspace->motions().groups().size(), 2U);
  const MotionGroup& samples = m_workspace->motions().groups().back();
  ASSERT_EQ(samples.motions.size(), static_cast<size_t>(kSamples));
  for (const Motion& motion : samples.motions)
    for (const Vec3& place : motion.clip->positions) ASSERT_TRUE(place.allFinite());

  for (const PanelSpec& spec : panels()) {
    SCOPED_TRACE(spec.id.toStdString());
    const double shown = nowMs();
    QWidget* panel = m_window->showPanel(spec.id);
    settle(50);
    if (spec.id == QLatin1String("statistics"))
      QTest::mouseClick(child<QPushButton>(*panel, "statisticsCompute"), Qt::LeftButton);
    ASSERT_TRUE(idle());
    if (spec.id == QLatin1String("statistics")) {
      EXPECT_GT(child<QTableWidget>(*panel, "statisticsTable")->rowCount(), 0);
    }
    EXPECT_TRUE(waitUntil([&] { return showsSomething(pictureOf(*panel)); }, 30.0));
    std::printf("%s: %.0f ms until it has all it shows\n", spec.id.toStdString().c_str(),
                nowMs() - shown);
    keepPicture(spec.id.toStdString());
  }
  m_window->showPanel("scene");
  settle();
  std::vector<double> ms = scrub();
  std::sort(ms.begin(), ms.end());
  std::printf("scrubbing through 201 motions: median %.0f ms, worst %.0f ms\n", ms[ms.size() / 2],
              ms.back());
  m_workspace->view().select({.motions = {{samples.id, 3}}});
  keepPicture("selection");
  EXPECT_TRUE(m_errors.empty()) << m_errors.front();
}

}  // namespace
}  // namespace marey::gui
