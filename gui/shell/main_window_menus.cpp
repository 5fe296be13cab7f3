// Menus: every command with its keys.
#include <QApplication>
#include <QMessageBox>

#include "gui/shell/command_palette.h"
#include "gui/shell/key_sheet.h"
#include "gui/shell/main_window.h"
#include <qtadvanceddocking/DockWidget.h>

namespace marey::gui {

void MainWindow::buildMenus() {
  buildFileMenu();
  buildEditMenu();
  buildSampleMenu();
  buildViewMenu();
  buildHelpMenu();
}

void MainWindow::buildFileMenu() {
  QMenu* menu = m_menus.addMenu(tr("&File"));
  m_menus.add(menu, "new", tr("New experiment"), QKeySequence::New, [this] { m_files->openNew(); });
  m_menus.add(menu, "openDemo", tr("Open the demo experiment"), {},
              [this] { m_files->openDemo(); });
  m_menus.add(menu, "open", tr("Open…"), QKeySequence::Open, [this] { m_files->open({}); });
  m_recent = menu->addMenu(tr("Open recent"));
  connect(m_recent, &QMenu::aboutToShow, this, &MainWindow::refreshRecent);
  menu->addSeparator();
  m_menus.add(menu, "addMotion", tr("Add natural motion…"), tr("Ctrl+I"),
              [this] { m_files->addMotionFiles(); });
  m_menus.add(menu, "addModel", tr("Add models…"), tr("Ctrl+M"), [this] { m_files->addModels(); });
  m_reload = m_menus.add(menu, "reloadNatural", tr("Reload natural motion"), tr("F5"),
                         [this] { m_workspace.natural().read(); });
  menu->addSeparator();
  m_menus.add(menu, "save", tr("Save"), QKeySequence::Save, [this] { m_files->save(); });
  m_menus.add(menu, "saveAs", tr("Save as…"), tr("Ctrl+Shift+S"), [this] { m_files->saveAs(); });
  m_report = m_menus.add(menu, "report", tr("Write the report…"), tr("Ctrl+R"),
                         [this] { m_files->writeReport(); });
  menu->addSeparator();
  m_menus.add(menu, "quit", tr("Quit"), QKeySequence::Quit, [this] { close(); });
}

void MainWindow::refreshRecent() {
  m_recent->clear();
  for (const QString& file : recentFiles())
    m_recent->addAction(file, this, [this, file] { m_files->open(file); });
  if (m_recent->isEmpty()) m_recent->addAction(tr("No documents yet"))->setEnabled(false);
}

void MainWindow::buildEditMenu() {
  QMenu* menu = m_menus.addMenu(tr("&Edit"));
  m_undo = m_menus.add(menu, "undo", tr("Undo"), QKeySequence::Undo,
                       [this] { m_workspace.document().undo(); });
  m_redo = m_menus.add(menu, "redo", tr("Redo"), tr("Ctrl+Shift+Z"),
                       [this] { m_workspace.document().redo(); });
  m_bringBack = m_menus.add(menu, "bringBack", tr("Bring back removed motions"), {},
                            [this] { m_workspace.motions().bringBack(); });
  menu->addSeparator();
  m_menus.add(menu, "selectNone", tr("Select nothing"), tr("Ctrl+Shift+A"),
              [this] { m_workspace.view().select({}); });
  m_menus.add(menu, "clearRange", tr("Clear the time range"), {},
              [this] { m_workspace.view().setRange(std::nullopt); });
}

void MainWindow::buildSampleMenu() {
  QMenu* menu = m_menus.addMenu(tr("&Sample"));
  m_menus.add(menu, "sample", tr("Sample the models along the path"), tr("Ctrl+Return"),
              [this] { m_workspace.sampling().sampleCurrentPath(); });
  m_menus.add(menu, "cancel", tr("Cancel reading, sampling and plotting"), tr("Esc"),
              [this] { m_workspace.cancelWork(); });
}

void MainWindow::buildViewMenu() {
  QMenu* menu = m_menus.addMenu(tr("&View"));
  QMenu* panels = menu->addMenu(tr("Panels"));
  for (const auto& [id, dock] : m_docks->all()) {
    const QString name = id;
    QAction* action = m_menus.add(panels, "show_" + id, dock->windowTitle(), {},
                                  [this, name] { showPanel(name); });
    action->setProperty("menu", tr("Show panel"));
  }
  menu->addSeparator();
  m_menus.add(menu, "theme", tr("Light or dark"), tr("D"),
              [this] { setTheme(m_theme == Theme::Dark ? Theme::Light : Theme::Dark); });
  m_menus.add(menu, "resetLayout", tr("Reset the layout"), {}, [this] { m_docks->resetLayout(); });
  m_menus.add(menu, "palette", tr("Command palette…"), tr("Ctrl+P"), [this] { showPalette(); });
}

void MainWindow::buildHelpMenu() {
  QMenu* menu = m_menus.addMenu(tr("&Help"));
  m_menus.add(menu, "keys", tr("Keys"), tr("H"), [this] { showKeys(); });
  m_menus.add(menu, "about", tr("About Marey"), {}, [this] {
    QMessageBox::about(this, tr("About Marey"),
                       tr("<b>Marey %1</b><p>A workbench for generative models of motion.</p>"
                          "<p>BSD-3-Clause. Uses Qt, Qt Advanced Docking System, VTK, libtorch, "
                          "Eigen, Boost, cairo and FFmpeg under their licences.</p>")
                           .arg(QStringLiteral(MAREY_VERSION)));
  });
}

void MainWindow::showPalette() {
  auto* palette = new CommandPalette(allCommands(), this);
  palette->setAttribute(Qt::WA_DeleteOnClose);
  palette->move(mapToGlobal(QPoint((width() - palette->width()) / 2, 60)));
  palette->show();
}

std::vector<QAction*> MainWindow::allCommands() const {
  std::vector<QAction*> out = m_menus.commands();
  for (const auto& [id, dock] : m_docks->all()) {
    for (QAction* action : dock->widget()->findChildren<QAction*>()) {
      if (action->shortcut().isEmpty() || action->text().isEmpty()) continue;
      action->setProperty("menu", dock->windowTitle());
      out.push_back(action);
    }
  }
  return out;
}

void MainWindow::showKeys() {
  QStringList lines;
  // Keys that panels handle themselves say so in their "keys" property.
  for (const auto& [id, dock] : m_docks->all())
    lines += dock->widget()->property("keys").toStringList();
  showKeySheet(allCommands(), lines, this);
}

}  // namespace marey::gui
