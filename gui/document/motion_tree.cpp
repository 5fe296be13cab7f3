#include "gui/document/motion_tree.h"

#include <QApplication>
#include <QFileInfo>
#include <QFont>
#include <QIcon>
#include <QPainter>
#include <QPixmap>
#include <algorithm>
#include <filesystem>
#include <set>

#include "gui/common/paint_style.h"

#include "model/pose_units.h"

namespace marey::gui {
namespace {

/// What lies in a branch has the branch's row plus one as internal id; branches have 0.
constexpr quintptr kBranchLevel = 0;

QIcon swatch(const render::Colour& colour) {
  QPixmap picture(14, 14);
  picture.fill(Qt::transparent);
  QPainter painter(&picture);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QColor(128, 128, 128));
  painter.setBrush(shownColour(colour, isDark(QApplication::palette())));
  painter.drawEllipse(1, 1, 11, 11);
  return picture;
}

QString recipeText(const MotionGroup& group) {
  const int motions = static_cast<int>(group.motions.size());
  if (group.natural()) return MotionTree::tr("%n natural clip(s)", nullptr, motions);
  if (group.heldOut())
    return MotionTree::tr(
               "%1 along the control of every natural clip\n%2 motions, seed %3, "
               "temperature %4")
        .arg(QString::fromStdString(group.system))
        .arg(motions)
        .arg(group.recipe->seed)
        .arg(group.recipe->system.temperature);
  if (!group.recipe) return MotionTree::tr("%n steered motion(s)", nullptr, motions);
  const SampleRecipe& r = *group.recipe;
  return MotionTree::tr("%1 along “%2”\n%3 samples, seed %4, temperature %5\nmodel %6 (%7)")
      .arg(QString::fromStdString(r.system.name), QString::fromStdString(r.path.name))
      .arg(r.samples)
      .arg(r.seed)
      .arg(r.system.temperature)
      .arg(QString::fromStdString(r.system.model),
           QString::fromStdString(group.modelHash).left(12));
}

/// Sources that stand in one branch have one place: files their folder, all else itself.
std::string placeOf(const std::string& source) {
  const bool other = source.starts_with("@") || source.starts_with("walker:");
  const std::filesystem::path path = source;
  if (other || path.extension().empty()) return source;
  return path.parent_path().empty() ? "." : path.parent_path().string();
}

}  // namespace

MotionTree::MotionTree(Workspace& workspace, QObject* parent)
    : QAbstractItemModel(parent), m_workspace(workspace) {
  connect(&workspace.motions(), &MotionGroups::changed, this, &MotionTree::follow);
  connect(&workspace.document(), &Document::changed, this, &MotionTree::follow);
  connect(&workspace.motions(), &MotionGroups::visibilityChanged, this, &MotionTree::refreshColumn);
  follow();
}

std::vector<MotionTree::Branch> MotionTree::branchesNow() const {
  std::vector<Branch> out;
  for (const MotionGroup& group : m_workspace.motions().groups()) {
    const int motions = static_cast<int>(group.motions.size());
    const bool severalSources =
        motions > 0 && group.motions.front().source != group.motions.back().source;
    if (!severalSources) {
      out.push_back({group.id, {}, 0, motions});
      continue;
    }
    // Clips of one source stand together, and so do files of one folder.
    for (int i = 0; i < motions; ++i) {
      const std::string place = placeOf(group.motions[static_cast<size_t>(i)].source);
      if (i == 0 || place != out.back().source) out.push_back({group.id, place, i, 0});
      ++out.back().rows;
    }
  }
  const int systems = static_cast<int>(m_workspace.document().experiment().systems.size());
  if (systems > 0) out.push_back({kModels, {}, 0, systems});
  return out;
}

