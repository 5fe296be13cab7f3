// What Space and Return mean in the window, whatever was pressed last.
#pragma once

#include <QObject>

class QEvent;

namespace marey::gui {

/// Space belongs to the window's own shortcut (play); fields of text keep it. A button that has
/// the focus is pressed with Return instead. A button never gets the focus because the widget that
/// had it was disabled or hidden: nobody chose it, and the next key would press it.
class KeyRules : public QObject {
 public:
  /// Watches the whole application while it lives; only `window` itself follows the rules, its
  /// dialogs keep Qt's.
  explicit KeyRules(QWidget* window);

 protected:
  bool eventFilter(QObject* object, QEvent* event) override;

 private:
  bool holds(const QObject* object) const;
  QWidget* m_window;
};

/// Whether a widget takes letters and spaces as text.
bool takesText(const QWidget* widget);

}  // namespace marey::gui
