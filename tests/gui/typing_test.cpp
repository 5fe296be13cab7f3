// What keys do: numbers that are typed, commands while something is typed, Space and the focus.
#include <QAction>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QTest>
#include <QToolButton>
#include <cmath>
#include <set>

#include "gui/gui_support.h"
#include "gui/shell/commands.h"

namespace marey::gui {
namespace {

class Typing : public DemoTest {
 protected:
  QDoubleSpinBox* temperature() {
    return child<QDoubleSpinBox>(*m_window->showPanel("sampling"), "temperature0");
  }
  double stored() const { return m_workspace->document().experiment().systems.front().temperature; }
  /// One key after the other, with the event loop running between them as it does for a person.
  void type(QWidget* field, const char* keys) {
    field->setFocus();
    if (auto* box = qobject_cast<QAbstractSpinBox*>(field)) box->selectAll();
    if (auto* line = qobject_cast<QLineEdit*>(field)) line->selectAll();
    for (const char* key = keys; *key != 0; ++key) {
      QTest::keyClick(field, *key);
      settle(60);
    }
  }
  bool playing() {
    return child<QToolButton>(*m_window->showPanel("timeline"), "timelinePlay")
               ->defaultAction()
               ->text() == "Pause";
  }
  /// Space goes to what has the focus, as the keyboard sends it; without one, to the window.
  void pressSpace() {
    QWidget* focus = QApplication::focusWidget();
    QTest::keyClick(focus != nullptr ? focus : m_window.get(), Qt::Key_Space);
    settle(50);
  }
};

TEST_F(Typing, ATypeOfMotionIsTypedForAPathAndForAStretchOfIt) {
  QWidget* panel = m_window->showPanel("path");
  auto* whole = child<QComboBox>(*panel, "pathType");
  type(whole->lineEdit(), "walk");
  QTest::keyClick(whole->lineEdit(), Qt::Key_Return);
  const auto path = [this] { return m_workspace->document().experiment().paths.at(0); };
  EXPECT_EQ(path().control.type, "walk");
  m_workspace->document().undo();
  EXPECT_EQ(path().control.type, "");
  EXPECT_EQ(whole->currentText(), "");
  child<QSpinBox>(*panel, "wayPointIndex")->setValue(1);
  auto* stretch = child<QComboBox>(*panel, "wayPointType");
  ASSERT_TRUE(stretch->isEnabled());
  type(stretch->lineEdit(), "run");
  QTest::keyClick(stretch->lineEdit(), Qt::Key_Return);
  ASSERT_FALSE(path().wayPoints.empty());
  EXPECT_EQ(path().wayPoints[0].type, "run");
  EXPECT_GE(whole->findText("run"), 0) << "a type that is used is offered";
}

TEST_F(Typing, ATemperatureIsWhatWasTypedAtTheEnd) {
  for (const int pause : {0, 60}) {
    QDoubleSpinBox* box = temperature();
    box->setFocus();
    box->selectAll();
    for (const char key : {'0', '.', '6', '5'}) {
      QTest::keyClick(box, key);
      settle(pause);
    }
    EXPECT_NE(stored(), 0.0) << "the first key was taken for the number";
    EXPECT_EQ(box->text(), "0.65") << "the text was rewritten";
    QTest::keyClick(box, Qt::Key_Return);
    EXPECT_EQ(stored(), 0.65);
    m_workspace->document().undo();
    EXPECT_NE(stored(), 0.65) << "typing left several edits";
  }
}

TEST_F(Typing, LeavingTheFieldTakesTheNumber) {
  QDoubleSpinBox* box = temperature();
  type(box, "1.25");
  child<QLineEdit>(*m_window, "sampleSeed")->setFocus();
  EXPECT_EQ(stored(), 1.25);
}

TEST_F(Typing, ACommandTakesWhatIsBeingTyped) {
  type(temperature(), "0.45");
  m_window->menus().command("selectNone")->trigger();
  EXPECT_EQ(stored(), 0.45);
  auto* seed = child<QLineEdit>(*m_window, "sampleSeed");
  type(seed, "77");
  m_window->menus().command("selectNone")->trigger();
  EXPECT_EQ(m_workspace->document().experiment().seed, 77U);
}

TEST_F(Typing, WhatIsBeingTypedIsNotRewrittenByOtherChanges) {
  QDoubleSpinBox* box = temperature();
  type(box, "0.4");
  m_workspace->document().edit("Samples", [](Experiment& e) { e.samples = 7; });
  EXPECT_EQ(box->text(), "0.4");
  auto* seed = child<QLineEdit>(*m_window, "sampleSeed");
  type(seed, "12");
  m_workspace->document().edit("Samples", [](Experiment& e) { e.samples = 8; });
  EXPECT_EQ(seed->text(), "12");
  auto* frame = child<QSpinBox>(*m_window->showPanel("timeline"), "timelineFrame");
  type(frame, "3");
  m_workspace->view().setTime(0.5);
  EXPECT_EQ(frame->text(), "3") << "playing took the number out of the hand";
}

TEST_F(Typing, StepsOfArrowsStoreWhatIsShown) {
  QDoubleSpinBox* box = temperature();
  box->setValue(1.0);
  for (int step = 1; step <= 20; ++step) {
    QTest::keyClick(box, Qt::Key_Down);
    EXPECT_EQ(stored(), std::round(100.0 - 5.0 * step) / 100.0);
  }
}

TEST_F(Typing, EveryBoxOfTheWindowTakesFinishedAndRoundNumbers) {
  addPanelCommands(*m_window, *m_workspace);
  m_window->menus().command("exportMotions")->trigger();
  m_window->menus().command("documentSettings")->trigger();
  std::set<QAbstractSpinBox*> boxes;
  const auto collect = [&boxes](QWidget* from) {
    for (QAbstractSpinBox* box : from->findChildren<QAbstractSpinBox*>()) boxes.insert(box);
  };
  collect(m_window.get());
  for (const PanelSpec& panel : panels()) collect(m_window->showPanel(panel.id));
  for (QAbstractSpinBox* box : boxes) {
    SCOPED_TRACE(box->objectName().toStdString());
    EXPECT_FALSE(box->keyboardTracking()) << "its first key is taken for the number";
    auto* number = qobject_cast<QDoubleSpinBox*>(box);
    if (number == nullptr) continue;
    const QSignalBlocker quiet(number);
    const double scale = std::pow(10.0, number->decimals());
    for (int step = 0; step < 12; ++step) {
      number->stepBy(step < 6 ? -1 : 1);
      EXPECT_EQ(number->value(), std::round(number->value() * scale) / scale);
    }
  }
  EXPECT_GT(boxes.size(), 15U);
}

TEST_F(Typing, SpacePlaysWhateverWasPressedLast) {
  m_workspace->document().edit("More", [](Experiment& e) { e.samples = 100000; });
  const size_t models = m_workspace->document().experiment().systems.size();
  QWidget* panel = m_window->showPanel("sampling");
  QTest::mouseClick(child<QPushButton>(*panel, "sampleButton"), Qt::LeftButton);
  ASSERT_TRUE(waitUntil([this] { return m_workspace->sampling().active(); }));
  QTest::mouseClick(child<QPushButton>(*panel, "sampleCancel"), Qt::LeftButton);
  ASSERT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
  settle();
  EXPECT_EQ(qobject_cast<QAbstractButton*>(QApplication::focusWidget()), nullptr)
      << QApplication::focusWidget()->objectName().toStdString() << " got the focus by itself";
  ASSERT_FALSE(playing());
  pressSpace();
  EXPECT_EQ(m_workspace->document().experiment().systems.size(), models) << "Space removed a model";
  EXPECT_TRUE(playing());
  pressSpace();
  EXPECT_FALSE(playing());
}

TEST_F(Typing, SpaceIsNoButtonsButReturnIs) {
  QWidget* panel = m_window->showPanel("sampling");
  auto* another = child<QToolButton>(*panel, "anotherSeed");
  const uint64_t before = m_workspace->document().experiment().seed;
  another->setFocus(Qt::TabFocusReason);
  pressSpace();
  EXPECT_EQ(m_workspace->document().experiment().seed, before);
  EXPECT_TRUE(playing());
  pressSpace();
  QTest::keyClick(another, Qt::Key_Return);
  EXPECT_NE(m_workspace->document().experiment().seed, before) << "no key presses a button";
}

TEST_F(Typing, SpaceIsTextInAFieldOfText) {
  auto* filter = child<QLineEdit>(*m_window->showPanel("library"), "motionFilter");
  filter->setFocus();
  QTest::keyClicks(filter, "a b");
  EXPECT_EQ(filter->text(), "a b");
  EXPECT_FALSE(playing());
}

}  // namespace
}  // namespace marey::gui
