// One sitting with mouse and keys alone, from the demonstration to a document that is saved and
// opened again, with pictures of the whole window on the way.
#include <QAction>
#include <QApplication>
#include <QComboBox>
#include <QFileDialog>
#include <QLineEdit>
#include <QMessageBox>
#include <QPushButton>
#include <QTest>
#include <QTimer>
#include <QToolButton>
#include <numbers>

#include "gui/gui_support.h"
#include "gui/path/path_view.h"
#include "gui/plots/chart_view.h"
#include "gui/scene/scene_view.h"

namespace marey::gui {
namespace {

class MouseJourney : public DemoTest {
 protected:
  template <typename T>
  T* inPanel(const char* panel, const char* name) {
    return child<T>(*m_window->showPanel(QString::fromLatin1(panel)), name);
  }

  void click(const char* panel, const char* name) {
    auto* button = inPanel<QAbstractButton>(panel, name);
    settle(50);
    ASSERT_TRUE(button->isEnabled()) << name;
    QTest::mouseClick(button, Qt::LeftButton);
  }

  static void drag(QWidget* widget, const QPoint& from, const QPoint& to) {
    QTest::mousePress(widget, Qt::LeftButton, {}, from);
    for (int i = 1; i <= 8; ++i) {
      const QPoint at = from + (to - from) * i / 8;
      QMouseEvent move(QEvent::MouseMove, at, widget->mapToGlobal(at), Qt::NoButton, Qt::LeftButton,
                       Qt::NoModifier);
      QApplication::sendEvent(widget, &move);
      settle(15);
    }
    QTest::mouseRelease(widget, Qt::LeftButton, {}, to);
    settle(50);
  }

  /// Answers the next file dialog with a name, as typed into its field.
  void typeIntoFileDialog(const QString& file) {
    QTimer::singleShot(300, m_window.get(), [file] {
      for (QWidget* top : QApplication::topLevelWidgets()) {
        auto* dialog = qobject_cast<QFileDialog*>(top);
        if (dialog == nullptr || !dialog->isVisible()) continue;
        auto* name = dialog->findChild<QLineEdit*>(QStringLiteral("fileNameEdit"));
        name->setText(file);
        QTest::keyClick(name, Qt::Key_Return);
      }
    });
  }

