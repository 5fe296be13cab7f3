#include "gui/shell/application.h"

#include <QLocale>
#include <clocale>
#include <exception>

namespace marey::gui {

Application::Application(int& argc, char** argv) : QApplication(argc, argv) {
  // Qt takes the user's locale for the whole process, and libraries then write and read "0,5".
  // Numbers look here as in the files, reports and papers that they come from.
  std::setlocale(LC_NUMERIC, "C");
  QLocale::setDefault(QLocale::c());
}

bool Application::notify(QObject* receiver, QEvent* event) {
  try {
    return QApplication::notify(receiver, event);
  } catch (const std::exception& error) {
    Q_EMIT failed(QString::fromUtf8(error.what()));
  }
  return false;
}

}  // namespace marey::gui
