// The window: its docks, menus and commands put together, with the title, the theme and what is
// dropped on it.
#pragma once

#include <QMainWindow>
#include <memory>
#include <vector>

#include "gui/common/theme.h"
#include "gui/shell/docks.h"
#include "gui/shell/document_commands.h"
#include "gui/shell/error_box.h"
#include "gui/shell/menus.h"

namespace marey::gui {

class MainWindow : public QMainWindow {
  Q_OBJECT
 public:
  MainWindow(Workspace& workspace, const std::vector<PanelSpec>& panels);

  DocumentCommands& files() { return *m_files; }
  Menus& menus() { return m_menus; }
  /// The commands of the menus and the panels' own with a key, for the palette and the key sheet.
  std::vector<QAction*> allCommands() const;
  /// Brings a panel to the front. Null where there is none of that id.
  QWidget* showPanel(const QString& id) { return m_docks->show(id); }
  void setTheme(Theme theme);
  Theme theme() const { return m_theme; }
  /// What the 3D view shows, for pictures and films of it.
  const std::shared_ptr<ShownScene>& shownScene() const { return m_scene; }

 protected:
  bool event(QEvent* event) override;
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  void connectWorkspace();
  void restore();
  void buildMenus();
  void buildFileMenu();
  void buildEditMenu();
  void buildSampleMenu();
  void buildViewMenu();
  void buildHelpMenu();
  void refreshTitle();
  void refreshBringBack();
  void refreshRecent();
  void showError(const QString& title, const QString& error);
  void showKeys();
  void showPalette();

  Workspace& m_workspace;
  std::shared_ptr<ShownScene> m_scene = std::make_shared<ShownScene>();
  DocumentCommands* m_files;
  Menus m_menus;
  std::unique_ptr<Docks> m_docks;
  QAction* m_undo = nullptr;
  QAction* m_redo = nullptr;
  QAction* m_bringBack = nullptr;
  QAction* m_report = nullptr;
  QAction* m_reload = nullptr;
  QMenu* m_recent = nullptr;
  ErrorBox* m_errors = nullptr;  ///< made when it is first needed
  Theme m_theme = Theme::Light;
};

}  // namespace marey::gui
