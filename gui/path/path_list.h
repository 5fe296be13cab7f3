// The document's paths: choose, add, rename, copy, remove, and to and from files.
#pragma once

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QMenu>
#include <QPushButton>
#include <QToolButton>
#include <QWidget>

#include "gui/common/number_box.h"
#include "gui/common/type_box.h"
#include "gui/path/current_path.h"

namespace marey::gui {

class PathList : public QWidget {
  Q_OBJECT
 public:
  PathList(Workspace& workspace, CurrentPath& path, QWidget* parent);

  void importFile(const QString& file);
  void exportFile(const QString& file);
  void rename(const QString& name);
  /// The way that the selected motion went becomes a path of its own.
  void takeSelectedMotion();

 private:
  void build();
  void buildMenus();
  QToolButton* addMenuButton(const QString& name, const QString& text, const QString& toolTip);
  void refresh();
  void refreshActions();
  void add(const QString& label, ExperimentPath path);
  void remove();
  void askName();
  void askImport();
  void askExport();

  Workspace& m_workspace;
  CurrentPath& m_path;
  QComboBox* m_choice = nullptr;
  QToolButton *m_add = nullptr, *m_more = nullptr;
  QPushButton* m_makeDrawn = nullptr;
  NumberBox* m_seconds = nullptr;
  TypeBox* m_type = nullptr;
  QAction *m_rename = nullptr, *m_copy = nullptr, *m_remove = nullptr, *m_take = nullptr,
          *m_export = nullptr;
  bool m_filling = false;
};

}  // namespace marey::gui
