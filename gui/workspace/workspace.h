// What all panels share: the document with its history, the motions made from it, selection and
// time. Panels change it through these functions and redraw on its signals; they do not know each
// other.
#pragma once

#include <QObject>
#include <QString>
#include <functional>
#include <memory>

#include "gui/common/jobs.h"

#include "experiment/document.h"
#include "experiment/history.h"
#include "experiment/motions.h"
#include "experiment/run.h"
#include "model/model_cache.h"

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
  /// Changes a copy and commits it under `label`; with `amend`, goes on with the last edit where
  /// that has the label and changed the same thing (dragging). The document stays as it was, and
  /// the reason is shown, where `change` throws or its result could not be opened once saved.
  void edit(const QString& label, const std::function<void(Experiment&)>& change,
            bool amend = false);
  void undo();
  void redo();
  void goToEdit(size_t index);
  /// Another document: history, motions and selection start anew.
  void open(Experiment experiment, const QString& file);
  /// The same for one that is not as it stands in `file`, and there is no way back behind it.
  void openUnsaved(Experiment experiment, const QString& file);
  QString file() const { return m_file; }  ///< empty: never saved
  /// Whether saving would keep what is lost without: edits, and sets that were pinned or let go.
  bool modified() const {
    return !m_saved || m_history.state() != *m_saved || pinnedSets() != m_savedPins;
  }
  /// Writes to `file` and takes it as the document's place; relative names are kept pointing at
  /// their files. Throws FileError, and then nothing has changed.
  void save(const QString& file);
  /// The document with how it is looked at now, as it is written.
  Experiment document();
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
  void setVisible(const std::vector<MotionId>& ids, bool visible);
  /// Whether plots and statistics count motions, shown or hidden. Of natural clips it is an edit of
  /// the document (by their names), so that a report leaves out the same ones; of samples it is
  /// kept with their set.
  void setUsed(const std::vector<MotionId>& ids, bool used);
  /// Hides all others.
  void showOnly(const std::set<MotionId>& shown);
  void setPinned(int group, bool pinned);
  /// Also ends the drawing of its motions.
  void removeGroup(int group);
  /// The same, but bringBack() has it again: samples are no part of the document's history.
  void setAside(int group);
  /// The last groups that were set aside in this document, the latest at the end.
  const std::vector<MotionGroup>& aside() const { return m_aside; }
  void bringBack();
  /// A group that was made elsewhere (a steered motion); returns the id that it gets.
  int addGroup(MotionGroup group);
  /// Other motions in place of a group's; nothing where there is no such group.
  void setMotions(int group, std::vector<Motion> motions);
  /// Visible motions in the order of groups.
  std::vector<MotionId> visibleMotions() const;
  /// Joints of contact by the document's "feet", or found by name; empty where there are none.
  std::vector<int> feet() const;
  /// That most motions of the first group have; null without motions.
  std::shared_ptr<const Skeleton> skeleton() const;

  // Work in the background. Results come by signals, errors by JobQueue::failed.
  /// Reads all natural sources again; what cannot be read is reported, the rest is shown.
  void readNatural();
  /// What became of the files of each natural source, when they were read.
  const std::vector<std::pair<std::string, io::InputReport>>& naturalInputs() const {
    return m_naturalInputs;
  }
  /// Draws a recipe. `replaceGroup`, unless pinned, stays until the first motions are there. The
  /// colour is that of the recipe's system in the document, or `colourIndex` where it is none.
  void sample(const SampleRecipe& recipe, int replaceGroup = -1, int colourIndex = 0);
  /// The chosen systems along the current path with the document's settings. Sets that would come
  /// out as they are stay; noticed() says so.
  void sampleCurrentPath();
  /// The chosen systems along the control of every natural clip, as a report does; sets that are
  /// current stay.
  void sampleHeldOut();
  /// The chosen systems without held-out motions of the document as it is now.
  std::vector<std::string> withoutHeldOut() const;
  /// What plots compare: motions along a path, or those along held-out control.
  Comparison comparison() const { return m_comparison; }
  void setComparison(Comparison comparison);
  /// Sets that the opened document names and that have not been drawn again.
  const std::vector<KeptSet>& offered() const { return m_offered; }
  void sampleOffered();
  void dismissOffered();
  /// Whether sampleCurrentPath takes a system; at first it takes all.
  bool sampled(const std::string& system) const { return !m_leftOut.contains(system); }
  void setSampled(const std::string& system, bool sampled);
  bool sampling() const { return !m_drawings.empty(); }
  void cancelSampling();
  /// Ends reading, sampling and plotting; what is being written goes on.
  void cancelWork();
  /// Log-likelihoods of the natural clips under a system, once. Null until they are there, which
  /// naturalScoresChanged tells.
  const std::vector<ClipScore>* naturalScores(const std::string& system) const;
  void scoreNatural(const std::string& system);
  /// Loads a model once per file content; callable from any thread.
  std::shared_ptr<const MotionModel> model(const std::string& file) const {
    return m_models->model(file);
  }
  /// What a sampling of a system's model takes. Throws FileError or InputError.
  std::vector<SamplingOption> optionSchema(const ExperimentSystem& system) const {
    return m_models->optionSchema(modelFile(system));
  }
  std::string modelFile(const ExperimentSystem& system) const;
  /// The types of motion that models which are open know, and the paths of the document name.
  std::vector<std::string> motionTypes() const;
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

  /// Shows an error to the user.
  void report(const QString& title, const QString& error);

 Q_SIGNALS:
  void documentChanged();
  void documentOpened();  ///< another one, before documentChanged
  void currentPathChanged();
  void motionsChanged();     ///< groups or their motions, or how the document measures them
  void visibilityChanged();  ///< after motionsChanged too
  void naturalScoresChanged();
  void selectionChanged();
  void timeChanged(double seconds);
  void rangeChanged();
  void comparisonChanged();
  void offeredChanged();
  /// The document is written: whoever shows it adds how it does.
  void viewAsked(ViewState& view);
  /// A document was opened, after documentChanged: to be looked at as it was.
  void viewOpened(const ViewState& view);
  void noticed(const QString& what);  ///< news that are no error
  void errorReported(const QString& title, const QString& error);

 private:
  /// A group whose motions are being drawn.
  struct Drawing {
    int job = -1;
    std::vector<int> replaces;  ///< groups that go when the first motions are there
    std::shared_ptr<std::string> modelHash;
  };
  void start(Experiment experiment, std::optional<Experiment> saved, const QString& file);
  void documentMoved(const Experiment& before);
  /// Motions of a system that was only renamed stay its own.
  void followRenamed(const Experiment& before);
  bool recolour();
  /// Natural clips are used unless the document leaves them out.
  void followUse();
  void takeNatural(NaturalMotion natural);
  void jobEnded(int job, bool successful);
  // Workspace_view.cpp
  void takeView(ViewState view);
  std::vector<ShownClips> shownClips() const;
  void renameSources(const std::vector<ShownClips>& shown);
  /// The same with names that start at the document's folder.
  SampleRecipe recipeHere(const SampleRecipe& recipe) const;
  std::vector<KeptSet> keptSets() const;
  /// What tells pinned sets apart, drawn or offered; sorted.
  std::vector<std::string> pinnedSets() const;
  /// Numbers of a group's motions that a flag is off for.
  std::vector<int> without(const MotionGroup& group, bool Motion::*flag,
                           std::vector<int> KeptSet::*kept) const;
  /// Its motions from `fresh` on are hidden and left out as the document says.
  void markAsKept(MotionGroup& group, size_t fresh);
  void showNatural(MotionGroup& group);
  // Workspace_held_out.cpp
  SampleRecipe heldOutRecipe(const ExperimentSystem& system) const;
  std::string stampOf(const SampleRecipe& recipe) const;
  std::vector<int> usedNatural() const;
  const MotionGroup* groupLike(const SampleRecipe& recipe) const;
  void dropHeldOut();
  Job::Work heldOutWork(const SampleRecipe& recipe, int group);
  void takeHeldOut(int group, std::vector<Motion> motions);
  /// Draws the motions of a group and hands them over as they come.
  Job::Work drawingWork(const SampleRecipe& recipe, int group);
  void addMotions(int group, const std::vector<RootFrame>& wanted,
                  std::vector<SampledMotion> motions);
  void finishGroup(int group, const Drawing& drawing, bool successful);
  void dropReplaced(const std::vector<int>& groups);
  MotionGroup* findGroup(int id);
  void dropSelectionOf(int group);
  void tellMotions();
  void tellVisibility();

  JobQueue& m_jobs;
  History<Experiment> m_history;
  std::optional<Experiment> m_saved;  ///< none: the document is in no file
  QString m_file;
  int m_currentPath = 0;
  std::vector<MotionGroup> m_groups, m_aside;
  std::map<int, Drawing> m_drawings;                              ///< by group
  std::map<std::string, std::vector<ClipScore>> m_naturalScores;  ///< by ModelCache::stampOf
  std::map<std::string, int> m_scoring;                           ///< jobs, likewise
  std::set<std::string> m_leftOut;                                ///< systems that are not sampled
  int m_naturalVersion = 0;  ///< counts readings, so that a late one is not taken
  int m_naturalJob = -1;
  int m_nextGroup = 1;
  Selection m_selection;
  Comparison m_comparison = Comparison::ThisPath;
  std::vector<KeptSet> m_offered;
  std::filesystem::path m_offeredFolder;  ///< where their names start
  std::vector<std::string> m_savedPins;   ///< pinnedSets() of what was opened or saved
  /// What is to be shown of natural motion when it is read; none: as before, and a few of new ones.
  std::optional<std::vector<ShownClips>> m_naturalShown;
  std::vector<std::pair<std::string, io::InputReport>> m_naturalInputs;
  std::map<int, KeptSet> m_kept;  ///< what the document says of groups being drawn
  double m_time = 0.0;
  std::optional<TimeRange> m_range;
  std::shared_ptr<ModelCache> m_models;
};

}  // namespace marey::gui
