// Menus: every command with its keys.
#include <QApplication>
#include <QMenuBar>
#include <QMessageBox>
#include <QShortcut>
#include <QTextBrowser>
#include <QVBoxLayout>
#include <algorithm>

#include "gui/common/number_box.h"
#include "gui/shell/command_palette.h"
#include "gui/shell/main_window.h"
#include <qtadvanceddocking/DockManager.h>
#include <qtadvanceddocking/DockWidget.h>

namespace marey::gui {

QAction* MainWindow::add(QMenu* menu, const QString& name, const QString& text,
                         const QKeySequence& keys, const std::function<void()>& run) {
  auto* action = new QAction(text, this);
  action->setObjectName(name);
  action->setShortcut(keys);
  action->setProperty("menu", menu->title().remove(QLatin1Char('&')));
  connect(action, &QAction::triggered, this, [run] {
    finishTyping();
    run();
  });
  menu->addAction(action);
  m_commands.push_back(action);
  return action;
}

QAction* MainWindow::command(const QString& name) const {
  const auto found = std::find_if(m_commands.begin(), m_commands.end(), [&](const QAction* action) {
    return action->objectName() == name;
  });
  return found == m_commands.end() ? nullptr : *found;
}

void MainWindow::addCommand(const QString& title, const QString& name, const QString& text,
                            const QKeySequence& keys, const std::function<void()>& run) {
  QMenu* menu = nullptr;
  for (const QAction* entry : menuBar()->actions())
    if (entry->menu() != nullptr && entry->text().remove(u'&') == title) menu = entry->menu();
  if (menu == nullptr) menu = menuBar()->addMenu(title);
  QAction* added = add(menu, name, text, keys, run);
  QAction* quit = command(QStringLiteral("quit"));
  const auto entries = menu->actions();
  const auto at = entries.indexOf(quit);
  if (at < 1) return;
  // Before the line above Quit.
  menu->removeAction(added);
  menu->insertAction(entries[at - 1], added);
}

void MainWindow::setImporter(std::function<void(const QStringList&)> importer) {
  m_importer = std::move(importer);
}

void MainWindow::buildMenus() {
  buildFileMenu();
  buildEditMenu();
  buildSampleMenu();
  buildViewMenu();
  buildHelpMenu();
}

void MainWindow::buildFileMenu() {
  QMenu* menu = menuBar()->addMenu(tr("&File"));
  add(menu, "new", tr("New experiment"), QKeySequence::New, [this] { openNew(); });
  add(menu, "openDemo", tr("Open the demo experiment"), {}, [this] { openDemo(); });
  add(menu, "open", tr("Open…"), QKeySequence::Open, [this] { open({}); });
  m_recent = menu->addMenu(tr("Open recent"));
  connect(m_recent, &QMenu::aboutToShow, this, &MainWindow::refreshRecent);
  menu->addSeparator();
  add(menu, "addMotion", tr("Add natural motion…"), tr("Ctrl+I"), [this] { addMotionFiles(); });
  add(menu, "addModel", tr("Add models…"), tr("Ctrl+M"), [this] { addModels(); });
  m_reload = add(menu, "reloadNatural", tr("Reload natural motion"), tr("F5"),
                 [this] { m_workspace.natural().read(); });
  menu->addSeparator();
  add(menu, "save", tr("Save"), QKeySequence::Save, [this] { save(); });
  add(menu, "saveAs", tr("Save as…"), tr("Ctrl+Shift+S"), [this] { saveAs(); });
  m_report = add(menu, "report", tr("Write the report…"), tr("Ctrl+R"), [this] { writeReport(); });
  menu->addSeparator();
  add(menu, "quit", tr("Quit"), QKeySequence::Quit, [this] { close(); });
}

void MainWindow::refreshRecent() {
  m_recent->clear();
  for (const QString& file : recentFiles())
    m_recent->addAction(file, this, [this, file] { open(file); });
  if (m_recent->isEmpty()) m_recent->addAction(tr("No documents yet"))->setEnabled(false);
}

void MainWindow::buildEditMenu() {
  QMenu* menu = menuBar()->addMenu(tr("&Edit"));
  m_undo =
      add(menu, "undo", tr("Undo"), QKeySequence::Undo, [this] { m_workspace.document().undo(); });
  m_redo =
      add(menu, "redo", tr("Redo"), tr("Ctrl+Shift+Z"), [this] { m_workspace.document().redo(); });
  m_bringBack = add(menu, "bringBack", tr("Bring back removed motions"), {},
                    [this] { m_workspace.motions().bringBack(); });
  menu->addSeparator();
  add(menu, "selectNone", tr("Select nothing"), tr("Ctrl+Shift+A"),
      [this] { m_workspace.view().select({}); });
  add(menu, "clearRange", tr("Clear the time range"), {},
      [this] { m_workspace.view().setRange(std::nullopt); });
}

void MainWindow::buildSampleMenu() {
  QMenu* menu = menuBar()->addMenu(tr("&Sample"));
  add(menu, "sample", tr("Sample the models along the path"), tr("Ctrl+Return"),
      [this] { m_workspace.sampling().sampleCurrentPath(); });
  add(menu, "cancel", tr("Cancel reading, sampling and plotting"), tr("Esc"),
      [this] { m_workspace.cancelWork(); });
}

void MainWindow::buildViewMenu() {
  QMenu* menu = menuBar()->addMenu(tr("&View"));
  QMenu* panels = menu->addMenu(tr("Panels"));
  for (const auto& [id, dock] : m_panels) {
    const QString name = id;
    QAction* action =
        add(panels, "show_" + id, dock->windowTitle(), {}, [this, name] { showPanel(name); });
    action->setProperty("menu", tr("Show panel"));
  }
  menu->addSeparator();
  add(menu, "theme", tr("Light or dark"), tr("D"),
      [this] { setTheme(m_theme == Theme::Dark ? Theme::Light : Theme::Dark); });
  add(menu, "resetLayout", tr("Reset the layout"), {},
      [this] { m_docks->restoreState(m_firstLayout); });
  add(menu, "palette", tr("Command palette…"), tr("Ctrl+P"), [this] { showPalette(); });
}

void MainWindow::buildHelpMenu() {
  QMenu* menu = menuBar()->addMenu(tr("&Help"));
  add(menu, "keys", tr("Keys"), tr("H"), [this] { showKeys(); });
  add(menu, "about", tr("About Marey"), {}, [this] {
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
  std::vector<QAction*> out = m_commands;
  for (const auto& [id, dock] : m_panels) {
    for (QAction* action : dock->widget()->findChildren<QAction*>()) {
      if (action->shortcut().isEmpty() || action->text().isEmpty()) continue;
      action->setProperty("menu", dock->windowTitle());
      out.push_back(action);
    }
  }
  return out;
}

void MainWindow::showKeys() {
  QString rows;
  const auto row = [&rows](const QString& keys, const QString& what) {
    rows += QStringLiteral(
                "<tr><td style='padding:3px 24px 3px 0'><b>%1</b></td><td "
                "style='padding:3px 0'>%2</td></tr>")
                .arg(keys.toHtmlEscaped(), what.toHtmlEscaped());
  };
  for (const QAction* action : allCommands())
    if (!action->shortcut().isEmpty())
      row(action->shortcut().toString(QKeySequence::NativeText), action->text().remove(u'&'));
  // Keys that panels handle themselves say so in their "keys" property.
  for (const auto& [id, dock] : m_panels)
    for (const QString& line : dock->widget()->property("keys").toStringList())
      row(line.section(u'\t', 0, 0), line.section(u'\t', 1));
  auto* sheet = new QDialog(this);
  sheet->setObjectName(QStringLiteral("keySheet"));
  sheet->setAttribute(Qt::WA_DeleteOnClose);
  sheet->setWindowTitle(tr("Keys"));
  auto* text = new QTextBrowser(sheet);
  text->setHtml(QStringLiteral("<table>%1</table>").arg(rows));
  auto* layout = new QVBoxLayout(sheet);
  layout->addWidget(text);
  sheet->resize(560, 620);
  sheet->show();
}

}  // namespace marey::gui
