#include "gui/shell/key_rules.h"

#include <QAbstractButton>
#include <QAbstractSpinBox>
#include <QApplication>
#include <QComboBox>
#include <QKeyEvent>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QPointer>
#include <QTextEdit>
#include <QTimer>

namespace marey::gui {

bool takesText(const QWidget* widget) {
  if (const auto* combo = qobject_cast<const QComboBox*>(widget)) return combo->isEditable();
  if (const auto* line = qobject_cast<const QLineEdit*>(widget)) return !line->isReadOnly();
  if (const auto* text = qobject_cast<const QTextEdit*>(widget)) return !text->isReadOnly();
  if (const auto* text = qobject_cast<const QPlainTextEdit*>(widget)) return !text->isReadOnly();
  return qobject_cast<const QAbstractSpinBox*>(widget) != nullptr;
}

KeyRules::KeyRules(QWidget* window) : QObject(window), m_window(window) {
  qApp->installEventFilter(this);
}

bool KeyRules::holds(const QObject* object) const {
  const auto* widget = qobject_cast<const QWidget*>(object);
  return widget != nullptr && widget->window() == m_window;
}

bool KeyRules::eventFilter(QObject* object, QEvent* event) {
  switch (event->type()) {
    case QEvent::ShortcutOverride: {
      const auto* key = static_cast<QKeyEvent*>(event);
      if (key->key() != Qt::Key_Space || key->modifiers() || !holds(object)) return false;
      if (!takesText(static_cast<QWidget*>(object))) return false;
      event->accept();
      return true;
    }
    case QEvent::KeyPress: {
      const auto* key = static_cast<QKeyEvent*>(event);
      auto* button = qobject_cast<QAbstractButton*>(object);
      const bool press = key->key() == Qt::Key_Return || key->key() == Qt::Key_Enter;
      const bool alone = (key->modifiers() & ~Qt::KeypadModifier) == 0;
      if (button == nullptr || !press || !alone || !holds(object)) return false;
      button->click();
      return true;
    }
    case QEvent::FocusOut: {
      const auto* widget = qobject_cast<QWidget*>(object);
      if (!holds(object) || (widget->isEnabled() && widget->isVisible())) return false;
      // Qt gives it to the next widget in the chain, after this event.
      QTimer::singleShot(0, this, [] {
        if (auto* next = qobject_cast<QAbstractButton*>(QApplication::focusWidget()))
          next->clearFocus();
      });
      return false;
    }
    default:
      return false;
  }
}

}  // namespace marey::gui
