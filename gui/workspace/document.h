// The document with its history, and where it is kept.
#pragma once

#include <QObject>
#include <QString>
#include <functional>
#include <optional>

#include "experiment/document.h"
#include "experiment/history.h"

namespace marey::gui {

class Document : public QObject {
  Q_OBJECT
 public:
  explicit Document(Experiment experiment, QObject* parent = nullptr);

  const Experiment& experiment() const { return m_history.state(); }
  const History<Experiment>& history() const { return m_history; }
  /// Changes a copy and commits it under `label`; with `amend`, goes on with the last edit where
  /// that has the label and changed the same thing (dragging). The document stays as it was, and
  /// failed() says why, where `change` throws or its result could not be opened once saved.
  void edit(const QString& label, const std::function<void(Experiment&)>& change,
            bool amend = false);
  void undo();
  void redo();
  void goToEdit(size_t index);

  QString file() const { return m_file; }  ///< empty: never saved
  /// Whether it differs from what its file holds.
  bool edited() const { return !m_saved || experiment() != *m_saved; }
  /// Another document as it stands in `file`, or not (nullopt): its history starts anew. Tells
  /// nobody: changed() is due once all that belongs to it is there.
  void replace(Experiment experiment, std::optional<Experiment> saved, const QString& file);
  /// It has been written to `file` as `stored`. Returns whether names of files moved with it.
  bool setSaved(const Experiment& stored, const QString& file);

  /// The path that the editor and the sampling panel work on; index into experiment().paths.
  int currentPath() const { return m_currentPath; }
  void setCurrentPath(int index);
  /// Index in experiment().systems, which gives the system its colour; -1 where it is none.
  int systemIndex(const std::string& name) const;
  std::string modelFile(const ExperimentSystem& system) const;

 Q_SIGNALS:
  /// An edit, or going back and forth in the history, has changed it: first, so that what is made
  /// from it follows; then for whoever shows it; then, so that what takes longer begins.
  void moving(const marey::Experiment& before);
  void changed();  ///< it, or what is kept with it (pins, ticks)
  void moved(const marey::Experiment& before);
  void currentPathChanged();
  void failed(const QString& title, const QString& error);

 private:
  void tellMoved(const Experiment& before);

  History<Experiment> m_history;
  std::optional<Experiment> m_saved;  ///< none: the document is in no file
  QString m_file;
  int m_currentPath = 0;
};

}  // namespace marey::gui
