#include "gui/document/library_panel.h"

#include <QHBoxLayout>
#include <QHeaderView>
#include <QLineEdit>
#include <QMenu>
#include <QSortFilterProxyModel>
#include <QToolButton>
#include <QTreeView>
#include <QVBoxLayout>
#include <algorithm>
#include <map>

#include "gui/document/model_card.h"
#include "gui/document/motion_tree.h"

#include "experiment/edits.h"

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
      // Rows that are filtered away leave the view's selection, not the workspace's.
      m_following = true;
      m_filter.setFilterFixedString(text);
      m_following = false;
      if (!text.isEmpty()) m_view->expandAll();
      showSelection();
    });
    connect(m_view->selectionModel(), &QItemSelectionModel::selectionChanged, this,
            &LibraryPanel::takeSelection);
    connect(&workspace.view(), &View::selectionChanged, this, &LibraryPanel::showSelection);
    connect(&m_model, &QAbstractItemModel::modelReset, this, [this] {
      expandSmall();
      showSelection();
    });
    connect(&m_model, &QAbstractItemModel::rowsInserted, this, [this] { expandSmall(); });
    connect(m_view, &QWidget::customContextMenuRequested, this, &LibraryPanel::showMenu);
    connect(m_view, &QTreeView::doubleClicked, this, [this](const QModelIndex& index) {
      const int system = m_model.systemOf(m_filter.mapToSource(index));
      if (system >= 0) showModelCard(m_workspace, static_cast<size_t>(system), this);
    });
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
    // As wide as their values, and as their names in whatever font.
    const std::map<int, int> least = {
        {MotionTree::Seconds, 46}, {MotionTree::Score, 50}, {MotionTree::Use, 36}};
    for (const auto& [column, width] : least)
      m_view->header()->resizeSection(column, std::max(width, nameWidth(column)));
    m_view->setIndentation(14);
  }

  int nameWidth(int column) const {
    constexpr int kAround = 14;
    const QString name = m_model.headerData(column, Qt::Horizontal, Qt::DisplayRole).toString();
    return m_view->header()->fontMetrics().horizontalAdvance(name) + kAround;
  }

  MotionId idAt(const QModelIndex& index) const {
    return m_model.idOf(m_filter.mapToSource(index));
  }

  /// Long lists stay closed until asked for.
  void expandSmall() {
    constexpr int kFew = 40;
    for (int row = 0; row < m_filter.rowCount(); ++row) {
      const QModelIndex branch = m_filter.index(row, 0);
      const int rows = m_filter.rowCount(branch);
      const auto known =
          std::pair(idAt(branch).group, m_model.sourceOf(m_filter.mapToSource(branch)));
      if (rows > 0 && rows <= kFew && m_known.insert(known).second) m_view->expand(branch);
    }
  }

  void takeSelection() {
    if (m_following) return;
    Selection next{.joint = m_workspace.view().selection().joint};
    for (const QModelIndex& index : m_view->selectionModel()->selectedRows()) {
      const MotionId id = idAt(index);
      if (id.index >= 0) next.motions.insert(id);
    }
    m_workspace.view().select(std::move(next));
  }

  void showSelection() {
    m_following = true;
    QItemSelection rows;
    for (const MotionId& id : m_workspace.view().selection().motions) {
      const QModelIndex index = m_filter.mapFromSource(m_model.indexOf(id));
      if (index.isValid()) rows.select(index, index);
    }
    m_view->selectionModel()->select(
        rows, QItemSelectionModel::ClearAndSelect | QItemSelectionModel::Rows);
    if (!rows.isEmpty()) m_view->scrollTo(rows.indexes().front());
    m_following = false;
  }

  void showMenu(const QPoint& at) {
    const QModelIndex index = m_filter.mapToSource(m_view->indexAt(at));
    QMenu menu;
    if (m_model.systemOf(index) >= 0)
      fillModelMenu(menu, static_cast<size_t>(m_model.systemOf(index)));
    else if (const MotionGroup* group = m_workspace.motions().group(m_model.idOf(index).group))
      fillGroupMenu(menu, *group, m_model.sourcesOf(index));
    if (!menu.isEmpty()) menu.exec(m_view->viewport()->mapToGlobal(at));
  }

  void fillModelMenu(QMenu& menu, size_t system) {
    menu.addAction(tr("Card and parameters…"), this,
                   [this, system] { showModelCard(m_workspace, system, this); });
    menu.addAction(tr("Remove model from the document"), this, [this, system] {
      m_workspace.document().edit(tr("Remove model"),
                                  [=](Experiment& e) { removeSystem(e, system); });
    });
  }

  /// What plots and statistics count; showing and hiding are something else.
  void addUse(QMenu& menu, const std::vector<MotionId>& motions, const QString& use,
              const QString& leaveOut) {
    for (const bool used : {true, false})
      menu.addAction(used ? use : leaveOut, this,
                     [this, motions, used] { m_workspace.setUsed(motions, used); })
          ->setEnabled(!motions.empty());
  }

  void fillGroupMenu(QMenu& menu, const MotionGroup& group,
                     const std::vector<std::string>& sources) {
    const int id = group.id;
    const auto selected = m_workspace.view().selection().motions;
    menu.addAction(tr("Show only the selected motions"), this,
                   [this, selected] { m_workspace.motions().showOnly(selected); })
        ->setEnabled(!selected.empty());
    menu.addAction(tr("Show all of this group"), this,
                   [this, id] { m_workspace.motions().setVisible(id, true); });
    menu.addAction(tr("Hide this group"), this,
                   [this, id] { m_workspace.motions().setVisible(id, false); });
    menu.addSeparator();
    addUse(menu, {selected.begin(), selected.end()}, tr("Use the selected motions"),
           tr("Leave the selected motions out"));
    std::vector<MotionId> all;
    for (size_t i = 0; i < group.motions.size(); ++i) all.push_back({id, static_cast<int>(i)});
    addUse(menu, all, tr("Use all of this group"), tr("Leave this group out"));
    menu.addSeparator();
    if (group.natural()) {
      if (sources.empty()) return;
      const QString text =
          sources.size() == 1 ? tr("Remove source “%1” from the document")
                                    .arg(QString::fromStdString(sources.front()))
                              : tr("Remove these %1 sources from the document").arg(sources.size());
      menu.addAction(text, this, [this, sources] {
        m_workspace.document().edit(tr("Remove source"), [&](Experiment& e) {
          for (const std::string& source : sources) removeNatural(e, source);
        });
      });
      return;
    }
    if (group.recipe) {
      menu.addAction(tr("Sample again"), this, [this, recipe = *group.recipe, id] {
        m_workspace.sampling().sample(recipe, id);
      });
      QAction* pin = menu.addAction(tr("Pin"), this, [this, id, pinned = group.pinned] {
        m_workspace.motions().setPinned(id, !pinned);
      });
      pin->setCheckable(true);
      pin->setChecked(group.pinned);
    }
    menu.addAction(tr("Remove these motions"), this,
                   [this, id] { m_workspace.motions().setAside(id); });
  }

  Workspace& m_workspace;
  MotionTree m_model;
  QSortFilterProxyModel m_filter;
  QTreeView* m_view = nullptr;
  std::set<std::pair<int, std::string>> m_known;  ///< branches that were opened once
  bool m_following = false;                       ///< the view is being set, not used
};

}  // namespace

QWidget* makeLibraryPanel(Workspace& workspace, QWidget* parent) {
  return new LibraryPanel(workspace, parent);
}

}  // namespace marey::gui
