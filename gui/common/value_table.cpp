#include "gui/common/value_table.h"

#include <QApplication>
#include <QClipboard>
#include <QHeaderView>
#include <QKeyEvent>
#include <cmath>

namespace marey::gui {
namespace {
constexpr int kValueRole = Qt::UserRole, kKeyRole = Qt::UserRole + 1;

/// Sorts by number where both have one; items without a number come last.
class Item : public QTableWidgetItem {
 public:
  using QTableWidgetItem::QTableWidgetItem;
  bool operator<(const QTableWidgetItem& other) const override {
    const QVariant a = data(kValueRole), b = other.data(kValueRole);
    if (a.isValid() && b.isValid()) return a.toDouble() < b.toDouble();
    if (a.isValid() != b.isValid()) return a.isValid();
    return QTableWidgetItem::operator<(other);
  }
};
}  // namespace

ValueCell numberCell(double value, int decimals) {
  if (!std::isfinite(value)) return {QStringLiteral("–"), std::nullopt, {}};
  return {QString::number(value, 'f', decimals), value, {}};
}

ValueTable::ValueTable(QWidget* parent) : QTableWidget(parent) {
  setEditTriggers(QAbstractItemView::NoEditTriggers);
  setSelectionBehavior(QAbstractItemView::SelectRows);
  setAlternatingRowColors(true);
  setSortingEnabled(true);
  setWordWrap(false);
  horizontalHeader()->setSortIndicator(-1, Qt::AscendingOrder);
  verticalHeader()->hide();
  verticalHeader()->setDefaultSectionSize(fontMetrics().height() + 8);
}

void ValueTable::setRows(const QStringList& header,
                         const std::vector<std::vector<ValueCell>>& rows) {
  setSortingEnabled(false);
  clearContents();
  setColumnCount(header.size());
  setHorizontalHeaderLabels(header);
  setRowCount(static_cast<int>(rows.size()));
  for (size_t r = 0; r < rows.size(); ++r)
    for (size_t c = 0; c < rows[r].size(); ++c) {
      const ValueCell& cell = rows[r][c];
      auto* item = new Item(cell.text);
      if (cell.value) item->setData(kValueRole, *cell.value);
      const auto side = c > 0 && cell.value ? Qt::AlignRight : Qt::AlignLeft;
      item->setTextAlignment(static_cast<int>(side | Qt::AlignVCenter));
      item->setData(kKeyRole, static_cast<int>(r));
      item->setToolTip(cell.toolTip);
      setItem(static_cast<int>(r), static_cast<int>(c), item);
    }
  setSortingEnabled(true);
  resizeColumnsToContents();
}

int ValueTable::keyOf(int row) const {
  const QTableWidgetItem* first = item(row, 0);
  return first == nullptr ? -1 : first->data(kKeyRole).toInt();
}

QString ValueTable::asText() const {
  QString out;
  for (int c = 0; c < columnCount(); ++c)
    out += (c > 0 ? "\t" : "") + horizontalHeaderItem(c)->text().replace('\n', ' ');
  for (int r = 0; r < rowCount(); ++r) {
    out += "\n";
    for (int c = 0; c < columnCount(); ++c)
      out += (c > 0 ? "\t" : "") + (item(r, c) == nullptr ? QString() : item(r, c)->text());
  }
  return out + "\n";
}

void ValueTable::keyPressEvent(QKeyEvent* event) {
  if (event->matches(QKeySequence::Copy))
    QApplication::clipboard()->setText(asText());
  else
    QTableWidget::keyPressEvent(event);
}

}  // namespace marey::gui
