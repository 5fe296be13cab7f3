// The whole window, light and dark, as it stands in the user guide. Pictures that change on purpose
// are copied over their baselines: NAME.actual.png lies where the test ran.
#include <QAbstractItemView>
#include <QPushButton>

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
    m_workspace->document().edit("Samples", [](Experiment& e) {
      e.samples = 6;
      for (ExperimentPath& path : e.paths) path.seconds = 4.0;
    });
    m_workspace->document().setCurrentPath(2);
    m_workspace->sampling().sampleCurrentPath();
    ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
    m_workspace->natural().score(m_workspace->document().experiment().systems.front().name);
    ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
    m_workspace->view().setTime(2.0);
  }

  /// With these panels in front.
  void take(Theme theme, const std::vector<const char*>& panels, const char* name) {
    m_window->setTheme(theme);
    for (const char* panel : panels) m_window->showPanel(QString::fromLatin1(panel));
    settle(500);
    ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
    settle(700);
    expectLikeBaseline(pictureOf(*m_window), name, kLeastSsim);
    EXPECT_TRUE(m_errors.empty()) << m_errors.front();
  }
};

TEST_F(Screenshots, LightWithTheLikelihood) {
  take(Theme::Light, {"sampling", "likelihood"}, "window-light");
}

TEST_F(Screenshots, DarkWithFootsteps) {
  take(Theme::Dark, {"sampling", "footsteps"}, "window-dark");
}

TEST_F(Screenshots, PathAndDistributions) {
  take(Theme::Light, {"path", "distributions"}, "window-path");
}

TEST_F(Screenshots, SelectionInStatisticsAndDiversity) {
  const MotionGroup& samples = m_workspace->motions().groups().back();
  m_workspace->view().select({.motions = {{samples.id, 1}}});
  take(Theme::Light, {"history", "diversity"}, "window-selection");
}

TEST_F(Screenshots, Statistics) {
  QWidget* panel = m_window->showPanel("statistics");
  settle(500);
  child<QPushButton>(*panel, "statisticsCompute")->click();
  auto* table = child<QAbstractItemView>(*panel, "statisticsTable");
  ASSERT_TRUE(waitUntil([&] { return table->model()->rowCount() > 0; }));
  take(Theme::Light, {"library", "statistics"}, "window-statistics");
}

}  // namespace
}  // namespace marey::gui
