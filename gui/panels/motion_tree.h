// The tree of groups and motions for views; thousands of motions cost nothing until looked at.
#pragma once

#include <QAbstractItemModel>

#include "shell/workspace.h"

namespace marey::gui {

class MotionTree : public QAbstractItemModel {
  Q_OBJECT
 public:
  enum Column { Name, Frames, Seconds, Score, kColumns };

  explicit MotionTree(Workspace& workspace, QObject* parent = nullptr);

  /// index -1 of a MotionId stands for a whole group.
  MotionId idOf(const QModelIndex& index) const;
  QModelIndex indexOf(const MotionId& id) const;

  QModelIndex index(int row, int column, const QModelIndex& parent = {}) const override;
  QModelIndex parent(const QModelIndex& child) const override;
  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role) override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;

 private:
  /// What the rows were at the last change of structure: views are told before rows move.
  struct Rows {
    int group = 0, motions = 0;
    bool operator==(const Rows&) const = default;
  };
  void follow();
  void refreshColumn();
  QVariant groupData(const MotionGroup& group, int column, int role) const;
  QVariant motionData(const MotionGroup& group, size_t index, int column, int role) const;
  const MotionGroup* groupAt(int row) const;

  Workspace& m_workspace;
  std::vector<Rows> m_rows;
};

}  // namespace marey::gui
