#include "panels/import_dialog.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QGroupBox>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPointer>
#include <QPushButton>
#include <QSplitter>
#include <QTableWidget>
#include <QToolButton>
#include <QVBoxLayout>

#include "panels/import_files.h"
#include "panels/import_preview.h"
#include "panels/paint_style.h"

#include "base/error.h"
#include "experiment/edits.h"
#include "io/units.h"

namespace marey::gui {
namespace {

enum Column { File, Format, Rate, Frames, Joints, Up, Unit, Body, Sides, Floor, Faults, Columns };

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
  return kinds.isEmpty() ? QObject::tr("none") : kinds.join(QStringLiteral(", "));
}

QString faultEvidence(const io::DoctorReport& report) {
  QStringList lines;
  for (const io::Fault& fault : report.faults) {
    const QString frame =
        fault.frame ? QObject::tr(" (from frame %1)").arg(*fault.frame) : QString();
    lines += QStringLiteral("%1: %2%3")
                 .arg(QLatin1String(io::name(fault.severity)),
                      QString::fromStdString(fault.evidence), frame);
  }
  return lines.join(u'\n');
}

class ImportDialog : public QDialog {
 public:
  ImportDialog(Workspace& workspace, std::vector<ImportFile> files, QWidget* parent)
      : QDialog(parent), m_workspace(workspace), m_files(std::move(files)) {
    setObjectName(QStringLiteral("importDialog"));
    setWindowTitle(tr("Import motion"));
    setAttribute(Qt::WA_DeleteOnClose);
    auto* layout = new QVBoxLayout(this);
    auto* split = new QSplitter(Qt::Vertical, this);
    split->addWidget(buildTable());
    auto* below = new QWidget(split);
    auto* row = new QHBoxLayout(below);
    row->setContentsMargins(0, 0, 0, 0);
    m_preview = new ImportPreview(workspace.jobs(), below);
    row->addWidget(m_preview, 3);
    row->addWidget(buildOverrides(), 2);
    split->addWidget(below);
    layout->addWidget(split, 1);
    layout->addLayout(buildFolder());
    layout->addLayout(buildButtons());
    resize(1080, 700);
    fillTable();
    for (size_t i = 0; i < m_files.size(); ++i) examineFile(i);
    if (!m_files.empty()) m_table->selectRow(0);
  }

 private:
  QWidget* buildTable() {
    m_table = new QTableWidget(0, Columns, this);
    m_table->setObjectName(QStringLiteral("importTable"));
    m_table->setHorizontalHeaderLabels({tr("File"), tr("Format"), tr("Rate"), tr("Frames"),
                                        tr("Joints"), tr("Up"), tr("Unit"), tr("Skeleton"),
                                        tr("Sides"), tr("Floor, cm"), tr("Faults")});
    m_table->verticalHeader()->hide();
    m_table->setEditTriggers(QAbstractItemView::NoEditTriggers);
    m_table->setSelectionBehavior(QAbstractItemView::SelectRows);
    m_table->setSelectionMode(QAbstractItemView::SingleSelection);
    m_table->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
    m_table->horizontalHeader()->setStretchLastSection(true);
    connect(m_table, &QTableWidget::itemSelectionChanged, this, &ImportDialog::choose);
    connect(m_table, &QTableWidget::itemChanged, this, [this](const QTableWidgetItem* item) {
      if (m_refreshing || item->column() != File) return;
      fileAt(item->row()).wanted = item->checkState() == Qt::Checked;
      // Later: filling replaces the item that is telling of its change.
      QMetaObject::invokeMethod(
          this, [this] { fillTable(); }, Qt::QueuedConnection);
    });
    return m_table;
  }

