// Commands that read and write files.
#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QPushButton>
#include <QStatusBar>

#include "families.h"
#include "gui/common/file_dialogs.h"
#include "gui/shell/main_window.h"

#include "base/error.h"
#include "experiment/edits.h"
#include "experiment/opened_files.h"
#include "experiment/run.h"
#include "io/clip_io.h"
#include "model/model_card.h"
#include "report/experiment_report.h"
#include "report/report.h"

namespace marey::gui {

void MainWindow::start(const QStringList& files) {
  offerRecovery();
  if (files.isEmpty() && !m_workspace.modified()) openDemo();
  if (!files.isEmpty()) openFiles(files);
}

void MainWindow::openNew() {
  if (mayDiscard()) m_workspace.open({}, {});
}

void MainWindow::openDemo() {
  if (!mayDiscard()) return;
  try {
    m_workspace.open(demoDocument(), {});
  } catch (const Error& error) {
    showError(tr("Opening the demo"), QString::fromStdString(error.what()));
  }
}

void MainWindow::open(const QString& given) {
  if (!mayDiscard()) return;
  const QString file =
      !given.isEmpty() ? given
                       : QFileDialog::getOpenFileName(this, tr("Open an experiment"), {},
                                                      tr("Experiments (*.json);;All files (*)"));
  if (file.isEmpty()) return;
  try {
    m_workspace.open(readExperiment(file.toStdString()), file);
    rememberRecent(file);
  } catch (const Error& error) {
    showError(tr("Opening %1").arg(file), QString::fromStdString(error.what()));
  }
}

bool MainWindow::save() {
  if (m_workspace.document().file().isEmpty()) return saveAs();
  if (!mayReplace(m_workspace.document().file())) return false;
  try {
    m_workspace.save(m_workspace.document().file());
  } catch (const Error& error) {
    showError(tr("Saving"), QString::fromStdString(error.what()));
    return false;
  }
  rememberRecent(m_workspace.document().file());
  m_autosave->remove();
  statusBar()->showMessage(tr("Saved %1").arg(m_workspace.document().file()), 4000);
  return true;
}

bool MainWindow::saveAs() {
  const QString file = askSaveFile(this, tr("Save the experiment"), m_workspace.document().file(),
                                   tr("Experiments (*.json)"), QStringLiteral("json"));
  if (file.isEmpty() || !mayReplace(file)) return false;
  try {
    m_workspace.save(file);
  } catch (const Error& error) {
    showError(tr("Saving"), QString::fromStdString(error.what()));
    return false;
  }
  rememberRecent(file);
  m_autosave->remove();
  return true;
}

bool MainWindow::mayReplace(const QString& file) {
  if (!isEmpty(m_workspace.document().experiment()) || QFileInfo(file).size() == 0) return true;
  try {
    if (isEmpty(readExperiment(file.toStdString()))) return true;
  } catch (const Error&) {
    // What cannot be read here may be worth more than an empty document.
  }
  QMessageBox box(QMessageBox::Warning, tr("Marey"),
                  tr("The document is empty, but “%1” is not. Replace what it holds?").arg(file),
                  QMessageBox::Save | QMessageBox::Cancel, this);
  box.setObjectName(QStringLiteral("replaceBox"));
  box.button(QMessageBox::Save)->setText(tr("Replace it"));
  box.setDefaultButton(QMessageBox::Cancel);
  return box.exec() == QMessageBox::Save;
}

bool MainWindow::mayDiscard() {
  if (!m_workspace.modified()) return true;
  const auto answer = QMessageBox::question(
      this, tr("Marey"), tr("The document has changes that are not saved."),
      QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, QMessageBox::Save);
  if (answer == QMessageBox::Save) return save();
  return answer == QMessageBox::Discard;
}

void MainWindow::offerRecovery() {
  const Recovery found = Autosave::recover();
  for (const QString& fault : found.broken) showError(tr("Recovering unsaved work"), fault);
  size_t asked = 0;
  for (const Recovered& one : found.kept) {
    ++asked;
    const QString name =
        one.file.isEmpty() ? QString::fromStdString(one.experiment.title) : one.file;
    QMessageBox box(QMessageBox::Question, tr("Unsaved work"),
                    tr("Marey ended without saving “%1” (last change %2). Open what was kept?")
                        .arg(name, one.when),
                    QMessageBox::Open | QMessageBox::Discard | QMessageBox::Cancel, this);
    box.setObjectName(QStringLiteral("recoveryBox"));
    box.button(QMessageBox::Cancel)->setText(tr("Ask again next time"));
    const int answer = box.exec();
    if (answer == QMessageBox::Discard) Autosave::discard(one);
    if (answer != QMessageBox::Open) continue;
    openRecovered(one);
    break;
  }
  if (asked < found.kept.size())
    statusBar()->showMessage(tr("More unsaved work is kept (%1): Marey asks about it at its next "
                                "start.")
                                 .arg(found.kept.size() - asked));
}

void MainWindow::openRecovered(const Recovered& recovered) {
  // It is where the history begins: undo must not go on to what nobody ever made.
  m_workspace.openUnsaved(recovered.experiment, recovered.file);
  // Until there is another copy, this is the only one.
  if (m_autosave->write()) Autosave::discard(recovered);
}

void MainWindow::addMotionFiles() {
  openFiles(QFileDialog::getOpenFileNames(this, tr("Add natural motion"), {},
                                          tr("Motion (*.bvh *.amc *.npz *.txt);;All files (*)")));
}

void MainWindow::addModels() {
  openFiles(
      QFileDialog::getOpenFileNames(this, tr("Add models"), {}, tr("Marey models (*.marey)")));
}

void MainWindow::openFiles(const QStringList& files) {
  std::vector<std::string> given;
  // Whole, since the document may be saved elsewhere.
  for (const QString& file : files)
    given.push_back(QFileInfo(file).absoluteFilePath().toStdString());
  const auto [documents, paths, models, motions] = sortOpened(given);
  if (documents.size() > 1)
    showError(tr("Opening files"), tr("Only one document can be open at a time; %1 is opened.")
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
  if (!motions.empty() && m_importer) {
    QStringList names;
    for (const std::string& file : motions) names += QString::fromStdString(file);
    m_importer(names);
  } else if (!motions.empty()) {
    m_workspace.document().edit(tr("Add natural motion"), [&](Experiment& e) {
      for (const std::string& file : motions) {
        std::error_code none;
        if (!std::filesystem::is_directory(file, none) && !io::isMotionFile(file))
          throw InputError({.path = file}, "an experiment, a model or a motion file",
                           "something else");
      }
      addNatural(e, motions);
    });
  }
}

void MainWindow::addModelFiles(const std::vector<std::string>& files) {
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

void MainWindow::writeReport() {
  const QString folder =
      QFileDialog::getSaveFileName(this, tr("Folder of the report"), QStringLiteral("report"));
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
        statusBar()->showMessage(missing->empty()
                                     ? written
                                     : tr("%1; %2").arg(written, QString::fromStdString(*missing)),
                                 8000);
      },
      this);
}

}  // namespace marey::gui
