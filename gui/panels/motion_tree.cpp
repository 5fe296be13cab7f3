#include "panels/motion_tree.h"

#include <QColor>
#include <QFont>
#include <QIcon>
#include <QPainter>
#include <QPixmap>
#include <algorithm>

namespace marey::gui {
namespace {

/// Motions have the row of their group plus one as internal id; groups have 0.
constexpr quintptr kGroupLevel = 0;

QIcon swatch(const render::Colour& colour) {
  QPixmap picture(14, 14);
  picture.fill(Qt::transparent);
  QPainter painter(&picture);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QColor(128, 128, 128));
  painter.setBrush(QColor::fromRgbF(colour.r, colour.g, colour.b));
  painter.drawEllipse(1, 1, 11, 11);
  return picture;
}

QString recipeText(const MotionGroup& group) {
  if (!group.recipe)
    return MotionTree::tr("%n natural clip(s)", nullptr, static_cast<int>(group.motions.size()));
  const SampleRecipe& r = *group.recipe;
  return MotionTree::tr("%1 along “%2”\n%3 samples, seed %4, temperature %5\nmodel %6 (%7)")
      .arg(QString::fromStdString(r.system.name), QString::fromStdString(r.path.name))
      .arg(r.samples)
      .arg(r.seed)
      .arg(r.system.temperature)
      .arg(QString::fromStdString(r.system.model),
           QString::fromStdString(group.modelHash).left(12));
}

}  // namespace

MotionTree::MotionTree(Workspace& workspace, QObject* parent)
    : QAbstractItemModel(parent), m_workspace(workspace) {
  connect(&workspace, &Workspace::motionsChanged, this, &MotionTree::follow);
  connect(&workspace, &Workspace::visibilityChanged, this, &MotionTree::refreshColumn);
  follow();
}

void MotionTree::follow() {
  std::vector<Rows> now;
  for (const MotionGroup& group : m_workspace.groups())
    now.push_back({group.id, static_cast<int>(group.motions.size())});
  if (now == m_rows) return refreshColumn();
  // Motions that arrive keep the view where it is; anything else is a new tree.
  const bool same =
      now.size() == m_rows.size() &&
      std::equal(now.begin(), now.end(), m_rows.begin(), [](const Rows& a, const Rows& b) {
        return a.group == b.group && a.motions >= b.motions;
      });
  if (!same) {
    beginResetModel();
    m_rows = std::move(now);
    endResetModel();
    return;
  }
  for (size_t i = 0; i < now.size(); ++i) {
    if (now[i] == m_rows[i]) continue;
    beginInsertRows(index(static_cast<int>(i), 0), m_rows[i].motions, now[i].motions - 1);
    m_rows[i] = now[i];
    endInsertRows();
  }
  refreshColumn();
}

void MotionTree::refreshColumn() {
  if (m_rows.empty()) return;
  const int last = static_cast<int>(m_rows.size()) - 1;
  Q_EMIT dataChanged(index(0, 0), index(last, kColumns - 1));
  for (int row = 0; row <= last; ++row) {
    const int motions = m_rows[static_cast<size_t>(row)].motions;
    if (motions == 0) continue;
    const QModelIndex group = index(row, 0);
    Q_EMIT dataChanged(index(0, 0, group), index(motions - 1, kColumns - 1, group));
  }
}

const MotionGroup* MotionTree::groupAt(int row) const {
  if (row < 0 || row >= static_cast<int>(m_rows.size())) return nullptr;
  return m_workspace.group(m_rows[static_cast<size_t>(row)].group);
}

MotionId MotionTree::idOf(const QModelIndex& index) const {
  if (!index.isValid()) return {};
  const bool isGroup = index.internalId() == kGroupLevel;
  const int row = isGroup ? index.row() : static_cast<int>(index.internalId()) - 1;
  const MotionGroup* group = groupAt(row);
  if (group == nullptr) return {};
  return {group->id, isGroup ? -1 : index.row()};
}

QModelIndex MotionTree::indexOf(const MotionId& id) const {
  const auto found = std::find_if(m_rows.begin(), m_rows.end(),
                                  [&](const Rows& rows) { return rows.group == id.group; });
  if (found == m_rows.end()) return {};
  const QModelIndex group = index(static_cast<int>(found - m_rows.begin()), 0);
  return id.index < 0 ? group : index(id.index, 0, group);
}

QModelIndex MotionTree::index(int row, int column, const QModelIndex& parent) const {
  if (row < 0 || column < 0 || column >= kColumns || row >= rowCount(parent)) return {};
  return createIndex(row, column,
                     parent.isValid() ? static_cast<quintptr>(parent.row()) + 1 : kGroupLevel);
}