  QWidget* buildOverrides() {
    m_overrides = new QGroupBox(tr("Read this file as"), this);
    auto* form = new QFormLayout(m_overrides);
    m_unit = new QComboBox(m_overrides);
    m_unit->setObjectName(QStringLiteral("importUnit"));
    m_unit->addItem(tr("as found"), QString());
    for (const io::LengthUnit& unit : io::lengthUnits()) {
      const QString name = QString::fromStdString(unit.name);
      m_unit->addItem(name, name);
    }
    m_up = new QComboBox(m_overrides);
    m_up->setObjectName(QStringLiteral("importUp"));
    m_up->addItem(tr("as found"), QString());
    m_up->addItem(QStringLiteral("y"), QStringLiteral("y"));
    m_up->addItem(QStringLiteral("z"), QStringLiteral("z"));
    m_fps = new QDoubleSpinBox(m_overrides);
    m_fps->setObjectName(QStringLiteral("importFps"));
    m_fps->setRange(0.0, 1000.0);
    m_fps->setDecimals(3);
    m_fps->setSpecialValueText(tr("as found"));
    m_swap = new QCheckBox(tr("Left and right are swapped"), m_overrides);
    m_swap->setObjectName(QStringLiteral("importSwap"));
    m_all = new QPushButton(tr("Use for all files"), m_overrides);
    m_all->setObjectName(QStringLiteral("importForAll"));
    form->addRow(tr("Unit"), m_unit);
    form->addRow(tr("Up axis"), m_up);
    form->addRow(tr("Frames per second"), m_fps);
    form->addRow(tr("Sides"), m_swap);
    form->addRow({}, m_all);
    const auto changed = [this] { takeOverrides(); };
    connect(m_unit, qOverload<int>(&QComboBox::activated), this, changed);
    connect(m_up, qOverload<int>(&QComboBox::activated), this, changed);
    connect(m_fps, &QDoubleSpinBox::editingFinished, this, changed);
    connect(m_swap, &QCheckBox::clicked, this, changed);
    connect(m_all, &QPushButton::clicked, this, [this] {
      for (size_t i = 0; i < m_files.size(); ++i) setOptions(i, current()->options);
    });
    return m_overrides;
  }

  QLayout* buildFolder() {
    m_note = new QLabel(
        tr("A document keeps the names of its motion files. Files that are read otherwise than "
           "they say are converted once: their motions are written as NPZ into this folder, and "
           "those files are added in their place."),
        this);
    m_note->setWordWrap(true);
    const QString document = m_workspace.file();
    const std::string& folder = m_workspace.experiment().folder.string();
    const QString beside =
        document.isEmpty() ? QString::fromStdString(folder) : QFileInfo(document).absolutePath();
    m_folder = new QLineEdit(beside + QStringLiteral("/converted"), this);
    m_folder->setObjectName(QStringLiteral("importFolder"));
    m_browse = new QToolButton(this);
    m_browse->setObjectName(QStringLiteral("importBrowse"));
    m_browse->setText(tr("Choose…"));
    connect(m_browse, &QToolButton::clicked, this, [this] {
      const QString chosen = QFileDialog::getExistingDirectory(
          this, tr("Folder of the converted files"), m_folder->text());
      if (!chosen.isEmpty()) m_folder->setText(chosen);
    });
    auto* row = new QHBoxLayout;
    row->addWidget(m_folder, 1);
    row->addWidget(m_browse);
    auto* layout = new QVBoxLayout;
    layout->addWidget(m_note);
    layout->addLayout(row);
    return layout;
  }

  QLayout* buildButtons() {
    m_add = new QPushButton(this);
    m_add->setObjectName(QStringLiteral("importAdd"));
    m_add->setDefault(true);
    auto* close = new QPushButton(tr("Cancel"), this);
    close->setObjectName(QStringLiteral("importClose"));
    connect(m_add, &QPushButton::clicked, this, &ImportDialog::addToDocument);
    connect(close, &QPushButton::clicked, this, &QDialog::close);
    auto* buttons = new QHBoxLayout;
    buttons->addStretch(1);
    buttons->addWidget(close);
    buttons->addWidget(m_add);
    return buttons;
  }

  ImportFile& fileAt(int row) { return m_files[m_rowFile[static_cast<size_t>(row)].first]; }

  ImportFile* current() {
    const int row = m_table->currentRow();
    return row < 0 || row >= static_cast<int>(m_rowFile.size()) ? nullptr : &fileAt(row);
  }

