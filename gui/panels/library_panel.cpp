#include "panels/library_panel.h"

#include <QHBoxLayout>
#include <QHeaderView>
#include <QLineEdit>
#include <QMenu>
#include <QSortFilterProxyModel>
#include <QToolButton>
#include <QTreeView>
#include <QVBoxLayout>

#include "panels/motion_tree.h"

namespace marey::gui {
namespace {

class LibraryPanel : public QWidget {
 public:
  LibraryPanel(Workspace& workspace, QWidget* parent)
      : QWidget(parent), m_workspace(workspace), m_model(workspace, this) {
    m_filter.setSourceModel(&m_model);
    m_filter.setRecursiveFilteringEnabled(true);
    m_filter.setFilterCaseSensitivity(Qt::CaseInsensitive);
    auto* search = new QLineEdit(this);
    search->setObjectName(QStringLiteral("motionFilter"));
    search->setPlaceholderText(tr("Filter by name"));
    search->setClearButtonEnabled(true);
    buildView();
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(6, 6, 6, 6);
    layout->addWidget(search);
    layout->addWidget(m_view);
    connect(search, &QLineEdit::textChanged, this, [this](const QString& text) {
      m_filter.setFilterFixedString(text);
      if (!text.isEmpty()) m_view->expandAll();
    });
    connect(m_view->selectionModel(), &QItemSelectionModel::selectionChanged, this,
            &LibraryPanel::takeSelection);
    connect(&workspace, &Workspace::selectionChanged, this, &LibraryPanel::showSelection);
    connect(&m_model, &QAbstractItemModel::modelReset, this, [this] {
      expandSmall();
      showSelection();
    });
    connect(&m_model, &QAbstractItemModel::rowsInserted, this, [this] { expandSmall(); });
    connect(m_view, &QWidget::customContextMenuRequested, this, &LibraryPanel::showMenu);
  }

 private:
  void buildView() {
    m_view = new QTreeView(this);
    m_view->setObjectName(QStringLiteral("motionTree"));
    m_view->setModel(&m_filter);
    m_view->setUniformRowHeights(true);
    m_view->setAlternatingRowColors(true);
    m_view->setSelectionMode(QAbstractItemView::ExtendedSelection);
    m_view->setContextMenuPolicy(Qt::CustomContextMenu);
    m_view->header()->setStretchLastSection(false);
    m_view->header()->setSectionResizeMode(MotionTree::Name, QHeaderView::Stretch);
    m_view->header()->setMinimumSectionSize(36);
    m_view->header()->hideSection(MotionTree::Frames);  // seconds say as much; the tooltip has both
    m_view->header()->resizeSection(MotionTree::Seconds, 46);
    m_view->header()->resizeSection(MotionTree::Score, 50);
    m_view->setIndentation(14);
  }

  MotionId idAt(const QModelIndex& index) const {
    return m_model.idOf(m_filter.mapToSource(index));
  }

  /// Long lists stay closed until asked for.
  void expandSmall() {
    constexpr int kFew = 40;
    for (int row = 0; row < m_filter.rowCount(); ++row) {
      const QModelIndex group = m_filter.index(row, 0);
      const int motions = m_filter.rowCount(group);
      if (motions > 0 && motions <= kFew && !m_known.contains(idAt(group).group)) {
        m_view->expand(group);
        m_known.insert(idAt(group).group);
      }
    }
  }

  void takeSelection() {
    if (m_following) return;
    Selection next{.joint = m_workspace.selection().joint};
    for (const QModelIndex& index : m_view->selectionModel()->selectedRows()) {
      const MotionId id = idAt(index);
      if (id.index >= 0) next.motions.insert(id);
    }
    m_workspace.select(std::move(next));
  }

  void showSelection() {
    m_following = true;
    QItemSelection rows;
    for (const MotionId& id : m_workspace.selection().motions) {
      const QModelIndex index = m_filter.mapFromSource(m_model.indexOf(id));
      if (index.isValid()) rows.select(index, index);
    }
    m_view->selectionModel()->select(
        rows, QItemSelectionModel::ClearAndSelect | QItemSelectionModel::Rows);
    if (!rows.isEmpty()) m_view->scrollTo(rows.indexes().front());
    m_following = false;
  }

  void showOnly(const std::set<MotionId>& shown) {
    for (const MotionGroup& group : m_workspace.groups())
      for (int i = 0; i < static_cast<int>(group.motions.size()); ++i)
        m_workspace.setVisible({group.id, i}, shown.contains({group.id, i}));
  }

  void showMenu(const QPoint& at) {
    const MotionId id = idAt(m_view->indexAt(at));
    const MotionGroup* group = m_workspace.group(id.group);
    if (group == nullptr) return;
    const int groupId = id.group;
    QMenu menu;
    const auto selected = m_workspace.selection().motions;
    menu.addAction(tr("Show only the selected motions"), this,
                   [this, selected] { showOnly(selected); })
        ->setEnabled(!selected.empty());
    menu.addAction(tr("Show all of this group"), this,
                   [this, groupId] { m_workspace.setVisible(groupId, true); });
    menu.addAction(tr("Hide this group"), this,
                   [this, groupId] { m_workspace.setVisible(groupId, false); });
    if (group->recipe) {
      menu.addSeparator();
      menu.addAction(tr("Sample again"), this, [this, recipe = *group->recipe, groupId] {
        m_workspace.sample(recipe, groupId);
      });
      QAction* pin = menu.addAction(tr("Pin"), this, [this, groupId, pinned = group->pinned] {
        m_workspace.setPinned(groupId, !pinned);
      });
      pin->setCheckable(true);
      pin->setChecked(group->pinned);
      menu.addAction(tr("Remove"), this, [this, groupId] { m_workspace.removeGroup(groupId); });
    }
    menu.exec(m_view->viewport()->mapToGlobal(at));
  }

  Workspace& m_workspace;
  MotionTree m_model;
  QSortFilterProxyModel m_filter;
  QTreeView* m_view = nullptr;
  std::set<int> m_known;     ///< groups that were opened once
  bool m_following = false;  ///< the view is being set, not used
};

}  // namespace

QWidget* makeLibraryPanel(Workspace& workspace, QWidget* parent) {
  return new LibraryPanel(workspace, parent);
}

}  // namespace marey::gui
