// Live control of a model of the papers' size: 16 steps of flow, 512 units, 74 million parameters.
#include <QLabel>
#include <QPushButton>
#include <QTest>
#include <cstdio>

#include "families.h"
#include "gui/gui_support.h"

#include "base/atomic_file.h"
#include "model/gradient/model_bench.h"

namespace marey::gui {
namespace {

namespace fs = std::filesystem;

/// Long enough for the rate, which is counted over a second, to settle.
constexpr int kSteeredMs = 5000;

class LiveControl : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    const fs::path config = fs::path(MAREY_SOURCE_DIR) / "resources/models/moglow-human.json";
    const fs::path model = fs::path(m_folder.path().toStdString()) / "human.marey";
    writeFileAtomically(
        model, serialise(randomModel(readJson(config)["model"], config.string(),
                                     familyNamed("moglow", modelFamilies(), config.string()), 1)));
    Experiment document;
    document.systems = {{"MoGlow", model.string(), 0.5}};
    openWindow();
    m_workspace->open(document, {});
    ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
  }
};

TEST_F(LiveControl, SaysTheRateOfAModelOfThePapersSize) {
  m_window->showPanel("live");
  const auto* rate = child<QLabel>(*m_window, "liveLatency");
  QTest::mouseClick(child<QPushButton>(*m_window, "liveStart"), Qt::LeftButton);
  ASSERT_TRUE(waitUntil([&] { return rate->text().contains("frames/s"); }));
  QTest::keyPress(m_window->focusWidget(), Qt::Key_Up);
  settle(kSteeredMs);
  std::printf("16 x 512: %s\n", qPrintable(rate->text()));
  EXPECT_TRUE(rate->text().contains("MoGlow: up to"));
  EXPECT_TRUE(rate->text().contains("command to picture"));
  QTest::mouseClick(child<QPushButton>(*m_window, "liveStart"), Qt::LeftButton);
  ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
  // Not one frame is left out, whatever the rate: 20 of each second where it is held.
  ASSERT_EQ(m_workspace->motions().groups().size(), 1U);
  EXPECT_GT(m_workspace->motions().groups().front().motions.front().clip->frameCount(), 10);
  EXPECT_TRUE(m_errors.empty()) << m_errors.front();
}

}  // namespace
}  // namespace marey::gui
