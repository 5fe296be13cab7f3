#include "gui/shell/main_window.h"

#include <QAbstractSpinBox>
#include <QAction>
#include <QApplication>
#include <QCloseEvent>
#include <QFileInfo>
#include <QLineEdit>
#include <QMessageBox>
#include <QMimeData>
#include <QPlainTextEdit>
#include <QSettings>
#include <QStatusBar>

#include "gui/common/number_box.h"
#include "gui/shell/job_bar.h"
#include "gui/shell/key_rules.h"
#include "gui/shell/offer_bar.h"
#include <qtadvanceddocking/DockAreaWidget.h>
#include <qtadvanceddocking/DockManager.h>
#include <qtadvanceddocking/DockWidget.h>

namespace marey::gui {
namespace {

ads::DockWidgetArea dockArea(PanelArea area) {
  switch (area) {
    case PanelArea::Left:
      return ads::LeftDockWidgetArea;
    case PanelArea::Right:
      return ads::RightDockWidgetArea;
    case PanelArea::Plots:
    case PanelArea::Bottom:
      return ads::BottomDockWidgetArea;
    case PanelArea::Centre:
      break;
  }
  return ads::CenterDockWidgetArea;
}

constexpr int kMessageMs = 8000;

}  // namespace

MainWindow::MainWindow(Workspace& workspace, const std::vector<PanelSpec>& panels)
    : m_workspace(workspace), m_autosave(std::make_unique<Autosave>(workspace)) {
  setObjectName(QStringLiteral("marey"));
  setAcceptDrops(true);
  new KeyRules(this);
  resize(1500, 920);
  buildDocks(panels);
  buildMenus();
  statusBar()->addPermanentWidget(new JobBar(workspace.jobs(), this));
  connect(&m_workspace, &Workspace::errorReported, this, &MainWindow::showError);
  connect(&m_workspace, &Workspace::noticed, this,
          [this](const QString& what) { statusBar()->showMessage(what, kMessageMs); });
  addToolBar(Qt::TopToolBarArea, new OfferBar(workspace, this));
  connect(&m_workspace.document(), &Document::changed, this, &MainWindow::refreshTitle);
  connect(&m_workspace.motions(), &MotionGroups::changed, this, &MainWindow::refreshBringBack);
  refreshTitle();
  refreshBringBack();
  const QSettings settings;
  setTheme(settings.value(QStringLiteral("theme")).toString() == QLatin1String("dark")
               ? Theme::Dark
               : Theme::Light);
  restoreGeometry(settings.value(QStringLiteral("geometry")).toByteArray());
  const QByteArray layout = settings.value(QStringLiteral("layout")).toByteArray();
  if (!layout.isEmpty()) m_docks->restoreState(layout);
}

MainWindow::~MainWindow() = default;

void MainWindow::buildDocks(const std::vector<PanelSpec>& panels) {
  ads::CDockManager::setConfigFlags(ads::CDockManager::DefaultOpaqueConfig);
  ads::CDockManager::setConfigFlag(ads::CDockManager::FocusHighlighting, false);
  ads::CDockManager::setConfigFlag(ads::CDockManager::DockAreaHasTabsMenuButton, false);
  ads::CDockManager::setConfigFlag(ads::CDockManager::DockAreaHasUndockButton, false);
  ads::CDockManager::setConfigFlag(ads::CDockManager::ActiveTabHasCloseButton, false);
  m_docks = new ads::CDockManager(this);
  m_docks->setStyleSheet({});  // the application's theme holds
  std::map<PanelArea, ads::CDockAreaWidget*> areas;
  for (const PanelSpec& spec : panels) {
    auto* dock = new ads::CDockWidget(spec.title);
    dock->setObjectName(spec.id);
    QWidget* content = spec.make({m_workspace, m_scene}, dock);
    content->setObjectName(spec.id + QStringLiteral("Panel"));
    dock->setWidget(content, ads::CDockWidget::ForceNoScrollArea);
    auto& area = areas[spec.area];
    if (area != nullptr)
      m_docks->addDockWidgetTabToArea(dock, area);
    else
      area =
          m_docks->addDockWidget(dockArea(spec.area), dock,
                                 spec.area == PanelArea::Plots ? areas[PanelArea::Right] : nullptr);
    m_panels[spec.id] = dock;
  }
  for (const auto& [place, area] : areas) area->setCurrentIndex(0);
  const auto size = [&](PanelArea area, const QList<int>& sizes) {
    if (areas.contains(area)) m_docks->setSplitterSizes(areas[area], sizes);
  };
  size(PanelArea::Centre, {300, 640, 560});
  size(PanelArea::Plots, {400, 300});
  size(PanelArea::Bottom, {665, 215});
  m_firstLayout = m_docks->saveState();
}

QWidget* MainWindow::showPanel(const QString& id) {
  const auto found = m_panels.find(id);
  if (found == m_panels.end()) return nullptr;
  found->second->toggleView(true);
  found->second->setAsCurrentTab();
  return found->second->widget();
}

void MainWindow::setTheme(Theme theme) {
  m_theme = theme;
  applyTheme(*qApp, theme);
  QSettings().setValue(QStringLiteral("theme"), theme == Theme::Dark ? "dark" : "light");
}

void MainWindow::refreshTitle() {
  const QString file = m_workspace.document().file();
  const QString name = file.isEmpty()
                           ? QString::fromStdString(m_workspace.document().experiment().title)
                           : QFileInfo(file).fileName();
  setWindowTitle(name + QStringLiteral("[*] – Marey"));
  setWindowModified(m_workspace.modified());
  const auto& history = m_workspace.document().history();
  const bool natural = !m_workspace.document().experiment().natural.empty();
  m_report->setEnabled(natural);
  m_reload->setEnabled(natural);
  m_undo->setEnabled(history.canUndo());
  m_redo->setEnabled(history.canRedo());
  m_undo->setText(history.canUndo()
                      ? tr("Undo %1").arg(QString::fromStdString(history.label(history.index())))
                      : tr("Undo"));
  m_redo->setText(history.canRedo() ? tr("Redo %1").arg(QString::fromStdString(
                                          history.label(history.index() + 1)))
                                    : tr("Redo"));
}

void MainWindow::refreshBringBack() {
  const auto& aside = m_workspace.motions().aside();
  m_bringBack->setEnabled(!aside.empty());
  m_bringBack->setText(aside.empty()
                           ? tr("Bring back removed motions")
                           : tr("Bring back “%1”").arg(QString::fromStdString(aside.back().name)));
}

void MainWindow::showError(const QString& title, const QString& error) {
  statusBar()->showMessage(title + QStringLiteral(": ") + error, kMessageMs);
  // Not modal: work goes on, and several errors do not queue up behind each other.
  if (m_errorBox == nullptr) {
    m_errorBox = new QMessageBox(QMessageBox::Warning, tr("Marey"), {}, QMessageBox::Ok, this);
    m_errorBox->setObjectName(QStringLiteral("errorBox"));
    m_errorBox->setModal(false);
    m_errorBox->setTextInteractionFlags(Qt::TextSelectableByMouse);
  }
  // What is still being read is not taken away.
  const bool first = !m_errorBox->isVisible();
  m_errorBox->setText(first ? tr("%1 did not work.").arg(title)
                            : tr("Several things did not work."));
  m_errorBox->setInformativeText(first ? error
                                       : m_errorBox->informativeText() + QStringLiteral("\n\n") +
                                             title + QStringLiteral(": ") + error);
  m_errorBox->show();
}

bool MainWindow::event(QEvent* event) {
  // Esc in a field of text means the field, not the work in the background.
  if (event->type() == QEvent::ShortcutOverride &&
      static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape) {
    const QWidget* at = QApplication::focusWidget();
    if (qobject_cast<const QLineEdit*>(at) || qobject_cast<const QAbstractSpinBox*>(at) ||
        qobject_cast<const QPlainTextEdit*>(at) || qobject_cast<const QTextEdit*>(at)) {
      event->accept();
      return true;
    }
  }
  return QMainWindow::event(event);
}

void MainWindow::closeEvent(QCloseEvent* event) {
  finishTyping();
  if (!mayDiscard()) {
    event->ignore();
    return;
  }
  QSettings settings;
  settings.setValue(QStringLiteral("geometry"), saveGeometry());
  settings.setValue(QStringLiteral("layout"), m_docks->saveState());
  m_workspace.jobs().cancelAll();
  m_autosave->remove();
  event->accept();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  QStringList files;
  for (const QUrl& url : event->mimeData()->urls())
    if (url.isLocalFile()) files += url.toLocalFile();
  openFiles(files);
  event->acceptProposedAction();
}

}  // namespace marey::gui
