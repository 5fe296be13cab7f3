#include "gui/common/type_box.h"

#include <QLineEdit>
#include <QSignalBlocker>

namespace marey::gui {

TypeBox::TypeBox(const char* name, const QString& toolTip, const QString& otherwise,
                 QWidget* parent)
    : QComboBox(parent) {
  setObjectName(QLatin1String(name));
  setToolTip(toolTip);
  setAccessibleName(toolTip);
  setEditable(true);
  setInsertPolicy(QComboBox::NoInsert);
  setMinimumContentsLength(8);
  lineEdit()->setPlaceholderText(otherwise);
  connect(this, qOverload<int>(&QComboBox::activated), this, [this](int) { tell(); });
  connect(lineEdit(), &QLineEdit::editingFinished, this, &TypeBox::tell);
}

void TypeBox::display(const std::vector<std::string>& known, const std::string& chosen) {
  m_shown = chosen;
  if (lineEdit()->hasFocus() && lineEdit()->isModified()) return;  // what is being typed stays
  const QSignalBlocker quiet(this);
  clear();
  addItem(QString());
  for (const std::string& type : known) addItem(QString::fromStdString(type));
  setCurrentText(QString::fromStdString(chosen));
}

void TypeBox::tell() {
  lineEdit()->setModified(false);
  const std::string type = chosen();
  if (type == m_shown) return;
  m_shown = type;
  Q_EMIT typeChosen(type);
}

}  // namespace marey::gui
