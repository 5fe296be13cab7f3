// The application: an exception in a slot is an error to show, not the end of the program.
#pragma once

#include <QApplication>

namespace marey::gui {

class Application : public QApplication {
  Q_OBJECT
 public:
  Application(int& argc, char** argv);
  bool notify(QObject* receiver, QEvent* event) override;

 Q_SIGNALS:
  /// What was being done when the event came was left in the middle.
  void failed(const QString& error);
};

}  // namespace marey::gui
