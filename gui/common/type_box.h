// A field for a type of motion: one of those that are known, or any other name.
#pragma once

#include <QComboBox>
#include <string>
#include <vector>

namespace marey::gui {

class TypeBox : public QComboBox {
  Q_OBJECT
 public:
  /// `otherwise`: what is shown where no type is chosen.
  TypeBox(const char* name, const QString& toolTip, const QString& otherwise, QWidget* parent);
  /// What is offered, and what is chosen (empty: none), without telling anybody.
  void display(const std::vector<std::string>& known, const std::string& chosen);
  std::string chosen() const { return currentText().trimmed().toStdString(); }

 Q_SIGNALS:
  void typeChosen(const std::string& type);

 private:
  void tell();

  std::string m_shown;
};

}  // namespace marey::gui
