// What all panels share: the document with its history, the motions made from it, selection and
// time. Panels change it through these functions and redraw on its signals; they do not know each
// other.
#pragma once

#include <QObject>
#include <QString>
#include <functional>
#include <memory>

#include "shell/jobs.h"
#include "shell/motions.h"

#include "experiment/document.h"
#include "experiment/history.h"
#include "model/motion_model.h"

namespace marey::gui {

/// Lives on the GUI thread.
class Workspace : public QObject {
  Q_OBJECT
 public:
  Workspace(JobQueue& jobs, Experiment experiment, QObject* parent = nullptr);
  ~Workspace() override;

  // The document.
  const Experiment& experiment() const { return m_history.state(); }
  const History<Experiment>& history() const { return m_history; }
  /// Changes a copy and commits it under `label`; with `amend`, goes on with the last edit of that
  /// label (dragging). An exception of `change` is shown and leaves the document as it was.
  void edit(const QString& label, const std::function<void(Experiment&)>& change,
            bool amend = false);
  void undo();
  void redo();
  void goToEdit(size_t index);
  /// Another document: history, motions and selection start anew.
  void open(Experiment experiment, const QString& file);
  QString file() const { return m_file; }  ///< empty: never saved
  bool modified() const { return m_history.state() != m_saved; }
  /// Writes to `file` and takes it as the document's place; relative names are kept pointing at
  /// their files. Throws FileError, and then nothing has changed.
  void save(const QString& file);
  /// The path that the editor and the sampling panel work on; index into experiment().paths.
  int currentPath() const { return m_currentPath; }
  void setCurrentPath(int index);

  // Motions.
  const std::vector<MotionGroup>& groups() const { return m_groups; }
  const MotionGroup* group(int id) const;
  const Motion* motion(const MotionId& id) const;
  /// Index in experiment().systems, which gives the system its colour.
  int systemIndex(const std::string& name) const;
  void setVisible(int group, bool visible);
  void setVisible(const MotionId& id, bool visible);
  void setPinned(int group, bool pinned);
  void removeGroup(int group);
  /// A group that was made elsewhere (a steered motion); returns the id that it gets.
  int addGroup(MotionGroup group);
  /// Other motions in place of a group's; nothing where there is no such group.
  void setMotions(int group, std::vector<Motion> motions);
  /// Visible motions in the order of groups.
  std::vector<MotionId> visibleMotions() const;
  /// Joints of contact by the document's "feet", or found by name; empty where there are none.
  std::vector<int> feet() const;
  std::shared_ptr<const Skeleton> skeleton() const;  ///< of the first motion; null without motions

  // Work in the background. Results come by signals, errors by JobQueue::failed.
  void readNatural();
  /// Draws the recipe again where `replace` names its group. The colour is that of the recipe's
  /// system in the document, or `colourIndex` where it is none of them.
  void sample(const SampleRecipe& recipe, int replaceGroup = -1, int colourIndex = 0);
  /// All systems along the current path with the document's settings.
  void sampleCurrentPath();
  /// Log-likelihoods of the natural clips under a system, once. Null until they are there, which
  /// naturalScoresChanged tells.
  const std::vector<ClipScore>* naturalScores(const std::string& system) const;
  void scoreNatural(const std::string& system);
  /// Loads a model once per file content; callable from any thread.
  std::shared_ptr<const MotionModel> model(const std::string& file) const;
  std::string modelFile(const ExperimentSystem& system) const;
  JobQueue& jobs() { return m_jobs; }

  // Selection and time.
  const Selection& selection() const { return m_selection; }
  void select(Selection selection);
  bool selected(const MotionId& id) const { return m_selection.motions.contains(id); }
  double time() const { return m_time; }
  void setTime(double seconds);  ///< kept inside 0..duration()
  double duration() const;       ///< of the longest visible motion; 0 without one
  const std::optional<TimeRange>& range() const { return m_range; }
  void setRange(std::optional<TimeRange> range);
  /// The motion's part inside the range; all of it without one, null where nothing is inside.
  ClipPtr clipInRange(const MotionId& id) const;

  /// Shows an error to the user.
  void report(const QString& title, const QString& error);

 Q_SIGNALS:
  void documentChanged();
  void documentOpened();  ///< another one, before documentChanged
  void currentPathChanged();
  void motionsChanged();     ///< groups or their motions
  void visibilityChanged();  ///< after motionsChanged too
  void naturalScoresChanged();
  void selectionChanged();
  void timeChanged(double seconds);
  void rangeChanged();
  void errorReported(const QString& title, const QString& error);

 private:
  struct ModelCache;
  void documentMoved(const Experiment& before);
  void addMotions(int group, const std::vector<RootFrame>& wanted,
                  std::vector<SampledMotion> motions);
  void finishGroup(int group, const std::string& modelHash, bool successful);
  MotionGroup* findGroup(int id);
  void dropSelectionOf(int group);

  JobQueue& m_jobs;
  History<Experiment> m_history;
  Experiment m_saved;
  QString m_file;
  int m_currentPath = 0;
  std::vector<MotionGroup> m_groups;
  std::map<std::string, std::vector<ClipScore>> m_naturalScores;
  std::set<std::string> m_scoring;
  int m_naturalVersion = 0;  ///< counts readings, so that a late one is not taken
  int m_nextGroup = 1;
  Selection m_selection;
  double m_time = 0.0;
  std::optional<TimeRange> m_range;
  std::shared_ptr<ModelCache> m_models;
};

}  // namespace marey::gui
