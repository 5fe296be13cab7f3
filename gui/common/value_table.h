// A sortable table of numbers and names, copied as tab-separated text.
#pragma once

#include <QString>
#include <QTableWidget>
#include <optional>
#include <vector>

namespace marey::gui {

struct ValueCell {
  QString text;
  std::optional<double> value;  ///< sorted by it; text is sorted as text
  QString toolTip;
};

class ValueTable : public QTableWidget {
 public:
  explicit ValueTable(QWidget* parent = nullptr);
  /// Replaces everything; the order that the user has chosen stays.

  void setRows(const QStringList& header, const std::vector<std::vector<ValueCell>>& rows);
  /// Index of a shown row in the rows that were set.
  int keyOf(int row) const;
  /// Header and rows as shown.
  QString asText() const;

 protected:
  void keyPressEvent(QKeyEvent* event) override;
};

/// "12.3", or a dash where there is no value.
ValueCell numberCell(double value, int decimals);

}  // namespace marey::gui
