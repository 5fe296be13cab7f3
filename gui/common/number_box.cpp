#include "gui/common/number_box.h"

#include <QApplication>
#include <QLineEdit>
#include <QSignalBlocker>

namespace marey::gui {
namespace {

/// Whether somebody has changed the text and not finished yet.
bool isTyping(const QAbstractSpinBox& box, const QLineEdit& text) {
  return box.hasFocus() && text.isModified();
}

}  // namespace

NumberBox::NumberBox(QWidget* parent) : QDoubleSpinBox(parent) {
  setKeyboardTracking(false);
}

void NumberBox::display(double value) {
  if (isTyping(*this, *lineEdit())) return;
  const QSignalBlocker quiet(this);
  setValue(value);
}

void NumberBox::stepBy(int steps) {
  interpretText();
  // Qt's own step keeps the error of the sum: 0.85 - 0.05 would be 0.7999999999999999.
  setValue(value() + steps * singleStep());
  selectAll();
}

CountBox::CountBox(QWidget* parent) : QSpinBox(parent) {
  setKeyboardTracking(false);
}

void CountBox::display(int value) {
  if (isTyping(*this, *lineEdit())) return;
  const QSignalBlocker quiet(this);
  setValue(value);
}

void finishTyping() {
  QWidget* focus = QApplication::focusWidget();
  if (auto* box = qobject_cast<QAbstractSpinBox*>(focus)) {
    box->interpretText();
  } else if (auto* line = qobject_cast<QLineEdit*>(focus); line != nullptr && line->isModified()) {
    // As leaving the field would do; one in a table closes then.
    line->clearFocus();
    if (line->isVisible()) line->setFocus();
  }
}

}  // namespace marey::gui
