// Boxes of numbers that people type into: the value is taken when it is finished (Enter, leaving
// the field, a command), not at every key, and nothing rewrites the text before.
#pragma once

#include <QDoubleSpinBox>
#include <QSpinBox>

namespace marey::gui {

/// Every value has at most decimals() decimals: steps are rounded like typed numbers.
class NumberBox : public QDoubleSpinBox {
 public:
  explicit NumberBox(QWidget* parent = nullptr);
  /// The value of what it stands for, without telling anybody; what is being typed stays.
  void display(double value);
  void stepBy(int steps) override;
};

class CountBox : public QSpinBox {
 public:
  explicit CountBox(QWidget* parent = nullptr);
  /// As NumberBox::display.
  void display(int value);
};

/// Takes what is being typed in the field that has the focus. Commands call it first, since a key
/// or a menu leaves the focus where it is.
void finishTyping();

}  // namespace marey::gui
