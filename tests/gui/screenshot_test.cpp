// The whole window, light and dark, as it stands in the user guide. Pictures that change on purpose
// are copied over their baselines: NAME.actual.png lies where the test ran.
#include "gui/gui_support.h"

namespace marey::gui {
namespace {

/// Fonts and scenes are drawn by software, so pictures of one Debian release agree; what remains is
/// the rounding of other processors. A panel that moves or loses its content gives less than 0.9.
constexpr double kLeastSsim = 0.93;

class Screenshots : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    openWindow();
    openSmallDemo();
    m_workspace->edit("Samples", [](Experiment& e) {
      e.samples = 6;
      for (ExperimentPath& path : e.paths) path.seconds = 4.0;
    });
    m_workspace->setCurrentPath(2);
    m_workspace->sampleCurrentPath();
    ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
    m_workspace->scoreNatural(m_workspace->experiment().systems.front().name);
    ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
    m_workspace->setTime(2.0);
  }

  void take(Theme theme, const char* panel, const char* name) {
    m_window->setTheme(theme);
    m_window->showPanel(QString::fromLatin1(panel));
    settle(500);
    ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
    settle(700);
    expectLikeBaseline(pictureOf(*m_window), name, kLeastSsim);
  }
};

TEST_F(Screenshots, LightWithThePath) {
  take(Theme::Light, "path", "window-light");
}

TEST_F(Screenshots, DarkWithTheLikelihood) {
  take(Theme::Dark, "likelihood", "window-dark");
}

TEST_F(Screenshots, Distributions) {
  take(Theme::Light, "distributions", "window-distributions");
}

}  // namespace
}  // namespace marey::gui