  /// A place in the scene where a click would hit a body.
  std::optional<QPoint> bodyIn(SceneView& view) {
    for (int y = 10; y < view.height(); y += 6)
      for (int x = 10; x < view.width(); x += 6)
        if (view.scene().pick(x, y, view.width(), view.height())) return QPoint(x, y);
    return std::nullopt;
  }
};

TEST_F(MouseJourney, DrawsAPathSamplesPicksBrushesUndoesSavesAndReopens) {
  // A preset becomes way-points; one of them is dragged.
  m_window->showPanel("path");
  auto* choice = inPanel<QComboBox>("path", "pathChoice");
  choice->setCurrentIndex(choice->count() - 1);
  Q_EMIT choice->activated(choice->count() - 1);
  click("path", "pathMakeEditable");
  ASSERT_TRUE(idle());
  const auto path = [this] {
    return m_workspace->document()
        .experiment()
        .paths[static_cast<size_t>(m_workspace->document().currentPath())];
  };
  ASSERT_GE(path().wayPoints.size(), 2U);
  auto* top = inPanel<PathView>("path", "pathView");
  settle();
  const WayPoint before = path().wayPoints.back();
  const QPoint from = top->toScreen(before.x, before.z).toPoint();
  const size_t edits = m_workspace->document().history().size();
  drag(top, from, from + QPoint(-30, 25));
  const WayPoint after = path().wayPoints.back();
  EXPECT_GT(after.x, before.x) << "the left of the picture is the walker's left, +X";
  EXPECT_LT(after.z, before.z);
  EXPECT_EQ(m_workspace->document().history().size(), edits + 1) << "a drag is one edit";

  // The knob of the way-point that was dragged turns the body there, in both views.
  const auto knob = top->knob();
  ASSERT_TRUE(knob);
  EXPECT_FALSE(path().wayPoints.back().facing);
  const QPoint end = top->toScreen(after.x, after.z).toPoint();
  drag(top, knob->toPoint(), end + QPoint(-40, 0));
  ASSERT_TRUE(path().wayPoints.back().facing);
  EXPECT_NEAR(*path().wayPoints.back().facing, std::numbers::pi / 2, 0.05) << "to +X, the left";
  EXPECT_EQ(path().wayPoints.back().x, after.x);
  auto* floor = inPanel<SceneView>("scene", "sceneView");
  click("scene", "sceneEditPath");
  settle();
  const auto seen = [&](double x, double z) {
    const auto at = floor->scene().screenPoint({static_cast<float>(x), 0.F, static_cast<float>(z)},
                                               floor->width(), floor->height());
    return QPointF(at.x, at.y).toPoint();
  };
  QTest::mouseClick(floor, Qt::LeftButton, {}, seen(after.x, after.z));
  drag(floor, seen(after.x + 0.6, after.z), seen(after.x, after.z + 0.8));
  EXPECT_NEAR(*path().wayPoints.back().facing, 0.0, 0.05) << "along +Z";
  EXPECT_EQ(path().wayPoints.back().x, after.x);
  click("scene", "sceneEditPath");
  for (int turn = 0; turn < 2; ++turn) m_workspace->document().undo();
  EXPECT_EQ(path().wayPoints.back(), after);

  // Sampled along it, and a body picked in the scene.
  click("sampling", "sampleButton");
  ASSERT_TRUE(idle());
  ASSERT_EQ(m_workspace->motions().groups().size(), 2U);
  auto* scene = inPanel<SceneView>("scene", "sceneView");
  settle(400);
  const auto body = bodyIn(*scene);
  ASSERT_TRUE(body);
  QTest::mouseClick(scene, Qt::LeftButton, {}, *body);
  ASSERT_EQ(m_workspace->view().selection().motions.size(), 1U);
  EXPECT_TRUE(m_workspace->view().selection().joint);
  QTest::mouseClick(scene, Qt::LeftButton, {}, {3, scene->height() - 3});
  EXPECT_TRUE(m_workspace->view().selection().motions.empty())
      << "a click beside bodies selects none";

  // A range brushed over the likelihoods is the range of every panel.
  auto* chart = inPanel<ChartView>("likelihood", "likelihoodChart");
  ASSERT_TRUE(waitUntil([&] { return !chart->frames().empty() && m_jobs->idle(); }));
  const render::ChartFrame frame = chart->frames().front();
  const int middle = static_cast<int>((frame.top + frame.bottom) / 2);
  const double width = frame.right - frame.left;
  drag(chart, {static_cast<int>(frame.left + 0.25 * width), middle},
       {static_cast<int>(frame.left + 0.75 * width), middle});
  ASSERT_TRUE(m_workspace->view().range());
  EXPECT_NEAR(m_workspace->view().range()->beginS, frame.dataX(frame.left + 0.25 * width), 0.06);
  EXPECT_NEAR(m_workspace->view().range()->endS, frame.dataX(frame.left + 0.75 * width), 0.06);

  // Keys: play, then one frame on.
  scene->setFocus();
  QTest::keyClick(scene, Qt::Key_Space);
  ASSERT_TRUE(waitUntil(
      [this] { return m_workspace->view().time() > m_workspace->view().range()->beginS; }, 5));
  QTest::keyClick(scene, Qt::Key_Space);
  const double stopped = m_workspace->view().time();
  QTest::keyClick(scene, Qt::Key_Period);
  EXPECT_NEAR(m_workspace->view().time() - stopped, 1.0 / m_workspace->document().experiment().fps,
              0.051);
  m_workspace->view().setRange(std::nullopt);
  m_workspace->view().setTime(1.0);
  settle(400);
  expectLikeBaseline(pictureOf(*m_window), "journey-sampled", 0.9);

  // Undone, done again, saved under a new name, changed, and opened again.
  m_window->menus().command("undo")->trigger();
  EXPECT_EQ(path().wayPoints.back(), before);
  m_window->menus().command("redo")->trigger();
  EXPECT_EQ(path().wayPoints.back(), after);
  const QString file = m_folder.path() + "/sitting.json";
  typeIntoFileDialog(file);
  m_window->menus().command("saveAs")->trigger();
  ASSERT_TRUE(QFile::exists(file));
  EXPECT_FALSE(m_workspace->modified());
  const Experiment saved = m_workspace->document().experiment();
  m_workspace->open(Experiment{}, {});
  typeIntoFileDialog(file);
  m_window->menus().command("open")->trigger();
  ASSERT_TRUE(idle());
  EXPECT_EQ(m_workspace->document().experiment(), saved);
  EXPECT_EQ(m_workspace->document().file(), file);
  EXPECT_TRUE(m_errors.empty()) << m_errors.front();
}

}  // namespace
}  // namespace marey::gui
