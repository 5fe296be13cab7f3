// The table of an import: one row per clip of every file, with what the doctor found.
#pragma once

#include <QAbstractTableModel>
#include <vector>

#include "gui/common/paint_style.h"

#include "experiment/import_files.h"

namespace marey::gui {

class ImportModel : public QAbstractTableModel {
  Q_OBJECT
 public:
  enum Column {
    File,
    Format,
    Rate,
    Frames,
    Joints,
    Up,
    Unit,
    Euler,
    Body,
    Sides,
    Floor,
    Faults,
    Columns
  };

  explicit ImportModel(QObject* parent);

  void setFiles(std::vector<ImportFile> files);
  const std::vector<ImportFile>& files() const { return m_files; }
  /// Findings of one file: its rows change, others keep their places or move down.
  void setReports(size_t file, std::vector<io::DoctorReport> reports);
  /// Whether a file is taken is not touched.
  void setOptions(size_t file, const io::ReadOptions& options);
  /// Files that have been examined.
  size_t examined() const { return m_examined; }
  size_t fileAt(int row) const { return m_rows[static_cast<size_t>(row)].file; }
  size_t clipAt(int row) const { return m_rows[static_cast<size_t>(row)].clip; }
  void setInks(const Inks& inks) { m_inks = inks; }

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role) override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;

 Q_SIGNALS:
  /// What would be imported.
  void choiceChanged();

 private:
  struct Row {
    size_t file, clip;
  };
  int firstRow(size_t file) const;
  int rowsOf(size_t file) const;
  void tellRows(size_t file);
  const io::DoctorReport* reportAt(const Row& row) const;
  QString textAt(const Row& row, int column) const;
  QString tipAt(const Row& row, int column) const;

  std::vector<ImportFile> m_files;
  std::vector<Row> m_rows;  ///< by file, then by clip
  size_t m_examined = 0;
  Inks m_inks;
};

}  // namespace marey::gui
