// Errors, told so that work goes on and none takes another's place.
#pragma once

#include <QMessageBox>

namespace marey::gui {

class ErrorBox : public QMessageBox {
 public:
  explicit ErrorBox(QWidget* parent);
  /// Adds to what is still being read.
  void tell(const QString& title, const QString& error);
};

}  // namespace marey::gui