  void examineFile(size_t index) {
    auto reports = std::make_shared<std::vector<io::DoctorReport>>();
    const std::string path = m_files[index].path;
    const io::ReadOptions options = m_files[index].options;
    const int version = ++m_version;
    m_examined[index] = version;
    const QPointer<ImportDialog> self(this);
    m_workspace.jobs().start(
        Lane::Files, tr("Examining %1").arg(QFileInfo(QString::fromStdString(path)).fileName()),
        [reports, path, options](Progress&) { *reports = io::examine(path, options); },
        [self, reports, index, version] {
          if (!self || self->m_examined[index] != version) return;
          self->m_files[index].reports = std::move(*reports);
          if (!self->m_files[index].readable()) self->m_files[index].wanted = false;
          self->fillTable();
        });
  }

  void fillTable() {
    m_refreshing = true;
    const int kept = m_table->currentRow();
    m_rowFile.clear();
    for (size_t i = 0; i < m_files.size(); ++i)
      for (size_t r = 0; r < std::max<size_t>(1, m_files[i].reports.size()); ++r)
        m_rowFile.emplace_back(i, r);
    m_table->setRowCount(static_cast<int>(m_rowFile.size()));
    for (int row = 0; row < m_table->rowCount(); ++row) fillRow(row);
    if (kept >= 0) m_table->setCurrentCell(std::min(kept, m_table->rowCount() - 1), File);
    m_refreshing = false;
    refreshButtons();
  }

  void fillRow(int row) {
    const ImportFile& file = fileAt(row);
    const size_t number = m_rowFile[static_cast<size_t>(row)].second;
    const auto text = [&](int column, const QString& value, const std::string& tip = {}) {
      auto* item = new QTableWidgetItem(value);
      item->setToolTip(QString::fromStdString(tip));
      m_table->setItem(row, column, item);
      return item;
    };
    for (int column = 0; column < Columns; ++column) text(column, {});
    QString name = QFileInfo(QString::fromStdString(file.path)).fileName();
    if (number < file.reports.size() && file.reports.size() > 1)
      name += QStringLiteral(" · ") + QString::fromStdString(file.reports[number].clip);
    QTableWidgetItem* first = text(File, name, file.path);
    first->setCheckState(file.wanted ? Qt::Checked : Qt::Unchecked);
    if (number >= file.reports.size()) {
      text(Faults, tr("being examined…"));
      return;
    }
    const io::DoctorReport& r = file.reports[number];
    if (!file.readable()) first->setFlags(first->flags() & ~Qt::ItemIsUserCheckable);
    text(Format, QString::fromStdString(r.format));
    text(Rate, tr("%1 fps").arg(r.fps, 0, 'g', 5));
    text(Frames, QString::number(r.frames), fmt::format("{:.1f} s", r.seconds));
    text(Joints, QString::number(r.joints));
    text(Up, QString::fromStdString(r.up.value), r.up.evidence);
    text(Unit, QString::fromStdString(r.unit.value), r.unit.evidence);
    text(Body, QString::fromStdString(r.skeleton));
    text(Sides, QString::fromStdString(r.sides.value), r.sides.evidence);
    text(Floor, r.floorM ? QString::number(100.0 * *r.floorM, 'f', 1) : tr("unknown"));
    QTableWidgetItem* faults = text(Faults, faultKinds(r), faultEvidence(r).toStdString());
    const Inks inks = inksOf(palette());
    const auto worst = worstOf(r);
    if (worst == io::Severity::Error) faults->setForeground(inks.error);
    if (worst == io::Severity::Warning) faults->setForeground(inks.warning);
  }

  void refreshButtons() {
    int wanted = 0, converted = 0;
    bool ready = true;
    for (const ImportFile& file : m_files) {
      wanted += file.wanted ? 1 : 0;
      converted += file.wanted && file.overridden() ? 1 : 0;
      ready = ready && !file.reports.empty();
    }
    for (QWidget* widget : {static_cast<QWidget*>(m_note), static_cast<QWidget*>(m_folder),
                            static_cast<QWidget*>(m_browse)})
      widget->setVisible(converted > 0);
    m_add->setText(converted > 0 ? tr("Add %1 files, %2 converted").arg(wanted).arg(converted)
                                 : tr("Add %1 files").arg(wanted));
    m_add->setEnabled(ready && wanted > 0 && m_job < 0);
    m_all->setEnabled(m_files.size() > 1);
  }

