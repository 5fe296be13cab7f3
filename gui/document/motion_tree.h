// The tree of motions for views: natural motion by its sources, sample sets, and the document's
// models; thousands of motions cost nothing until looked at.
#pragma once

#include <QAbstractItemModel>

#include "gui/workspace/workspace.h"

namespace marey::gui {

class MotionTree : public QAbstractItemModel {
  Q_OBJECT
 public:
  /// Two things: the box of Name shows a motion, that of Use has it counted.
  enum Column { Name, Frames, Seconds, Score, Use, kColumns };

  explicit MotionTree(Workspace& workspace, QObject* parent = nullptr);

  /// A branch has index -1; models have no motion at all.
  MotionId idOf(const QModelIndex& index) const;
  /// Of a motion.
  QModelIndex indexOf(const MotionId& id) const;
  /// The document's name for where a natural motion or branch comes from; else empty.
  std::string sourceOf(const QModelIndex& index) const;
  /// All of a branch; that of a motion.
  std::vector<std::string> sourcesOf(const QModelIndex& index) const;
  /// The place of a model in the document; -1 for all other rows.
  int systemOf(const QModelIndex& index) const;

  QModelIndex index(int row, int column, const QModelIndex& parent = {}) const override;
  QModelIndex parent(const QModelIndex& child) const override;
  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role) override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;

 private:
  /// What a branch was at the last change of structure: views are told before rows move.
  struct Branch {
    int group = kModels;
    std::string source;       ///< natural motion of several sources: one, or the folder of files
    int first = 0, rows = 0;  ///< of the group's motions, or the number of models
    bool operator==(const Branch&) const = default;
  };
  static constexpr int kModels = -1;
  std::vector<Branch> branchesNow() const;
  void follow();
  void refreshColumn();
  /// The branch that `index` is or lies in.
  const Branch* branchOf(const QModelIndex& index) const;
  std::vector<MotionId> motionsOf(const Branch& branch) const;
  /// On the files of natural sources where some are missing: which, and why.
  std::vector<std::string> remarksOn(const Branch& branch, const MotionGroup& group) const;
  QVariant branchData(const Branch& branch, int column, int role) const;
  /// Of all motions in the branch.
  QVariant state(const Branch& branch, const MotionGroup& group, bool Motion::*flag) const;
  /// Of all scores there are; none where there are none, or several.
  std::optional<std::string> scoreUnit() const;
  QString scoreText(const ClipScore& score) const;
  QVariant modelData(size_t system, int column, int role) const;
  QVariant motionData(const MotionGroup& group, size_t index, int column, int role) const;

  Workspace& m_workspace;
  std::vector<Branch> m_branches;
};

}  // namespace marey::gui
