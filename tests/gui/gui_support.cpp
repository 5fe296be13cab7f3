#include "gui/gui_support.h"

#include <QApplication>
#include <QElapsedTimer>
#include <QMessageBox>
#include <QStandardPaths>
#include <QThread>
#include <fstream>

#include "render/base/ssim.h"

namespace marey::gui {

bool waitUntil(const std::function<bool()>& ready, double seconds) {
  QElapsedTimer clock;
  clock.start();
  while (!ready()) {
    if (clock.elapsed() > 1000.0 * seconds) return false;
    QApplication::processEvents(QEventLoop::AllEvents, 20);
    QThread::msleep(2);
  }
  return true;
}

void settle(int milliseconds) {
  QElapsedTimer clock;
  clock.start();
  waitUntil([&] { return clock.elapsed() > milliseconds; });
}

render::Image pictureOf(QWidget& widget) {
  const QImage shot = widget.grab().toImage().convertToFormat(QImage::Format_RGBA8888);
  render::Image out(shot.width(), shot.height());
  for (int y = 0; y < shot.height(); ++y)
    std::copy_n(shot.constScanLine(y), 4 * static_cast<size_t>(shot.width()), out.at(0, y));
  return out;
}

bool showsSomething(const render::Image& image) {
  const uint8_t* first = image.at(image.width / 2, image.height / 2);
  size_t others = 0;
  for (size_t i = 0; i < image.pixels.size(); i += 4)
    for (size_t c = 0; c < 3; ++c)
      others += std::abs(int(image.pixels[i + c]) - int(first[c])) > 24 ? 1 : 0;
  return others > 300;
}

void expectLikeBaseline(const render::Image& image, const std::string& name, double leastSsim) {
  const std::filesystem::path baseline =
      std::filesystem::path(MAREY_SOURCE_DIR) / "tests/gui/baselines" / (name + ".png");
  const std::filesystem::path actual = std::filesystem::current_path() / (name + ".actual.png");
  render::writePng(actual, image);
  ASSERT_TRUE(std::filesystem::exists(baseline))
      << "no baseline " << baseline << "; the picture is " << actual;
  const render::Image wanted = render::readPng(baseline);
  ASSERT_EQ(image.width, wanted.width);
  ASSERT_EQ(image.height, wanted.height);
  EXPECT_GE(render::ssim(image, wanted), leastSsim) << "the picture is " << actual;
}

void WindowTest::SetUp() {
  ASSERT_TRUE(m_folder.isValid());
  // Settings, autosave and the unpacked demonstration of one test are no other's.
  qputenv("XDG_CONFIG_HOME", (m_folder.path() + "/config").toUtf8());
  qputenv("XDG_DATA_HOME", (m_folder.path() + "/data").toUtf8());
  m_jobs = std::make_unique<JobQueue>();
  m_workspace = std::make_unique<Workspace>(*m_jobs, Experiment{});
  QObject::connect(m_workspace.get(), &Workspace::errorReported,
                   [this](const QString& title, const QString& error) {
                     m_errors.push_back((title + ": " + error).toStdString());
                   });
}

void WindowTest::TearDown() {
  m_window.reset();
  m_workspace.reset();
  m_jobs.reset();
}

void WindowTest::openWindow() {
  m_window.reset();
  m_window = std::make_unique<MainWindow>(*m_workspace, panels());
  m_window->resize(1500, 920);
  m_window->show();
  // Shortcuts are those of the active window; without a window manager nobody makes it so.
  m_window->activateWindow();
  QApplication::setActiveWindow(m_window.get());
  settle();
}

bool WindowTest::idle() {
  return waitUntil([this] { return m_jobs->idle(); });
}

std::filesystem::path WindowTest::file(const std::string& name) const {
  return std::filesystem::path(m_folder.path().toStdString()) / name;
}

void WindowTest::openSmallDemo() {
  Experiment demo = demoDocument();
  demo.natural = {"walker:6,4,90210"};
  demo.samples = 2;
  for (ExperimentPath& path : demo.paths) path.seconds = 2.0;
  m_workspace->open(demo, {});
  ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
  ASSERT_EQ(m_workspace->motions().groups().size(), 1U);
}

void DemoTest::SetUp() {
  WindowTest::SetUp();
  openWindow();
  openSmallDemo();
}

void writeSmallBvh(const std::filesystem::path& path) {
  std::ofstream out(path);
  out << "HIERARCHY\nROOT Hips\n{\nOFFSET 0 90 0\nCHANNELS 3 Xposition Yposition Zposition\n"
         "JOINT Head\n{\nOFFSET 0 60 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
         "End Site\n{\nOFFSET 0 10 0\n}\n}\n}\nMOTION\nFrames: 40\nFrame Time: 0.05\n";
  for (int frame = 0; frame < 40; ++frame) out << "0 90 " << frame << " 0 0 0\n";
}

}  // namespace marey::gui
