#include "gui/shell/main_window.h"

#include <QAbstractSpinBox>
#include <QAction>
#include <QApplication>
#include <QCloseEvent>
#include <QFileInfo>
#include <QLineEdit>
#include <QMimeData>
#include <QPlainTextEdit>
#include <QSettings>
#include <QStatusBar>

#include "gui/common/number_box.h"
#include "gui/shell/job_bar.h"
#include "gui/shell/key_rules.h"
#include "gui/shell/offer_bar.h"

namespace marey::gui {
namespace {

constexpr int kMessageMs = 8000;

}  // namespace

MainWindow::MainWindow(Workspace& workspace, const std::vector<PanelSpec>& panels)
    : m_workspace(workspace), m_files(new DocumentCommands(workspace, *this)), m_menus(*this) {
  setObjectName(QStringLiteral("marey"));
  setAcceptDrops(true);
  new KeyRules(this);
  resize(1500, 920);
  m_docks = std::make_unique<Docks>(*this, panels, Desk{workspace, m_scene});
  buildMenus();
  statusBar()->addPermanentWidget(new JobBar(workspace.jobs(), this));
  addToolBar(Qt::TopToolBarArea, new OfferBar(workspace, this));
  connectWorkspace();
  refreshTitle();
  refreshBringBack();
  restore();
}

void MainWindow::connectWorkspace() {
  const auto say = [this](const QString& what, int milliseconds) {
    statusBar()->showMessage(what, milliseconds);
  };
  connect(m_files, &DocumentCommands::said, this, say);
  connect(&m_workspace, &Workspace::noticed, this,
          [say](const QString& what) { say(what, kMessageMs); });
  connect(&m_workspace, &Workspace::errorReported, this, &MainWindow::showError);
  connect(&m_workspace.document(), &Document::changed, this, &MainWindow::refreshTitle);
  connect(&m_workspace.motions(), &MotionGroups::changed, this, &MainWindow::refreshBringBack);
}

void MainWindow::restore() {
  const QSettings settings;
  setTheme(settings.value(QStringLiteral("theme")).toString() == QLatin1String("dark")
               ? Theme::Dark
               : Theme::Light);
  restoreGeometry(settings.value(QStringLiteral("geometry")).toByteArray());
  const QByteArray layout = settings.value(QStringLiteral("layout")).toByteArray();
  if (!layout.isEmpty()) m_docks->setLayout(layout);
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
  if (m_errors == nullptr) m_errors = new ErrorBox(this);
  m_errors->tell(title, error);
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
  if (!m_files->mayDiscard()) {
    event->ignore();
    return;
  }
  QSettings settings;
  settings.setValue(QStringLiteral("geometry"), saveGeometry());
  settings.setValue(QStringLiteral("layout"), m_docks->layout());
  m_workspace.jobs().cancelAll();
  m_files->forgetCopy();
  event->accept();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  QStringList files;
  for (const QUrl& url : event->mimeData()->urls())
    if (url.isLocalFile()) files += url.toLocalFile();
  m_files->openFiles(files);
  event->acceptProposedAction();
}

}  // namespace marey::gui
