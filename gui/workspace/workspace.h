// What the rooms of the window share, made of pieces that each know only those before them. Whoever
// needs one piece takes that one.
#pragma once

#include <QObject>
#include <QString>
#include <memory>
#include <vector>

#include "gui/common/jobs.h"
#include "gui/workspace/document.h"
#include "gui/workspace/kept_sets.h"
#include "gui/workspace/motion_groups.h"
#include "gui/workspace/natural_motions.h"
#include "gui/workspace/sampling.h"
#include "gui/workspace/view.h"

namespace marey::gui {

/// Lives on the GUI thread. Its own functions concern several pieces at once.
class Workspace : public QObject {
  Q_OBJECT
 public:
  Workspace(JobQueue& jobs, Experiment experiment, QObject* parent = nullptr);
  ~Workspace() override;

  Document& document() { return m_document; }
  const Document& document() const { return m_document; }
  MotionGroups& motions() { return m_motions; }
  const MotionGroups& motions() const { return m_motions; }
  View& view() { return m_view; }
  const View& view() const { return m_view; }
  NaturalMotions& natural() { return m_natural; }
  const NaturalMotions& natural() const { return m_natural; }
  Sampling& sampling() { return m_sampling; }
  const Sampling& sampling() const { return m_sampling; }
  KeptSets& kept() { return m_kept; }
  const KeptSets& kept() const { return m_kept; }
  /// Loads a model once per file content; callable from any thread.
  ModelCache& models() const { return *m_models; }
  JobQueue& jobs() { return m_jobs; }

  /// Another document: history, motions and selection start anew.
  void open(Experiment experiment, const QString& file);
  /// The same for one that is not as it stands in `file`, and there is no way back behind it.
  void openUnsaved(Experiment experiment, const QString& file);
  /// Whether saving would keep what is lost without: edits, and sets that were pinned or let go.
  bool modified() const { return m_document.edited() || m_kept.pinsMoved(); }
  /// Writes to `file` and takes it as the document's place; relative names are kept pointing at
  /// their files. Throws FileError, and then nothing has changed.
  void save(const QString& file);
  /// The document with how it is looked at now, as it is written.
  Experiment toWrite();
  /// Whether plots and statistics count motions, shown or hidden. Of natural clips it is an edit of
  /// the document (by their names), so that a report leaves out the same ones; of samples it is
  /// kept with their set.
  void setUsed(const std::vector<MotionId>& ids, bool used);
  /// Joints of contact by the document's "feet", or found by name; empty where there are none.
  std::vector<int> feet() const;
  stats::ContactRule contactRule() const;
  /// The types of motion that models which are open know, and the paths of the document name.
  std::vector<std::string> motionTypes() const;
  /// What a sampling of a system's model takes. Throws FileError or InputError.
  std::vector<SamplingOption> optionSchema(const ExperimentSystem& system) const {
    return m_models->optionSchema(m_document.modelFile(system));
  }
  /// Ends reading, sampling and plotting; what is being written goes on.
  void cancelWork();
  /// Shows an error to the user.
  void report(const QString& title, const QString& error);

 Q_SIGNALS:
  void opened();  ///< another document, before Document::changed
  /// The document is written: whoever shows it adds how it does.
  void viewAsked(ViewState& view);
  /// A document was opened, after Document::changed: to be looked at as it was.
  void viewOpened(const ViewState& view);
  void noticed(const QString& what);  ///< news that are no error
  void errorReported(const QString& title, const QString& error);

 private:
  void connectPieces();
  void start(Experiment experiment, std::optional<Experiment> saved, const QString& file);
  void takeView(ViewState view);
  void followDocument(const Experiment& before);
  /// Motions of a system that was only renamed stay its own.
  void followRenamed(const Experiment& before);
  std::vector<std::string> systemNames() const;

  JobQueue& m_jobs;
  std::shared_ptr<ModelCache> m_models;
  Document m_document;
  MotionGroups m_motions;
  View m_view;
  NaturalMotions m_natural;
  Sampling m_sampling;
  KeptSets m_kept;
  bool m_motionsFollow = false;  ///< the document's last move changed groups, who have not told
};

}  // namespace marey::gui
