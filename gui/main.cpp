// marey-workbench: the window.
#include <QCommandLineParser>
#include <QTimer>
#include <cstdio>

#include "panels/commands.h"
#include "panels/panels.h"
#include "panels/scene_view.h"
#include "shell/application.h"
#include "shell/main_window.h"

#include "nn/threads.h"

namespace marey::gui {
namespace {

constexpr int kWrongUsage = 2;

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
  SceneView::setDefaultFormat();
  Application application(argc, argv);
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
  QTimer::singleShot(0, &window, [&] { window.start(parser.positionalArguments()); });
  return QApplication::exec();
}

}  // namespace
}  // namespace marey::gui

int main(int argc, char** argv) {
  QCoreApplication::setOrganizationName(QStringLiteral("Marey"));
  QCoreApplication::setApplicationName(QStringLiteral("Marey"));
  QCoreApplication::setApplicationVersion(QStringLiteral(MAREY_VERSION));
  marey::gui::answerQuestions(argc, argv);
  return marey::gui::run(argc, argv);
}
