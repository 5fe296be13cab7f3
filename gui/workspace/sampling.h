// Sample sets drawn in the background: which systems, along what, and what need not be drawn again.
#pragma once

#include <QObject>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "gui/workspace/natural_motions.h"

namespace marey::gui {

class Sampling : public QObject {
  Q_OBJECT
 public:
  Sampling(NaturalParts parts, const NaturalMotions& natural, QObject* parent = nullptr);

  /// Draws a recipe; returns its group. `replaceGroup`, unless pinned, stays until the first
  /// motions are there. The colour is that of the recipe's system in the document, or `colourIndex`
  /// where it is none.
  int sample(const SampleRecipe& recipe, int replaceGroup = -1, int colourIndex = 0);
  /// The chosen systems along the current path with the document's settings. Sets that would come
  /// out as they are stay; noticed() says so.
  void sampleCurrentPath();
  /// The chosen systems along the control of every natural clip, as a report does; sets that are
  /// current stay.
  void sampleHeldOut();
  /// The chosen systems without held-out motions of the document as it is now.
  std::vector<std::string> withoutHeldOut() const;
  bool active() const { return !m_drawings.empty(); }
  void cancel();
  /// What is being drawn belongs to another document now.
  void forget() { m_drawings.clear(); }

  /// Whether sampleCurrentPath takes a system; at first it takes all.
  bool sampled(const std::string& system) const { return !m_leftOut.contains(system); }
  void setSampled(const std::string& system, bool sampled);
  const std::set<std::string>& leftOut() const { return m_leftOut; }
  void setLeftOut(std::set<std::string> systems) { m_leftOut = std::move(systems); }

 Q_SIGNALS:
  /// Motions of a group from `first` on are there, and nobody has been told yet.
  void drawn(int group, int first);
  void ended(int group);
  void noticed(const QString& what);
  void failed(const QString& title, const QString& error);

 private:
  /// A group whose motions are being drawn.
  struct Drawing {
    int job = -1;
    std::vector<int> replaces;  ///< groups that go when the first motions are there
    std::shared_ptr<std::string> modelHash;
  };
  const Experiment& experiment() const { return m_parts.document.experiment(); }
  std::string stampOf(const SampleRecipe& recipe) const;
  const MotionGroup* groupLike(const SampleRecipe& recipe) const;
  /// The groups that go for a new one in the place of `group`.
  std::vector<int> replacedBy(int group);
  Job::Work alongPath(const SampleRecipe& recipe, int group);
  Job::Work alongNatural(const SampleRecipe& recipe, int group);
  void addMotions(int group, const std::vector<RootFrame>& wanted, std::vector<Motion> motions);
  void finish(int group, const Drawing& drawing, bool successful);
  void dropReplaced(const std::vector<int>& groups);
  void jobEnded(int job, bool successful);
  void stopDrawing(int group);

  NaturalParts m_parts;
  const NaturalMotions& m_natural;
  std::map<int, Drawing> m_drawings;  ///< by group
  std::set<std::string> m_leftOut;    ///< systems that are not sampled
};

}  // namespace marey::gui
