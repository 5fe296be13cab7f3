// Chooses along what motions are compared with nature, and says which natural motion that is.
#pragma once

#include <QWidget>

class QComboBox;
class QLabel;
class QPushButton;

namespace marey::gui {

class Workspace;

/// One choice for all panels: it is the workspace's.
class ComparisonChoice : public QWidget {
  Q_OBJECT
 public:
  /// `name` starts the object names: NAMECompare, NAMEHeldOut, NAMENatural.
  ComparisonChoice(Workspace& workspace, const QString& name, QWidget* parent);
  /// What held-out plots show where there is nothing to show yet.
  static QString missingText(const Workspace& workspace);

 private:
  void refresh();
  QString naturalText() const;

  Workspace& m_workspace;
  QComboBox* m_choice = nullptr;
  QPushButton* m_sample = nullptr;
  QLabel* m_natural = nullptr;
};

}  // namespace marey::gui
