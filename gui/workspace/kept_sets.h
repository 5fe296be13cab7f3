// What a document keeps of sample sets, and those that an opened one names, offered to be drawn
// again.
#pragma once

#include <QObject>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "gui/workspace/sampling.h"

namespace marey::gui {

class KeptSets : public QObject {
  Q_OBJECT
 public:
  KeptSets(Document& document, MotionGroups& motions, const NaturalMotions& natural,
           Sampling& sampling, QObject* parent = nullptr);

  /// Sets that the opened document names and that have not been drawn again.
  const std::vector<KeptSet>& offered() const { return m_offered; }
  /// Another document offers these; offeredChanged is due once it is there.
  void offer(std::vector<KeptSet> sets);
  void sampleOffered();
  void dismissOffered();

  /// All sets, as the document keeps them: drawn, being drawn and offered.
  std::vector<KeptSet> toKeep() const;
  /// Whether pinned sets came or went since setSaved().
  bool pinsMoved() const { return pinned() != m_savedPins; }
  void setSaved() { m_savedPins = pinned(); }

 Q_SIGNALS:
  void offeredChanged();
  void noticed(const QString& what);

 private:
  KeptSet kept(const MotionGroup& group) const;
  /// What tells pinned sets apart, drawn or offered; sorted.
  std::vector<std::string> pinned() const;
  /// Numbers of a group's motions that a flag is off for.
  std::vector<int> without(const MotionGroup& group, bool Motion::*flag,
                           std::vector<int> KeptSet::*kept) const;
  /// Motions from `first` on are hidden and left out as the document says.
  void mark(int group, int first);

  Document& m_document;
  MotionGroups& m_motions;
  const NaturalMotions& m_natural;
  Sampling& m_sampling;
  std::vector<KeptSet> m_offered;
  std::filesystem::path m_offeredFolder;  ///< where their names start
  std::vector<std::string> m_savedPins;   ///< pinned() of what was opened or saved
  std::map<int, KeptSet> m_drawn;         ///< what the document says of groups being drawn
};

}  // namespace marey::gui
