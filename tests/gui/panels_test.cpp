// Every registered panel opens in a window: empty, with motions, and while work goes on.
#include "gui/gui_support.h"

namespace marey::gui {
namespace {

class EveryPanel : public WindowTest {
 protected:
  void openAll(const char* state) {
    for (const PanelSpec& spec : panels()) {
      SCOPED_TRACE(spec.id.toStdString() + ", " + state);
      QWidget* panel = m_window->showPanel(spec.id);
      ASSERT_NE(panel, nullptr);
      EXPECT_TRUE(waitUntil([&] { return panel->isVisible(); }, 5.0));
      // Plots are worked out beside the event loop.
      EXPECT_TRUE(waitUntil([&] { return showsSomething(pictureOf(*panel)); }, 15.0));
    }
    EXPECT_TRUE(m_errors.empty()) << m_errors.front();
  }
};

TEST_F(EveryPanel, OpensEmpty) {
  openWindow();
  openAll("empty");
}

TEST_F(EveryPanel, OpensWithMotions) {
  openWindow();
  openSmallDemo();
  m_workspace->sampleCurrentPath();
  ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
  ASSERT_EQ(m_workspace->groups().size(), 2U);
  openAll("loaded");
}

TEST_F(EveryPanel, OpensInTheMiddleOfAJob) {
  openWindow();
  openSmallDemo();
  m_workspace->edit("More", [](Experiment& e) { e.samples = 4000; });
  m_workspace->sampleCurrentPath();
  ASSERT_TRUE(waitUntil([this] { return m_workspace->groups().back().motions.size() > 0; }));
  openAll("in mid-job");
  EXPECT_FALSE(m_jobs->idle());
  m_jobs->cancelAll();
  EXPECT_TRUE(waitUntil([this] { return m_jobs->idle(); }, 20.0));
}

TEST(PanelList, HasDifferentNames) {
  std::set<QString> ids, titles;
  for (const PanelSpec& spec : panels()) {
    EXPECT_TRUE(ids.insert(spec.id).second) << spec.id.toStdString();
    EXPECT_TRUE(titles.insert(spec.title).second) << spec.title.toStdString();
  }
  EXPECT_GE(ids.size(), 3U);
}

}  // namespace
}  // namespace marey::gui