void MotionTree::follow() {
  std::vector<Branch> now = branchesNow();
  if (now == m_branches) return refreshColumn();
  // Motions that arrive keep the view where it is; anything else is a new tree.
  const bool same =
      now.size() == m_branches.size() &&
      std::equal(now.begin(), now.end(), m_branches.begin(), [](const Branch& a, const Branch& b) {
        return a.group == b.group && a.source == b.source && a.first == b.first && a.rows >= b.rows;
      });
  if (!same) {
    beginResetModel();
    m_branches = std::move(now);
    endResetModel();
    return;
  }
  for (size_t i = 0; i < now.size(); ++i) {
    if (now[i] == m_branches[i]) continue;
    beginInsertRows(index(static_cast<int>(i), 0), m_branches[i].rows, now[i].rows - 1);
    m_branches[i] = now[i];
    endInsertRows();
  }
  refreshColumn();
}

void MotionTree::refreshColumn() {
  if (m_branches.empty()) return;
  const int last = static_cast<int>(m_branches.size()) - 1;
  Q_EMIT dataChanged(index(0, 0), index(last, kColumns - 1));
  for (int row = 0; row <= last; ++row) {
    const int rows = m_branches[static_cast<size_t>(row)].rows;
    if (rows == 0) continue;
    const QModelIndex branch = index(row, 0);
    Q_EMIT dataChanged(index(0, 0, branch), index(rows - 1, kColumns - 1, branch));
  }
}

const MotionTree::Branch* MotionTree::branchOf(const QModelIndex& index) const {
  if (!index.isValid()) return nullptr;
  const bool isBranch = index.internalId() == kBranchLevel;
  const auto row = isBranch ? static_cast<size_t>(index.row()) : index.internalId() - 1;
  return row < m_branches.size() ? &m_branches[row] : nullptr;
}

MotionId MotionTree::idOf(const QModelIndex& index) const {
  const Branch* branch = branchOf(index);
  if (branch == nullptr || branch->group == kModels) return {};
  return {branch->group, index.internalId() == kBranchLevel ? -1 : branch->first + index.row()};
}

int MotionTree::systemOf(const QModelIndex& index) const {
  const Branch* branch = branchOf(index);
  const bool model =
      branch != nullptr && branch->group == kModels && index.internalId() != kBranchLevel;
  return model ? index.row() : -1;
}

std::string MotionTree::sourceOf(const QModelIndex& index) const {
  const std::vector<std::string> sources = sourcesOf(index);
  return sources.empty() ? std::string() : sources.front();
}

std::vector<std::string> MotionTree::sourcesOf(const QModelIndex& index) const {
  const Branch* branch = branchOf(index);
  const MotionGroup* group = branch ? m_workspace.motions().group(branch->group) : nullptr;
  std::vector<std::string> out;
  if (group == nullptr || !group->natural()) return out;
  const bool whole = index.internalId() == kBranchLevel;
  const int first = whole ? branch->first : branch->first + index.row();
  const int last = std::min(whole ? branch->first + branch->rows : first + 1,
                            static_cast<int>(group->motions.size()));
  for (int i = first; i < last; ++i) {
    const std::string& source = group->motions[static_cast<size_t>(i)].source;
    if (out.empty() || out.back() != source) out.push_back(source);
  }
  return out;
}

QModelIndex MotionTree::indexOf(const MotionId& id) const {
  for (size_t row = 0; row < m_branches.size(); ++row) {
    const Branch& branch = m_branches[row];
    if (branch.group == id.group && id.index >= branch.first &&
        id.index < branch.first + branch.rows)
      return index(id.index - branch.first, 0, index(static_cast<int>(row), 0));
  }
  return {};
}

std::vector<MotionId> MotionTree::motionsOf(const Branch& branch) const {
  std::vector<MotionId> out;
  for (int i = branch.first; i < branch.first + branch.rows; ++i) out.push_back({branch.group, i});
  return out;
}

QModelIndex MotionTree::index(int row, int column, const QModelIndex& parent) const {
  if (row < 0 || column < 0 || column >= kColumns || row >= rowCount(parent)) return {};
  return createIndex(row, column,
                     parent.isValid() ? static_cast<quintptr>(parent.row()) + 1 : kBranchLevel);
}

