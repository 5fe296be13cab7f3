#include "gui/shell/no_display.h"

#include <QByteArray>
#include <QString>
#include <QtGlobal>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace marey::gui {
namespace {

struct Message {
  QtMsgType type;
  QByteArray category;
  QString text;
};

/// Qt's handler is a plain function, so what it needs is global while a guard lives.
std::vector<Message>& kept() {
  static std::vector<Message> messages;
  return messages;
}
QtMessageHandler& before() {
  static QtMessageHandler handler = nullptr;
  return handler;
}

QByteArray missing() {
  const QByteArray platform = qgetenv("QT_QPA_PLATFORM");
  const QByteArray x11 = qgetenv("DISPLAY"), wayland = qgetenv("WAYLAND_DISPLAY");
  if (!platform.isEmpty())
    return "no display for QT_QPA_PLATFORM=" + platform + ", DISPLAY='" + x11 + "'";
  if (x11.isEmpty() && wayland.isEmpty())
    return "no display (DISPLAY and WAYLAND_DISPLAY are not set)";
  return "no display that answers (DISPLAY='" + x11 + "', WAYLAND_DISPLAY='" + wayland + "')";
}

void handle(QtMsgType type, const QMessageLogContext& context, const QString& text) {
  if (type != QtFatalMsg) {
    kept().push_back({type, context.category, text});
    return;
  }
  std::fprintf(stderr, "marey-workbench: %s; marey render and marey report need none\n",
               missing().constData());
  std::fflush(stderr);
  std::_Exit(EXIT_FAILURE);
}

}  // namespace

NoDisplayGuard::NoDisplayGuard() {
  before() = qInstallMessageHandler(handle);
}

NoDisplayGuard::~NoDisplayGuard() {
  qInstallMessageHandler(before());
  for (const Message& message : kept()) {
    const QMessageLogContext context(nullptr, 0, nullptr, message.category.constData());
    qt_message_output(message.type, context, message.text);
  }
  kept().clear();
}

}  // namespace marey::gui
