#include "gui/workspace/document.h"

#include <algorithm>
#include <utility>

#include "experiment/edits.h"

namespace marey::gui {

Document::Document(Experiment experiment, QObject* parent)
    : QObject(parent), m_history(experiment), m_saved(std::move(experiment)) {}

void Document::edit(const QString& label, const std::function<void(Experiment&)>& change,
                    bool amend) {
  const Experiment before = experiment();
  Experiment next = before;
  try {
    change(next);
    next = asStored(next);
  } catch (const std::exception& error) {
    Q_EMIT failed(label, QString::fromUtf8(error.what()));
    return;
  }
  const std::string place = changedPlace(before, next);
  const bool moves = amend ? m_history.amend(std::move(next), label.toStdString(), place)
                           : m_history.commit(std::move(next), label.toStdString(), place);
  if (moves) tellMoved(before);
}

void Document::undo() {
  const Experiment before = experiment();
  m_history.undo();
  tellMoved(before);
}

void Document::redo() {
  const Experiment before = experiment();
  m_history.redo();
  tellMoved(before);
}

void Document::goToEdit(size_t index) {
  const Experiment before = experiment();
  m_history.goTo(index);
  tellMoved(before);
}

void Document::tellMoved(const Experiment& before) {
  const int paths = static_cast<int>(experiment().paths.size());
  m_currentPath = std::clamp(m_currentPath, 0, std::max(0, paths - 1));
  Q_EMIT moving(before);
  Q_EMIT changed();
  Q_EMIT moved(before);
}

void Document::replace(Experiment experiment, std::optional<Experiment> saved,
                       const QString& file) {
  m_saved = std::move(saved);
  m_history = History<Experiment>(std::move(experiment));
  m_file = file;
  m_currentPath = 0;
}

bool Document::setSaved(const Experiment& stored, const QString& file) {
  m_file = file;
  m_saved = stored;
  const bool moves = m_history.commit(stored, "Save in another folder");
  // What is edited next is another edit, so that undo comes back to what was saved.
  m_history.seal();
  return moves;
}

void Document::setCurrentPath(int index) {
  if (index == m_currentPath || index < 0 || index >= static_cast<int>(experiment().paths.size()))
    return;
  m_currentPath = index;
  Q_EMIT currentPathChanged();
}

std::string Document::modelFile(const ExperimentSystem& system) const {
  return (experiment().folder / system.model).string();
}

int Document::systemIndex(const std::string& name) const {
  const auto& systems = experiment().systems;
  for (size_t i = 0; i < systems.size(); ++i)
    if (systems[i].name == name) return static_cast<int>(i);
  return -1;
}

}  // namespace marey::gui