QModelIndex MotionTree::parent(const QModelIndex& child) const {
  if (!child.isValid() || child.internalId() == kBranchLevel) return {};
  return createIndex(static_cast<int>(child.internalId()) - 1, 0, kBranchLevel);
}

int MotionTree::rowCount(const QModelIndex& parent) const {
  if (!parent.isValid()) return static_cast<int>(m_branches.size());
  if (parent.internalId() != kBranchLevel || parent.column() != 0) return 0;
  return m_branches[static_cast<size_t>(parent.row())].rows;
}

int MotionTree::columnCount(const QModelIndex&) const {
  return kColumns;
}

QVariant MotionTree::data(const QModelIndex& index, int role) const {
  if (role == Qt::TextAlignmentRole && index.column() != Name)
    return static_cast<int>(Qt::AlignRight | Qt::AlignVCenter);
  const Branch* branch = branchOf(index);
  if (branch == nullptr) return {};
  if (index.internalId() == kBranchLevel) return branchData(*branch, index.column(), role);
  const int system = systemOf(index);
  if (system >= 0) return modelData(static_cast<size_t>(system), index.column(), role);
  const MotionId id = idOf(index);
  const MotionGroup* group = m_workspace.motions().group(id.group);
  if (group == nullptr || id.index >= static_cast<int>(group->motions.size())) return {};
  return motionData(*group, static_cast<size_t>(id.index), index.column(), role);
}

QVariant MotionTree::branchData(const Branch& branch, int column, int role) const {
  const MotionGroup* group = m_workspace.motions().group(branch.group);
  if (column == Name && role == Qt::FontRole) {
    QFont font;
    font.setBold(true);
    return font;
  }
  if (branch.group == kModels)
    return column == Name && role == Qt::DisplayRole ? tr("Models  (%1)").arg(branch.rows)
                                                     : QVariant();
  if (group == nullptr) return {};
  const QString source = QString::fromStdString(branch.source);
  const std::vector<std::string> unread = remarksOn(branch, *group);
  if (role == Qt::ToolTipRole) {
    QString tip = source.isEmpty() ? recipeText(*group) : source;
    for (const std::string& remark : unread) tip += u'\n' + QString::fromStdString(remark);
    return tip;
  }
  if (column == Use && role == Qt::CheckStateRole) return state(branch, *group, &Motion::used);
  if (column != Name) return {};
  if (role == Qt::DisplayRole) {
    const QString name = source.isEmpty()
                             ? QString::fromStdString(group->name)
                             : QStringLiteral("%1 – %2").arg(QString::fromStdString(group->name),
                                                             QFileInfo(source).fileName());
    const QString state = group->pinned ? tr("  pinned") : !group->complete ? tr("  …") : QString();
    const QString remarks = unread.empty() ? QString() : tr("  ⚠ see tip");
    return QStringLiteral("%1  (%2)%3%4").arg(name).arg(branch.rows).arg(state, remarks);
  }
  if (role == Qt::DecorationRole) return swatch(render::colourOf(group->colourIndex));
  if (role == Qt::CheckStateRole) return state(branch, *group, &Motion::visible);
  return {};
}

std::vector<std::string> MotionTree::remarksOn(const Branch& branch,
                                               const MotionGroup& group) const {
  std::vector<std::string> out;
  if (!group.natural()) return out;
  std::set<std::string> sources;
  for (const MotionId& id : motionsOf(branch))
    if (const Motion* motion = m_workspace.motions().motion(id)) sources.insert(motion->source);
  for (const auto& [source, inputs] : m_workspace.natural().inputs()) {
    if (!sources.contains(source) || inputs.missingText().empty()) continue;
    for (std::string& remark : inputs.remarks()) out.push_back(std::move(remark));
  }
  return out;
}

