// marey-workbench: the window.
#include <QCommandLineParser>
#include <QLoggingCategory>
#include <QTimer>
#include <cstdio>
#include <memory>

#include "gui/scene/scene_view.h"
#include "gui/shell/application.h"
#include "gui/shell/commands.h"
#include "gui/shell/main_window.h"
#include "gui/shell/no_display.h"
#include "gui/shell/panels.h"
#include "gui/shell/start_time.h"

#include "base/error.h"
#include "nn/engine/kernels/kernels.h"
#include "nn/torch/threads.h"

namespace marey::gui {
namespace {

constexpr int kWrongUsage = 2;

/// For whoever asks by QT_LOGGING_RULES=marey.start=true.
Q_LOGGING_CATEGORY(startLog, "marey.start", QtWarningMsg)

/// What is due, the first drawing too, is done before a timer of no time runs out.
void logStart(JobQueue& jobs) {
  if (!startLog().isDebugEnabled()) return;
  QTimer::singleShot(0, &jobs, [] {
    qCDebug(startLog, "the window answers %.2f s after the start", secondsSinceStart());
  });
  auto* once = new QObject(&jobs);
  QObject::connect(&jobs, &JobQueue::ended, once, [once, &jobs] {
    once->deleteLater();
    QTimer::singleShot(0, &jobs, [] {
      qCDebug(startLog, "its motions are shown %.2f s after the start", secondsSinceStart());
    });
  });
}

void describe(QCommandLineParser& parser) {
  parser.setApplicationDescription(
      QObject::tr("A workbench for generative models of motion. Without files it opens the demo.\n"
                  "\n"
                  "Example: marey-workbench walk.marey clips/*.bvh"));
  parser.addHelpOption();
  parser.addVersionOption();
  parser.addPositionalArgument(
      QStringLiteral("files"),
      QObject::tr("An experiment (.json), or models (.marey) and motion files for a new one."),
      QStringLiteral("[files...]"));
}

/// Help and version need no display. They end the program.
void answerQuestions(int argc, char** argv) {
  const QCoreApplication application(argc, argv);
  QCommandLineParser parser;
  describe(parser);
  parser.parse(QCoreApplication::arguments());
  if (parser.isSet(QStringLiteral("help"))) parser.showHelp();
  if (parser.isSet(QStringLiteral("version"))) parser.showVersion();
}

int run(int argc, char** argv) {
  SceneView::prepareApplication();
  auto guard = std::make_unique<NoDisplayGuard>();
  Application application(argc, argv);
  guard.reset();
  QCommandLineParser parser;
  describe(parser);
  if (!parser.parse(QApplication::arguments())) {
    std::fprintf(stderr, "%s\n", qPrintable(parser.errorText()));
    return kWrongUsage;
  }
  nn::configureThreads(0, true);
  JobQueue jobs;
  Workspace workspace(jobs, {});
  MainWindow window(workspace, panels());
  addPanelCommands(window, workspace);
  QObject::connect(&application, &Application::failed, &workspace, [&](const QString& error) {
    workspace.report(QObject::tr("The last command"), error);
  });
  window.show();
  QTimer::singleShot(0, &window, [&] {
    window.files().start(parser.positionalArguments());
    logStart(jobs);
  });
  return QApplication::exec();
}

}  // namespace
}  // namespace marey::gui

int main(int argc, char** argv) {
  QCoreApplication::setOrganizationName(QStringLiteral("Marey"));
  QCoreApplication::setApplicationName(QStringLiteral("Marey"));
  QCoreApplication::setApplicationVersion(QStringLiteral(MAREY_VERSION));
  try {
    marey::nn::kernels();  // MAREY_ISA is wrong from the start or not at all
  } catch (const marey::UsageError& e) {
    std::fprintf(stderr, "marey-workbench: %s\n", e.what());
    return marey::gui::kWrongUsage;
  }
  marey::gui::answerQuestions(argc, argv);
  return marey::gui::run(argc, argv);
}
