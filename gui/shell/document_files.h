// Where documents are kept: open, save, recent files, and a copy of unsaved work that survives a
// crash.
#pragma once

#include <QLockFile>
#include <QStringList>
#include <QTimer>
#include <memory>
#include <optional>

#include "shell/workspace.h"

namespace marey::gui {

/// The embedded demonstration, unpacked into the user's data folder (its document names a model
/// file). Throws FileError.
Experiment demoDocument();

/// Unsaved work of a window that did not close.
struct Recovered {
  Experiment experiment;
  QString file;  ///< where the document had been saved; empty: nowhere
  QString when;
};

/// Keeps a copy of the document in the user's data folder while it differs from its file, and
/// removes it when it is saved or the window closes.
class Autosave : public QObject {
  Q_OBJECT
 public:
  explicit Autosave(Workspace& workspace, QObject* parent = nullptr);
  ~Autosave() override;
  /// Copies left by windows that are no longer running; each is given once.
  static std::vector<Recovered> recover();
  /// Writes the copy now. Failing is reported once, not at every try.
  void write();
  void remove();

 private:
  Workspace& m_workspace;
  QString m_path;
  std::unique_ptr<QLockFile> m_lock;  ///< held while this window lives
  QTimer m_timer;
  bool m_failed = false;
};

QStringList recentFiles();
/// Puts a file first; the list keeps ten.
void rememberRecent(const QString& file);

}  // namespace marey::gui
