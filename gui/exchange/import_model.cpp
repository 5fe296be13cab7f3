#include "gui/exchange/import_model.h"

#include <QFileInfo>
#include <algorithm>
#include <array>
#include <optional>

namespace marey::gui {
namespace {

/// The worst fault of a report; nothing where there is none.
std::optional<io::Severity> worstOf(const io::DoctorReport& report) {
  std::optional<io::Severity> out;
  for (const io::Fault& fault : report.faults)
    if (!out || static_cast<int>(fault.severity) > static_cast<int>(*out)) out = fault.severity;
  return out;
}

QString faultKinds(const io::DoctorReport& report) {
  QStringList kinds;
  for (const io::Fault& fault : report.faults)
    kinds += QString::fromStdString(fault.kind).replace(u'_', u' ');
  return kinds.isEmpty() ? ImportModel::tr("none") : kinds.join(QStringLiteral(", "));
}

QString faultEvidence(const io::DoctorReport& report) {
  QStringList lines;
  for (const io::Fault& fault : report.faults) {
    const QString frame =
        fault.frame ? ImportModel::tr(" (from frame %1)").arg(*fault.frame) : QString();
    lines += QStringLiteral("%1: %2%3")
                 .arg(QLatin1String(io::name(fault.severity)),
                      QString::fromStdString(fault.evidence), frame);
  }
  return lines.join(u'\n');
}

/// The order that most joints have; all of them in the tip.
QString eulerOrder(const io::DoctorReport& report) {
  const auto most =
      std::max_element(report.eulerOrders.begin(), report.eulerOrders.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == report.eulerOrders.end()) return ImportModel::tr("none");
  const QString mixed = report.eulerOrders.size() > 1 ? QStringLiteral(" …") : QString();
  return QString::fromStdString(most->first) + mixed;
}

QString eulerEvidence(const io::DoctorReport& report) {
  QStringList lines;
  for (const auto& [order, joints] : report.eulerOrders)
    lines += ImportModel::tr("%1 on %2 joints").arg(QString::fromStdString(order)).arg(joints);
  return lines.join(u'\n');
}

}  // namespace

ImportModel::ImportModel(QObject* parent) : QAbstractTableModel(parent) {}

void ImportModel::setFiles(std::vector<ImportFile> files) {
  beginResetModel();
  m_files = std::move(files);
  m_examined = 0;
  for (const ImportFile& file : m_files) m_examined += file.skipped ? 1 : 0;
  m_rows.clear();
  for (size_t i = 0; i < m_files.size(); ++i) m_rows.push_back({i, 0});
  endResetModel();
  Q_EMIT choiceChanged();
}

int ImportModel::firstRow(size_t file) const {
  const auto found = std::lower_bound(m_rows.begin(), m_rows.end(), file,
                                      [](const Row& row, size_t f) { return row.file < f; });
  return static_cast<int>(found - m_rows.begin());
}

int ImportModel::rowsOf(size_t file) const {
  return static_cast<int>(std::max<size_t>(1, m_files[file].reports.size()));
}

void ImportModel::tellRows(size_t file) {
  const int first = firstRow(file);
  Q_EMIT dataChanged(index(first, 0), index(first + rowsOf(file) - 1, Columns - 1));
}

void ImportModel::setReports(size_t file, std::vector<io::DoctorReport> reports) {
  if (file >= m_files.size()) return;
  const int first = firstRow(file), before = rowsOf(file);
  const int after = static_cast<int>(std::max<size_t>(1, reports.size()));
  if (m_files[file].reports.empty() && !reports.empty()) ++m_examined;
  const auto at = [this, first](int row) { return m_rows.begin() + first + row; };
  if (after > before) {
    beginInsertRows({}, first + before, first + after - 1);
    std::vector<Row> added;
    for (int clip = before; clip < after; ++clip)
      added.push_back({file, static_cast<size_t>(clip)});
    m_rows.insert(at(before), added.begin(), added.end());
    m_files[file].reports = std::move(reports);
    endInsertRows();
  } else if (after < before) {
    beginRemoveRows({}, first + after, first + before - 1);
    m_rows.erase(at(after), at(before));
    m_files[file].reports = std::move(reports);
    endRemoveRows();
  } else {
    m_files[file].reports = std::move(reports);
  }
  tellRows(file);
  Q_EMIT choiceChanged();
}

void ImportModel::setOptions(size_t file, const io::ReadOptions& options) {
  m_files[file].options = options;
  tellRows(file);
  Q_EMIT choiceChanged();
}

int ImportModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(m_rows.size());
}

int ImportModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(Columns);
}

const io::DoctorReport* ImportModel::reportAt(const Row& row) const {
  const auto& reports = m_files[row.file].reports;
  return row.clip < reports.size() ? &reports[row.clip] : nullptr;
}

QString ImportModel::textAt(const Row& row, int column) const {
  const ImportFile& file = m_files[row.file];
  const io::DoctorReport* report = reportAt(row);
  const auto text = [](const std::string& value) { return QString::fromStdString(value); };
  if (column == File) {
    const QString name = QFileInfo(text(file.path)).fileName();
    return report != nullptr && file.reports.size() > 1
               ? name + QStringLiteral(" · ") + text(report->clip)
               : name;
  }
  if (report == nullptr) return column == Faults ? tr("being examined…") : QString();
  switch (column) {
    case Format:
      return text(report->format);
    case Rate:
      return tr("%1 fps").arg(report->fps, 0, 'g', 5);
    case Frames:
      return QString::number(report->frames);
    case Joints:
      return QString::number(report->joints);
    case Up:
      return text(report->up.value);
    case Unit:
      return text(report->unit.value);
    case Euler:
      return eulerOrder(*report);
    case Body:
      return text(report->skeleton);
    case Sides:
      return text(report->sides.value);
    case Floor:
      return report->floorM ? QString::number(100.0 * *report->floorM, 'f', 1) : tr("unknown");
    default:
      return faultKinds(*report);
  }
}

QString ImportModel::tipAt(const Row& row, int column) const {
  const io::DoctorReport* report = reportAt(row);
  if (column == File) return QString::fromStdString(m_files[row.file].path);
  if (report == nullptr) return {};
  switch (column) {
    case Frames:
      return tr("%1 s").arg(report->seconds, 0, 'f', 1);
    case Up:
      return QString::fromStdString(report->up.evidence);
    case Unit:
      return QString::fromStdString(report->unit.evidence);
    case Euler:
      return eulerEvidence(*report);
    case Sides:
      return QString::fromStdString(report->sides.evidence);
    case Faults:
      return faultEvidence(*report);
    default:
      return {};
  }
}

QVariant ImportModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const Row& row = m_rows[static_cast<size_t>(index.row())];
  if (role == Qt::DisplayRole) return textAt(row, index.column());
  if (role == Qt::ToolTipRole) return tipAt(row, index.column());
  if (role == Qt::CheckStateRole && index.column() == File)
    return m_files[row.file].taken() ? Qt::Checked : Qt::Unchecked;
  const io::DoctorReport* report = reportAt(row);
  if (role != Qt::ForegroundRole || index.column() != Faults || report == nullptr) return {};
  const auto worst = worstOf(*report);
  if (worst == io::Severity::Error) return m_inks.error;
  return worst == io::Severity::Warning ? QVariant(m_inks.warning) : QVariant();
}

bool ImportModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (role != Qt::CheckStateRole || index.column() != File) return false;
  const size_t file = fileAt(index.row());
  m_files[file].wanted = value.toInt() == Qt::Checked;
  tellRows(file);
  Q_EMIT choiceChanged();
  return true;
}

QVariant ImportModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole) return {};
  const std::array<QString, Columns> names = {
      tr("File"), tr("Format"), tr("Rate"),     tr("Frames"), tr("Joints"),    tr("Up"),
      tr("Unit"), tr("Euler"),  tr("Skeleton"), tr("Sides"),  tr("Floor, cm"), tr("Faults")};
  return names[static_cast<size_t>(section)];
}

Qt::ItemFlags ImportModel::flags(const QModelIndex& index) const {
  Qt::ItemFlags out = Qt::ItemIsEnabled | Qt::ItemIsSelectable | Qt::ItemNeverHasChildren;
  if (index.isValid() && index.column() == File && m_files[fileAt(index.row())].readable())
    out |= Qt::ItemIsUserCheckable;
  return out;
}

}  // namespace marey::gui
