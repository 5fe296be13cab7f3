// Chooses along what motions are compared with nature.
#pragma once

#include <QWidget>
#include <string>
#include <vector>

class QComboBox;
class QPushButton;

namespace marey::gui {

class Workspace;

/// One choice for all panels: it is the workspace's.
class ComparisonChoice : public QWidget {
  Q_OBJECT
 public:
  /// `name` starts the object names: NAMECompare, NAMEHeldOut.
  ComparisonChoice(Workspace& workspace, const QString& name, QWidget* parent);
  /// What held-out plots show where there is nothing to show yet.
  static QString missingText(const Workspace& workspace);
  /// Which natural motion is compared with and whose motions are missing, before other notes.
  static std::vector<std::string> notes(const Workspace& workspace,
                                        std::vector<std::string> others = {});

 private:
  void refresh();

  Workspace& m_workspace;
  QComboBox* m_choice = nullptr;
  QPushButton* m_sample = nullptr;
};

}  // namespace marey::gui
