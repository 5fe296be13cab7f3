// Where documents are kept: open, save, recent files, and a copy of unsaved work that survives a
// crash.
#pragma once

#include <QLockFile>
#include <QStringList>
#include <QTimer>
#include <memory>
#include <vector>

#include "gui/workspace/workspace.h"

namespace marey::gui {

/// The embedded demonstration, unpacked into the user's data folder (its document names a model
/// file). Throws FileError.
Experiment demoDocument();

/// Unsaved work of a window that did not close. No other window is offered it while this lives.
struct Recovered {
  Experiment experiment;
  QString file;  ///< where the document had been saved; empty: nowhere
  QString when;
  QString copy;  ///< the file that holds it, until discard()
  std::shared_ptr<QLockFile> lock;
};

struct Recovery {
  std::vector<Recovered> kept;
  QStringList broken;  ///< why a copy cannot be read, and where it is now
};

/// Keeps a copy of the document in the user's data folder while it differs from its file, and
/// removes it when it is saved or the window closes.
class Autosave : public QObject {
  Q_OBJECT
 public:
  explicit Autosave(Workspace& workspace, QObject* parent = nullptr);
  ~Autosave() override;
  /// Copies left by windows that are no longer running. They stay where they are; one that cannot
  /// be read is renamed to NAME.broken, so that it is told of once and can still be looked into.
  static Recovery recover();
  /// Deletes a copy for good.
  static void discard(const Recovered& recovered);
  /// Writes the copy now; whether it is on the disk. Failing is reported once, not at every try.
  bool write();
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
