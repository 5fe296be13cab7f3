// The natural clips of the document: read in the background, shown as before, scored under models.
#pragma once

#include <QObject>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gui/common/jobs.h"
#include "gui/workspace/document.h"
#include "gui/workspace/motion_groups.h"

#include "experiment/run.h"
#include "model/model_cache.h"

namespace marey::gui {

/// What natural motion needs of the rest of a workspace.
struct NaturalParts {
  JobQueue& jobs;
  std::shared_ptr<ModelCache> models;
  const Document& document;
  MotionGroups& motions;
};

class NaturalMotions : public QObject {
  Q_OBJECT
 public:
  explicit NaturalMotions(NaturalParts parts, QObject* parent = nullptr);

  /// Reads all natural sources again; what cannot be read is reported, the rest is shown.
  void read();
  /// What became of the files of each natural source, when they were read.
  const std::vector<std::pair<std::string, io::InputReport>>& inputs() const { return m_inputs; }
  /// Numbers of the clips that are counted.
  std::vector<int> used() const;
  /// Clips are counted unless the document leaves them out.
  void followUse();

  /// Log-likelihoods under a system, once: null until they are there, which scoresChanged tells.
  const std::vector<ClipScore>* scores(const std::string& system) const;
  void score(const std::string& system);

  /// Which clips are shown, as a document keeps it. While they are being read, what was asked for
  /// still holds; none: a few.
  std::optional<std::vector<ShownClips>> shown() const;
  void showWhenRead(std::optional<std::vector<ShownClips>> shown) { m_shown = std::move(shown); }
  /// Sources by what the document calls them now, in the order of shown().
  void renameSources(const std::vector<ShownClips>& shown);

 Q_SIGNALS:
  void scoresChanged();
  void noticed(const QString& what);
  void failed(const QString& title, const QString& error);

 private:
  void take(NaturalMotion natural);
  void chooseShown(MotionGroup& group);

  NaturalParts m_parts;
  std::map<std::string, std::vector<ClipScore>> m_scores;  ///< by ModelCache::stampOf
  std::map<std::string, int> m_scoring;                    ///< jobs, likewise
  int m_version = 0;  ///< counts readings, so that a late one is not taken
  int m_job = -1;
  /// What is to be shown when they are read; none: as before, and a few of new ones.
  std::optional<std::vector<ShownClips>> m_shown;
  std::vector<std::pair<std::string, io::InputReport>> m_inputs;
};

}  // namespace marey::gui