QModelIndex MotionTree::parent(const QModelIndex& child) const {
  if (!child.isValid() || child.internalId() == kGroupLevel) return {};
  return createIndex(static_cast<int>(child.internalId()) - 1, 0, kGroupLevel);
}

int MotionTree::rowCount(const QModelIndex& parent) const {
  if (!parent.isValid()) return static_cast<int>(m_rows.size());
  if (parent.internalId() != kGroupLevel || parent.column() != 0) return 0;
  return m_rows[static_cast<size_t>(parent.row())].motions;
}

int MotionTree::columnCount(const QModelIndex&) const {
  return kColumns;
}

QVariant MotionTree::data(const QModelIndex& index, int role) const {
  if (role == Qt::TextAlignmentRole && index.column() != Name)
    return static_cast<int>(Qt::AlignRight | Qt::AlignVCenter);
  const MotionId id = idOf(index);
  const MotionGroup* group = m_workspace.group(id.group);
  if (group == nullptr) return {};
  if (id.index < 0) return groupData(*group, index.column(), role);
  if (id.index >= static_cast<int>(group->motions.size())) return {};
  return motionData(*group, static_cast<size_t>(id.index), index.column(), role);
}

QVariant MotionTree::groupData(const MotionGroup& group, int column, int role) const {
  if (role == Qt::ToolTipRole) return recipeText(group);
  if (column == Name) {
    if (role == Qt::DisplayRole)
      return QStringLiteral("%1  (%2)%3")
          .arg(QString::fromStdString(group.name))
          .arg(group.motions.size())
          .arg(group.pinned      ? tr("  pinned")
               : !group.complete ? tr("  …")
                                 : QString());
    if (role == Qt::DecorationRole) return swatch(group.colour());
    if (role == Qt::FontRole) {
      QFont font;
      font.setBold(true);
      return font;
    }
    if (role == Qt::CheckStateRole) {
      const auto shown = std::count_if(group.motions.begin(), group.motions.end(),
                                       [](const Motion& m) { return m.visible; });
      if (shown == 0) return Qt::Unchecked;
      return shown == static_cast<std::ptrdiff_t>(group.motions.size()) ? Qt::Checked
                                                                        : Qt::PartiallyChecked;
    }
  }
  return {};
}

QVariant MotionTree::motionData(const MotionGroup& group, size_t index, int column,
                                int role) const {
  const Motion& motion = group.motions[index];
  if (role == Qt::CheckStateRole && column == Name)
    return motion.visible ? Qt::Checked : Qt::Unchecked;
  if (role == Qt::ToolTipRole) {
    const ClipSource& source = motion.clip->source;
    return tr("%1\n%2 frames at %3 per second, %4")
        .arg(QString::fromStdString(source.path.empty() ? motion.clip->name : source.path))
        .arg(motion.clip->frameCount())
        .arg(motion.clip->fps)
        .arg(QString::fromStdString(source.format));
  }
  if (role != Qt::DisplayRole) return {};
  switch (column) {
    case Name:
      return QString::fromStdString(motion.clip->name);
    case Frames:
      return motion.clip->frameCount();
    case Seconds:
      return QString::number(motion.clip->seconds(), 'f', 2);
    case Score:
      return motion.score ? QString::number(motion.score->meanNatsPerFrame(), 'f', 1) : QString();
    default:
      return {};
  }
}

bool MotionTree::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (role != Qt::CheckStateRole) return false;
  const MotionId id = idOf(index);
  const bool shown = value.toInt() == Qt::Checked;
  if (id.index < 0)
    m_workspace.setVisible(id.group, shown);
  else
    m_workspace.setVisible(id, shown);
  return true;
}

QVariant MotionTree::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation == Qt::Horizontal && role == Qt::ToolTipRole && section == Score)
    return tr("Mean log-likelihood of a sample under its own model, nats per frame");
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole) return {};
  switch (section) {
    case Name:
      return tr("Motion");
    case Frames:
      return tr("Frames");
    case Seconds:
      return tr("s");
    case Score:
      return tr("nats");
    default:
      return {};
  }
}

Qt::ItemFlags MotionTree::flags(const QModelIndex& index) const {
  if (!index.isValid()) return Qt::NoItemFlags;
  Qt::ItemFlags flags = Qt::ItemIsEnabled | Qt::ItemIsSelectable;
  if (index.column() == Name) flags |= Qt::ItemIsUserCheckable;
  return flags;
}

}  // namespace marey::gui
