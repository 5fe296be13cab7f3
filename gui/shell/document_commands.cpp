#include "gui/shell/document_commands.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QPushButton>

#include "families.h"
#include "gui/common/file_dialogs.h"

#include "base/error.h"
#include "experiment/edits.h"
#include "experiment/opened_files.h"
#include "experiment/run.h"
#include "io/clip_io.h"
#include "model/model_card.h"
#include "report/experiment_report.h"
#include "report/report.h"

namespace marey::gui {
namespace {

constexpr int kMessageMs = 4000, kReportMs = 8000;

}  // namespace

DocumentCommands::DocumentCommands(Workspace& workspace, QWidget& window)
    : QObject(&window),
      m_workspace(workspace),
      m_window(window),
      m_autosave(std::make_unique<Autosave>(workspace)) {}

void DocumentCommands::setImporter(std::function<void(const QStringList&)> importer) {
  m_importer = std::move(importer);
}

void DocumentCommands::start(const QStringList& files) {
  offerRecovery();
  if (files.isEmpty() && !m_workspace.modified()) openDemo();
  if (!files.isEmpty()) openFiles(files);
}

void DocumentCommands::openNew() {
  if (mayDiscard()) m_workspace.open({}, {});
}

void DocumentCommands::openDemo() {
  if (!mayDiscard()) return;
  try {
    m_workspace.open(demoDocument(), {});
  } catch (const Error& error) {
    m_workspace.report(tr("Opening the demo"), QString::fromStdString(error.what()));
  }
}

void DocumentCommands::open(const QString& given) {
  if (!mayDiscard()) return;
  const QString file =
      !given.isEmpty() ? given
                       : QFileDialog::getOpenFileName(&m_window, tr("Open an experiment"), {},
                                                      tr("Experiments (*.json);;All files (*)"));
  if (file.isEmpty()) return;
  try {
    m_workspace.open(readExperiment(file.toStdString()), file);
    rememberRecent(file);
  } catch (const Error& error) {
    m_workspace.report(tr("Opening %1").arg(file), QString::fromStdString(error.what()));
  }
}

bool DocumentCommands::saveTo(const QString& file) {
  if (!mayReplace(file)) return false;
  try {
    m_workspace.save(file);
  } catch (const Error& error) {
    m_workspace.report(tr("Saving"), QString::fromStdString(error.what()));
    return false;
  }
  rememberRecent(file);
  m_autosave->remove();
  return true;
}

bool DocumentCommands::save() {
  const QString file = m_workspace.document().file();
  if (file.isEmpty()) return saveAs();
  if (!saveTo(file)) return false;
  Q_EMIT said(tr("Saved %1").arg(file), kMessageMs);
  return true;
}

bool DocumentCommands::saveAs() {
  const QString file =
      askSaveFile(&m_window, tr("Save the experiment"), m_workspace.document().file(),
                  tr("Experiments (*.json)"), QStringLiteral("json"));
  return !file.isEmpty() && saveTo(file);
}

bool DocumentCommands::mayReplace(const QString& file) {
  if (!isEmpty(m_workspace.document().experiment()) || QFileInfo(file).size() == 0) return true;
  try {
    if (isEmpty(readExperiment(file.toStdString()))) return true;
  } catch (const Error&) {
    // What cannot be read here may be worth more than an empty document.
  }
  QMessageBox box(QMessageBox::Warning, tr("Marey"),
                  tr("The document is empty, but “%1” is not. Replace what it holds?").arg(file),
                  QMessageBox::Save | QMessageBox::Cancel, &m_window);
  box.setObjectName(QStringLiteral("replaceBox"));
  box.button(QMessageBox::Save)->setText(tr("Replace it"));
  box.setDefaultButton(QMessageBox::Cancel);
  return box.exec() == QMessageBox::Save;
}

bool DocumentCommands::mayDiscard() {
  if (!m_workspace.modified()) return true;
  const auto answer = QMessageBox::question(
      &m_window, tr("Marey"), tr("The document has changes that are not saved."),
      QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, QMessageBox::Save);
  if (answer == QMessageBox::Save) return save();
  return answer == QMessageBox::Discard;
}

void DocumentCommands::offerRecovery() {
  const Recovery found = Autosave::recover();
  for (const QString& fault : found.broken)
    m_workspace.report(tr("Recovering unsaved work"), fault);
  size_t asked = 0;
  for (const Recovered& one : found.kept) {
    ++asked;
    const QString name =
        one.file.isEmpty() ? QString::fromStdString(one.experiment.title) : one.file;
    QMessageBox box(QMessageBox::Question, tr("Unsaved work"),
                    tr("Marey ended without saving “%1” (last change %2). Open what was kept?")
                        .arg(name, one.when),
                    QMessageBox::Open | QMessageBox::Discard | QMessageBox::Cancel, &m_window);
    box.setObjectName(QStringLiteral("recoveryBox"));
    box.button(QMessageBox::Cancel)->setText(tr("Ask again next time"));
    const int answer = box.exec();
    if (answer == QMessageBox::Discard) Autosave::discard(one);
    if (answer != QMessageBox::Open) continue;
    openRecovered(one);
    break;
  }
  if (asked < found.kept.size())
    Q_EMIT said(tr("More unsaved work is kept (%1): Marey asks about it at its next "
                   "start.")
                    .arg(found.kept.size() - asked),
                0);
}

void DocumentCommands::openRecovered(const Recovered& recovered) {
  // It is where the history begins: undo must not go on to what nobody ever made.
  m_workspace.openUnsaved(recovered.experiment, recovered.file);
  // Until there is another copy, this is the only one.
  if (m_autosave->write()) Autosave::discard(recovered);
}

void DocumentCommands::addMotionFiles() {
  openFiles(QFileDialog::getOpenFileNames(&m_window, tr("Add natural motion"), {},
                                          tr("Motion (*.bvh *.amc *.npz *.txt);;All files (*)")));
}

void DocumentCommands::addModels() {
  openFiles(
      QFileDialog::getOpenFileNames(&m_window, tr("Add models"), {}, tr("Marey models (*.marey)")));
}

void DocumentCommands::openFiles(const QStringList& files) {
  std::vector<std::string> given;
  // Whole, since the document may be saved elsewhere.
  for (const QString& file : files)
    given.push_back(QFileInfo(file).absoluteFilePath().toStdString());
  const auto [documents, paths, models, motions] = sortOpened(given);
  if (documents.size() > 1)
    m_workspace.report(tr("Opening files"),
                       tr("Only one document can be open at a time; %1 is opened.")
                           .arg(QString::fromStdString(documents.front())));
  if (!documents.empty()) {
    const QString document = QString::fromStdString(documents.front());
    open(document);
    // Not opened: what came with it has no place in another document.
    if (m_workspace.document().file() != document) return;
  }
  for (const std::string& file : paths)
    m_workspace.document().edit(tr("Add path"), [&](Experiment& e) {
      addPath(e, {.name = std::filesystem::path(file).stem().string(),
                  .path = {},
                  .wayPoints = readPathFile(file),
                  .seconds = 0.0});
    });
  if (!models.empty()) addModelFiles(models);
  if (!motions.empty()) addMotions(motions);
}

void DocumentCommands::addMotions(const std::vector<std::string>& files) {
  if (m_importer) {
    QStringList names;
    for (const std::string& file : files) names += QString::fromStdString(file);
    return m_importer(names);
  }
  m_workspace.document().edit(tr("Add natural motion"), [&](Experiment& e) {
    for (const std::string& file : files) {
      std::error_code none;
      if (!std::filesystem::is_directory(file, none) && !io::isMotionFile(file))
        throw InputError({.path = file}, "an experiment, a model or a motion file",
                         "something else");
    }
    addNatural(e, files);
  });
}

void DocumentCommands::addModelFiles(const std::vector<std::string>& files) {
  auto temperatures = std::make_shared<std::vector<double>>();
  m_workspace.jobs().start(
      Lane::Files, tr("Adding models"),
      [workspace = &m_workspace, files, temperatures](Progress& progress) {
        for (size_t i = 0; i < files.size(); ++i) {
          progress.throwIfCancelled();
          // What is no model is refused here.
          workspace->models().model(files[i]);
          temperatures->push_back(modelAdvice(files[i]).temperature.value_or(1.0));
          progress.report(static_cast<double>(i + 1) / static_cast<double>(files.size()), files[i]);
        }
      },
      [this, files, temperatures] {
        m_workspace.document().edit(tr("Add models"), [&](Experiment& e) {
          for (size_t i = 0; i < files.size(); ++i)
            addSystem(e, files[i], std::filesystem::path(files[i]).stem().string(),
                      (*temperatures)[i]);
        });
      },
      this);
}

void DocumentCommands::writeReport() {
  const QString folder =
      QFileDialog::getSaveFileName(&m_window, tr("Folder of the report"), QStringLiteral("report"));
  if (folder.isEmpty()) return;
  const Experiment document = m_workspace.document().experiment();
  const std::string out = folder.toStdString();
  const auto missing = std::make_shared<std::string>();
  m_workspace.jobs().start(
      Lane::Exports, tr("Writing the report"),
      [document, out, missing](Progress& progress) {
        Progress running = progress.part(0.0, 0.7), drawing = progress.part(0.7, 0.8),
                 writing = progress.part(0.8, 1.0);
        const auto result = runExperiment(document, modelFamilies(), running);
        const auto data = report::reportOf(result, "marey report", drawing);
        report::writeReport(data, out, writing);
        *missing = report::missingText(result);
      },
      [this, folder, missing] {
        const QString written = tr("Report written to %1").arg(folder);
        Q_EMIT said(missing->empty() ? written
                                     : tr("%1; %2").arg(written, QString::fromStdString(*missing)),
                    kReportMs);
      },
      this);
}

}  // namespace marey::gui
