// The window: docks every registered panel, and holds the commands that concern the whole
// document.
#pragma once

#include <QMainWindow>
#include <map>
#include <memory>
#include <vector>

#include "gui/common/theme.h"
#include "gui/document/document_files.h"
#include "gui/shell/panel.h"

namespace ads {
class CDockManager;
class CDockWidget;
}  // namespace ads

class QMessageBox;

namespace marey::gui {

class MainWindow : public QMainWindow {
  Q_OBJECT
 public:
  MainWindow(Workspace& workspace, const std::vector<PanelSpec>& panels);
  ~MainWindow() override;

  /// What the program does first: offers unsaved work, then opens `files`, the demo without any.
  void start(const QStringList& files);
  /// Opens a document, or adds motion files and models to the present one, by what they are.
  /// Errors are shown; nothing is lost.
  void openFiles(const QStringList& files);
  void setTheme(Theme theme);
  Theme theme() const { return m_theme; }
  /// What the 3D view shows, for pictures and films of it.
  const std::shared_ptr<ShownScene>& shownScene() const { return m_scene; }
  /// Every command of the menus.
  const std::vector<QAction*>& commands() const { return m_commands; }
  /// Those and the panels' own with a key, for the palette and the key sheet.
  std::vector<QAction*> allCommands() const;
  QAction* command(const QString& name) const;  ///< by objectName; null without one
  /// A command of something the window does not know, at the end of the menu of that title (of
  /// File: before Quit), which is made where there is none.
  void addCommand(const QString& menu, const QString& name, const QString& text,
                  const QKeySequence& keys, const std::function<void()>& run);
  /// Takes over motion files that are added or dropped; without one they are added as they are.
  void setImporter(std::function<void(const QStringList& files)> importer);
  /// Brings a panel to the front. Null where there is none of that id.
  QWidget* showPanel(const QString& id);
  /// Offers unsaved work of windows that crashed.
  void offerRecovery();

 protected:
  bool event(QEvent* event) override;
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  void buildDocks(const std::vector<PanelSpec>& panels);
  void buildMenus();
  void buildFileMenu();
  void buildEditMenu();
  void buildSampleMenu();
  void buildViewMenu();
  void buildHelpMenu();
  QAction* add(QMenu* menu, const QString& name, const QString& text, const QKeySequence& keys,
               const std::function<void()>& run);
  void refreshTitle();
  void refreshBringBack();
  void refreshRecent();
  void open(const QString& file);
  void openDemo();
  void openNew();
  bool save();
  /// Whether the document may take the place of what the file holds: an empty one asks.
  bool mayReplace(const QString& file);
  bool saveAs();
  /// Asks about unsaved changes; false: stay.
  bool mayDiscard();
  void writeReport();
  void addMotionFiles();
  void addModels();
  void addModelFiles(const std::vector<std::string>& files);
  void openRecovered(const Recovered& recovered);
  void showError(const QString& title, const QString& error);
  void showKeys();
  void showPalette();

  Workspace& m_workspace;
  std::shared_ptr<ShownScene> m_scene = std::make_shared<ShownScene>();
  std::unique_ptr<Autosave> m_autosave;
  ads::CDockManager* m_docks = nullptr;
  std::map<QString, ads::CDockWidget*> m_panels;
  std::vector<QAction*> m_commands;
  QAction* m_undo = nullptr;
  QAction* m_redo = nullptr;
  QAction* m_bringBack = nullptr;
  QAction* m_report = nullptr;
  QAction* m_reload = nullptr;
  QMenu* m_recent = nullptr;
  QMessageBox* m_errorBox = nullptr;  ///< made when it is first needed
  QByteArray m_firstLayout;
  std::function<void(const QStringList&)> m_importer;
  Theme m_theme = Theme::Light;
};

}  // namespace marey::gui
