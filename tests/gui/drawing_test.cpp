// The 3D view draws as an offscreen picture of the same scene does, whatever window it is in, and
// the program says how long its start took.
#include <QElapsedTimer>
#include <QProcess>
#include <QRegularExpression>

#include "gui/gui_support.h"
#include "gui/scene/scene_view.h"

#include "render/base/ssim.h"
#include "render/scene/scene_picture.h"

namespace marey::gui {
namespace {

class Drawing : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    openWindow();
    openSmallDemo();
    m_window->showPanel("scene");
    m_view = child<SceneView>(*m_window, "sceneView");
    settle();
  }
  render::Image shown() const {
    const QImage shot = m_view->grabFramebuffer().convertToFormat(QImage::Format_RGBA8888);
    render::Image out(shot.width(), shot.height());
    for (int y = 0; y < shot.height(); ++y)
      std::copy_n(shot.constScanLine(y), 4 * static_cast<size_t>(shot.width()), out.at(0, y));
    return out;
  }
  /// The same scene, drawn by itself.
  render::Image wanted() const {
    const render::Scene& scene = m_view->scene();
    render::Scene copy;
    copy.setMotions(scene.motions());
    copy.setOptions(scene.options());
    copy.setTime(scene.time());
    copy.setViewpoint(scene.viewpoint());
    m_view->doneCurrent();  // a thread has one context at a time
    return render::ScenePicture().take(copy, m_view->width(), m_view->height());
  }
  void expectAsWanted(const char* when) const {
    const render::Image is = shown(), should = wanted();
    ASSERT_EQ(is.width, should.width) << when;
    ASSERT_EQ(is.height, should.height) << when;
    EXPECT_GT(render::ssim(is, should), 0.995) << when;
  }
  void play() {
    for (int frame = 1; frame <= 4; ++frame) {
      m_workspace->view().setTime(0.1 * frame);
      settle(60);
    }
  }

  SceneView* m_view = nullptr;
};

TEST_F(Drawing, IsTheSameWhileTheFloorIsCopiedResizedAndTornOff) {
  play();
  EXPECT_TRUE(m_view->scene().cost().floorCopied);
  expectAsWanted("playing");
  m_window->resize(m_window->width() - 160, m_window->height() - 90);
  settle();
  play();
  expectAsWanted("resized");
  QWidget* dock = m_view;
  while (dock != nullptr && !dock->inherits("ads::CDockWidget")) dock = dock->parentWidget();
  ASSERT_NE(dock, nullptr);
  // Another window, thus another context.
  ASSERT_TRUE(QMetaObject::invokeMethod(dock, "setFloating"));
  settle();
  ASSERT_NE(m_view->window(), m_window.get());
  play();
  EXPECT_TRUE(m_view->scene().cost().floorCopied);
  expectAsWanted("torn off");
}

TEST_F(Drawing, CrowdsAreLinesOfTheSameWidthAsOffscreen) {
  EXPECT_TRUE(m_view->format().testOption(QSurfaceFormat::DeprecatedFunctions))
      << "without what is deprecated, lines are a pixel wide";
  SceneSettings settings = m_view->settings();
  settings.detail = render::BodyDetail::Lines;
  m_view->setSettings(settings);
  settle();
  play();
  ASSERT_TRUE(m_view->scene().cost().lines);
  expectAsWanted("lines");
}

TEST_F(Drawing, TheProgramSaysHowLongItsStartTook) {
  QProcess program;
  QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
  environment.insert(QStringLiteral("QT_LOGGING_RULES"), QStringLiteral("marey.start=true"));
  program.setProcessEnvironment(environment);
  program.setProcessChannelMode(QProcess::MergedChannels);
  QElapsedTimer clock;
  clock.start();
  program.start(QStringLiteral(MAREY_WORKBENCH), QStringList());
  QString said;
  const QRegularExpression line(QStringLiteral("motions are shown ([0-9.]+) s after the start"));
  ASSERT_TRUE(waitUntil([&] {
    said += QString::fromLocal8Bit(program.readAll());
    return line.match(said).hasMatch();
  })) << said.toStdString();
  const double seen = 1e-3 * static_cast<double>(clock.elapsed());
  const double told = line.match(said).captured(1).toDouble();
  program.kill();
  program.waitForFinished();
  EXPECT_LT(told, seen + 0.1);
  // On a busy machine the line is read late: no more than that it speaks of seconds.
  EXPECT_GT(told, 0.01 * seen);
}

}  // namespace
}  // namespace marey::gui
