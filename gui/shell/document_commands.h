// Commands that read and write files: documents, what is added to them, their reports.
#pragma once

#include <QObject>
#include <QStringList>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gui/document/document_files.h"

namespace marey::gui {

/// Errors are shown by the workspace; nothing is lost.
class DocumentCommands : public QObject {
  Q_OBJECT
 public:
  /// Dialogs belong to `window`.
  DocumentCommands(Workspace& workspace, QWidget& window);

  /// What the program does first: offers unsaved work, then opens `files`, the demo without any.
  void start(const QStringList& files);
  /// Opens a document, or adds motion files and models to the present one, by what they are.
  void openFiles(const QStringList& files);
  /// Takes over motion files that are added or dropped; without one they are added as they are.
  void setImporter(std::function<void(const QStringList& files)> importer);
  /// Offers unsaved work of windows that crashed.
  void offerRecovery();

  void openNew();
  void openDemo();
  void open(const QString& file);  ///< empty: asks which
  bool save();
  bool saveAs();
  /// Asks about unsaved changes; false: stay.
  bool mayDiscard();
  void addMotionFiles();
  void addModels();
  void writeReport();
  /// The window closes: no copy of unsaved work is needed.
  void forgetCopy() { m_autosave->remove(); }

 Q_SIGNALS:
  /// For the status bar; it stays where `milliseconds` is 0.
  void said(const QString& message, int milliseconds);

 private:
  bool saveTo(const QString& file);
  /// Whether the document may take the place of what the file holds: an empty one asks.
  bool mayReplace(const QString& file);
  void addModelFiles(const std::vector<std::string>& files);
  void addMotions(const std::vector<std::string>& files);
  void openRecovered(const Recovered& recovered);

  Workspace& m_workspace;
  QWidget& m_window;
  std::unique_ptr<Autosave> m_autosave;
  std::function<void(const QStringList&)> m_importer;
};

}  // namespace marey::gui