QVariant MotionTree::state(const Branch& branch, const MotionGroup& group,
                           bool Motion::*flag) const {
  const int last = std::min(branch.first + branch.rows, static_cast<int>(group.motions.size()));
  const auto shown = std::count_if(group.motions.begin() + branch.first,
                                   group.motions.begin() + std::max(branch.first, last),
                                   [flag](const Motion& m) { return m.*flag; });
  if (shown == 0) return Qt::Unchecked;
  return shown == branch.rows ? Qt::Checked : Qt::PartiallyChecked;
}

QVariant MotionTree::modelData(size_t index, int column, int role) const {
  const auto& systems = m_workspace.document().experiment().systems;
  if (column != Name || index >= systems.size()) return {};
  if (role == Qt::DisplayRole) return QString::fromStdString(systems[index].name);
  if (role == Qt::DecorationRole) return swatch(render::colourOf(static_cast<int>(index)));
  if (role == Qt::ToolTipRole)
    return tr("%1\nDouble-click: card and parameters")
        .arg(QString::fromStdString(m_workspace.document().modelFile(systems[index])));
  return {};
}

QVariant MotionTree::motionData(const MotionGroup& group, size_t index, int column,
                                int role) const {
  const Motion& motion = group.motions[index];
  if (role == Qt::CheckStateRole && column == Name)
    return motion.visible ? Qt::Checked : Qt::Unchecked;
  if (role == Qt::CheckStateRole && column == Use) return motion.used ? Qt::Checked : Qt::Unchecked;
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
      if (!motion.score) return {};
      if (motion.score->tooShort()) return tr("too short");
      return motion.score->loglikNats.empty() ? tr("none") : scoreText(*motion.score);
    default:
      return {};
  }
}

std::optional<std::string> MotionTree::scoreUnit() const {
  std::optional<std::string> out;
  for (const MotionGroup& group : m_workspace.motions().groups())
    for (const Motion& motion : group.motions) {
      if (!motion.score || motion.score->unit.empty()) continue;
      if (out && *out != motion.score->unit) return std::nullopt;
      out = motion.score->unit;
    }
  return out;
}

QString MotionTree::scoreText(const ClipScore& score) const {
  const QString number = QString::number(score.meanNatsPerFrame(), 'f', 1);
  return scoreUnit() ? number
                     : number + QStringLiteral(" ") + QString::fromStdString(natsUnit(score.unit));
}

bool MotionTree::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (role != Qt::CheckStateRole) return false;
  const Branch* branch = branchOf(index);
  if (branch == nullptr || branch->group == kModels) return false;
  const bool on = value.toInt() == Qt::Checked;
  const std::vector<MotionId> motions =
      index.internalId() == kBranchLevel ? motionsOf(*branch) : std::vector<MotionId>{idOf(index)};
  if (index.column() == Use)
    m_workspace.setUsed(motions, on);
  else
    m_workspace.motions().setVisible(motions, on);
  return true;
}

QVariant MotionTree::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation == Qt::Horizontal && role == Qt::ToolTipRole && section == Score)
    return tr("Mean log-likelihood of a sample under its own model, nats per frame");
  if (orientation == Qt::Horizontal && role == Qt::ToolTipRole && section == Use)
    return tr("Counted by plots and statistics, whether it is shown or hidden");
  if (orientation == Qt::Horizontal && role == Qt::ToolTipRole && section == Name)
    return tr("The box shows or hides a motion and changes no number");
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole) return {};
  switch (section) {
    case Name:
      return tr("Motion");
    case Frames:
      return tr("Frames");
    case Seconds:
      return tr("s");
    case Score:
      return QString::fromStdString(natsUnit(scoreUnit().value_or("nats")));
    case Use:
      return tr("use");
    default:
      return {};
  }
}

Qt::ItemFlags MotionTree::flags(const QModelIndex& index) const {
  if (!index.isValid()) return Qt::NoItemFlags;
  Qt::ItemFlags flags = Qt::ItemIsEnabled | Qt::ItemIsSelectable;
  const Branch* branch = branchOf(index);
  if ((index.column() == Name || index.column() == Use) && branch && branch->group != kModels)
    flags |= Qt::ItemIsUserCheckable;
  return flags;
}

}  // namespace marey::gui