  /// Another row: its overrides and its motion.
  void choose() {
    if (m_refreshing) return;
    const ImportFile* file = current();
    m_overrides->setEnabled(file != nullptr);
    if (file == nullptr) return;
    m_unit->setCurrentIndex(m_unit->findData(QString::fromStdString(file->options.unit)));
    m_up->setCurrentIndex(m_up->findData(QString::fromStdString(file->options.up)));
    m_fps->setValue(file->options.fps.value_or(0.0));
    m_swap->setChecked(file->options.swapSides);
    showPreview();
  }

  void takeOverrides() {
    const ImportFile* file = current();
    if (file == nullptr) return;
    io::ReadOptions options = file->options;
    options.unit = m_unit->currentData().toString().toStdString();
    options.up = m_up->currentData().toString().toStdString();
    options.fps.reset();
    if (m_fps->value() > 0.0) options.fps = m_fps->value();
    options.swapSides = m_swap->isChecked();
    setOptions(m_rowFile[static_cast<size_t>(m_table->currentRow())].first, options);
    showPreview();
  }

  void setOptions(size_t index, const io::ReadOptions& options) {
    m_files[index].options = options;
    m_files[index].wanted = true;
    examineFile(index);
    refreshButtons();
  }

  void showPreview() {
    if (const ImportFile* file = current())
      m_preview->show(file->path, m_rowFile[static_cast<size_t>(m_table->currentRow())].second,
                      file->options);
  }

  void addToDocument() {
    auto sources = std::make_shared<std::vector<std::string>>();
    const std::filesystem::path folder = m_folder->text().toStdString();
    const QPointer<ImportDialog> self(this);
    m_job = m_workspace.jobs().start(
        Lane::Files, tr("Importing motion"),
        [sources, files = m_files, folder](Progress& progress) {
          *sources = convertOverridden(files, folder, progress);
        },
        [self, sources, workspace = QPointer<Workspace>(&m_workspace)] {
          if (!workspace) return;
          workspace->edit(QObject::tr("Import motion"),
                          [&](Experiment& e) { addNatural(e, *sources); });
          if (self) self->close();
        });
    connect(&m_workspace.jobs(), &JobQueue::ended, this, [this](int id, bool) {
      if (id != m_job) return;
      m_job = -1;
      refreshButtons();
    });
    refreshButtons();
  }

  Workspace& m_workspace;
  std::vector<ImportFile> m_files;
  std::vector<std::pair<size_t, size_t>> m_rowFile;  ///< (file, its clip) of every row
  std::map<size_t, int> m_examined;  ///< the last examination of every file that was asked for
  int m_version = 0, m_job = -1;
  QTableWidget* m_table = nullptr;
  ImportPreview* m_preview = nullptr;
  QGroupBox* m_overrides = nullptr;
  QComboBox* m_unit = nullptr;
  QComboBox* m_up = nullptr;
  QDoubleSpinBox* m_fps = nullptr;
  QCheckBox* m_swap = nullptr;
  QPushButton* m_all = nullptr;
  QLabel* m_note = nullptr;
  QLineEdit* m_folder = nullptr;
  QToolButton* m_browse = nullptr;
  QPushButton* m_add = nullptr;
  bool m_refreshing = false;  ///< the table is being filled, not used
};

}  // namespace

void showImportDialog(Workspace& workspace, const QStringList& files, QWidget* parent) {
  std::vector<std::string> given;
  for (const QString& file : files) given.push_back(file.toStdString());
  try {
    (new ImportDialog(workspace, importFiles(given), parent))->show();
  } catch (const Error& error) {
    workspace.report(QObject::tr("Importing motion"), QString::fromStdString(error.what()));
  }
}

}  // namespace marey::gui
