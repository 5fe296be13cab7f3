// marey-workbench: the window.
#include <QApplication>
#include <QSurfaceFormat>
#include <QTimer>

#include "panels/commands.h"
#include "panels/panels.h"
#include "shell/main_window.h"
#include <QVTKOpenGLNativeWidget.h>

#include "base/error.h"
#include "nn/threads.h"

int main(int argc, char** argv) {
  using namespace marey::gui;
  QSurfaceFormat format = QVTKOpenGLNativeWidget::defaultFormat();
  format.setSamples(0);
  QSurfaceFormat::setDefaultFormat(format);
  QApplication application(argc, argv);
  QApplication::setOrganizationName(QStringLiteral("Marey"));
  QApplication::setApplicationName(QStringLiteral("Marey"));
  QApplication::setApplicationVersion(QStringLiteral(MAREY_VERSION));
  marey::nn::configureThreads(0, true);
  JobQueue jobs;
  Workspace workspace(jobs, {});
  MainWindow window(workspace, panels());
  addPanelCommands(window, workspace);
  window.show();
  QStringList files = QApplication::arguments().mid(1);
  QTimer::singleShot(0, &window, [&] {
    window.offerRecovery();
    if (workspace.modified()) return;
    try {
      workspace.open(demoDocument(), {});
    } catch (const marey::Error& error) {
      workspace.report(QObject::tr("Opening the demo"), QString::fromStdString(error.what()));
    }
    if (!files.isEmpty()) window.openFiles(files);
  });
  return QApplication::exec();
}
