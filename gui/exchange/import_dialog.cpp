#include "gui/exchange/import_dialog.h"

#include <QDialog>
#include <QFileDialog>
#include <QFileInfo>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPointer>
#include <QPushButton>
#include <QSplitter>
#include <QTableView>
#include <QTimer>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>

#include "gui/exchange/import_examiner.h"
#include "gui/exchange/import_model.h"
#include "gui/exchange/import_overrides.h"
#include "gui/exchange/import_preview.h"

#include "experiment/edits.h"

namespace marey::gui {
namespace {

class ImportDialog : public QDialog {
 public:
  ImportDialog(Workspace& workspace, const std::vector<std::string>& given, QWidget* parent)
      : QDialog(parent),
        m_workspace(workspace),
        m_model(new ImportModel(this)),
        m_examiner(new ImportExaminer(workspace.jobs(), this)) {
    setObjectName(QStringLiteral("importDialog"));
    setWindowTitle(tr("Import motion"));
    setAttribute(Qt::WA_DeleteOnClose);
    auto* layout = new QVBoxLayout(this);
    auto* split = new QSplitter(Qt::Vertical, this);
    auto* top = new QWidget(split);
    auto* column = new QVBoxLayout(top);
    column->setContentsMargins(0, 0, 0, 0);
    column->addWidget(buildTable(), 1);
    column->addWidget(buildReason());
    split->addWidget(top);
    auto* below = new QWidget(split);
    auto* row = new QHBoxLayout(below);
    row->setContentsMargins(0, 0, 0, 0);
    m_preview = new ImportPreview(workspace.jobs(), below);
    m_overrides = new ImportOverrides(below);
    m_overrides->setEnabled(false);
    row->addWidget(m_preview, 3);
    row->addWidget(m_overrides, 2);
    split->addWidget(below);
    layout->addWidget(split, 1);
    layout->addLayout(buildFolder());
    layout->addLayout(buildButtons());
    resize(1120, 700);
    connectAll();
    m_examiner->start(given);
    refreshButtons();
  }

  /// Every way of closing comes here; what was asked for is then not wanted any more.
  void done(int result) override {
    m_closed = true;
    m_examiner->cancel();
    m_workspace.jobs().cancel(m_job);
    QDialog::done(result);
  }

 private:
  QWidget* buildTable() {
    m_table = new QTableView(this);
    m_table->setObjectName(QStringLiteral("importTable"));
    m_table->setModel(m_model);
    m_model->setInks(inksOf(palette()));
    m_table->verticalHeader()->hide();
    // Rows of one height: the view need not ask a thousand of them.
    m_table->verticalHeader()->setSectionResizeMode(QHeaderView::Fixed);
    m_table->verticalHeader()->setDefaultSectionSize(fontMetrics().height() + 8);
    m_table->setSelectionBehavior(QAbstractItemView::SelectRows);
    m_table->setSelectionMode(QAbstractItemView::SingleSelection);
    constexpr int kRowsMeasured = 30;
    m_table->horizontalHeader()->setResizeContentsPrecision(kRowsMeasured);
    m_table->horizontalHeader()->setStretchLastSection(true);
    return m_table;
  }

  /// What is wrong with the chosen file, whole: a cell of the table has no room for it.
  QWidget* buildReason() {
    m_reason = new QLabel(this);
    m_reason->setObjectName(QStringLiteral("importReason"));
    m_reason->setWordWrap(true);
    m_reason->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
    m_reason->setTextFormat(Qt::PlainText);
    m_reason->hide();
    return m_reason;
  }

  void showReason() {
    const int row = m_table->currentIndex().row();
    const QString text =
        row < 0
            ? QString()
            : m_model->data(m_model->index(row, ImportModel::Faults), Qt::ToolTipRole).toString();
    m_reason->setText(text);
    m_reason->setVisible(!text.isEmpty());
  }

  void connectAll() {
    m_refresh.setSingleShot(true);
    m_refresh.setInterval(0);
    connect(&m_refresh, &QTimer::timeout, this, &ImportDialog::refreshButtons);
    connect(m_model, &ImportModel::choiceChanged, &m_refresh, qOverload<>(&QTimer::start));
    connect(m_examiner, &ImportExaminer::listed, this, [this](const ImportList& list) {
      QStringList others;
      for (const std::string& remark : list.remarks) others << QString::fromStdString(remark);
      m_others = others.join(QStringLiteral(" · "));
      m_model->setFiles(list.files);
      m_table->selectRow(0);
    });
    connect(m_examiner, &ImportExaminer::examined, m_model, &ImportModel::setReports);
    connect(m_model, &QAbstractItemModel::dataChanged, this, [this] { showReason(); });
    connect(m_examiner, &ImportExaminer::settled, this, [this] {
      if (!m_fitted) m_table->resizeColumnsToContents();
      m_fitted = true;
      refreshButtons();
    });
    connect(m_examiner, &ImportExaminer::failed, this, [this] {
      if (!m_closed) close();
    });
    connect(m_table->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
            &ImportDialog::choose);
    connect(m_overrides, &ImportOverrides::changed, this, &ImportDialog::takeOverrides);
    connect(m_overrides, &ImportOverrides::forAll, this, &ImportDialog::useForAll);
    connect(&m_workspace.jobs(), &JobQueue::ended, this, [this](int id, bool) {
      if (id != m_job) return;
      m_job = -1;
      refreshButtons();
    });
  }

  QLayout* buildFolder() {
    m_note = new QLabel(
        tr("A document keeps the names of its motion files. Files that are read otherwise than "
           "they say are converted once: their motions are written as NPZ into this folder, and "
           "those files are added in their place."),
        this);
    m_note->setWordWrap(true);
    const QString document = m_workspace.document().file();
    const std::string& folder = m_workspace.document().experiment().folder.string();
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
    m_state = new QLabel(this);
    m_state->setObjectName(QStringLiteral("importState"));
    m_state->setWordWrap(true);
    auto* close = new QPushButton(tr("Cancel"), this);
    close->setObjectName(QStringLiteral("importClose"));
    connect(m_add, &QPushButton::clicked, this, &ImportDialog::addToDocument);
    connect(close, &QPushButton::clicked, this, &QDialog::close);
    auto* buttons = new QHBoxLayout;
    buttons->addWidget(m_state, 1);
    buttons->addWidget(close);
    buttons->addWidget(m_add);
    return buttons;
  }

  void refreshButtons() {
    int wanted = 0, converted = 0;
    for (const ImportFile& file : m_model->files()) {
      if (!file.taken()) continue;
      ++wanted;
      converted += file.overridden() ? 1 : 0;
    }
    for (QWidget* widget : {static_cast<QWidget*>(m_note), static_cast<QWidget*>(m_folder),
                            static_cast<QWidget*>(m_browse)})
      widget->setVisible(converted > 0);
    m_add->setText(converted > 0 ? tr("Add %1 files, %2 converted").arg(wanted).arg(converted)
                                 : tr("Add %1 files").arg(wanted));
    m_add->setEnabled(!m_examiner->busy() && wanted > 0 && m_job < 0);
    const size_t files = m_model->files().size();
    m_overrides->setSeveral(files > 1);
    m_state->setText(m_job >= 0   ? tr("Importing…")
                     : files == 0 ? tr("Looking for motion files…")
                     : m_examiner->busy()
                         ? tr("Examined %1 of %2").arg(m_model->examined()).arg(files)
                         : leftOutText());
  }

  /// What is given and not added, once all of it was looked at.
  QString leftOutText() const {
    const auto& files = m_model->files();
    const auto unread = std::count_if(files.begin(), files.end(),
                                      [](const ImportFile& file) { return !file.readable(); });
    QStringList parts;
    if (unread > 0)
      parts << tr("%1 of %2 files not read: choose one to see why").arg(unread).arg(files.size());
    if (!m_others.isEmpty()) parts << m_others;
    return parts.join(QStringLiteral(" · "));
  }

  /// Another row: its overrides and its motion.
  void choose() {
    const int row = m_table->currentIndex().row();
    m_overrides->setEnabled(row >= 0 && !m_model->files()[m_model->fileAt(row)].skipped);
    showReason();
    if (row < 0) return;
    m_overrides->setOptions(m_model->files()[m_model->fileAt(row)].options);
    showPreview();
  }

  void takeOverrides() {
    const int row = m_table->currentIndex().row();
    if (row < 0) return;
    const size_t file = m_model->fileAt(row);
    m_model->setOptions(file, m_overrides->options());
    // The motion first, then what the doctor says of it.
    showPreview();
    m_examiner->examine(file, m_model->files()[file].path, m_model->files()[file].options);
    refreshButtons();
  }

  void useForAll() {
    const io::ReadOptions options = m_overrides->options();
    for (size_t i = 0; i < m_model->files().size(); ++i) m_model->setOptions(i, options);
    showPreview();
    m_examiner->examineAll(m_model->files());
    refreshButtons();
  }

  void showPreview() {
    const int row = m_table->currentIndex().row();
    if (row < 0) return;
    const ImportFile& file = m_model->files()[m_model->fileAt(row)];
    m_preview->show(file.path, m_model->clipAt(row), file.options);
  }

  void addToDocument() {
    auto sources = std::make_shared<std::vector<std::string>>();
    const std::filesystem::path folder = m_folder->text().toStdString();
    const QPointer<ImportDialog> self(this);
    m_job = m_workspace.jobs().start(
        Lane::Files, tr("Importing motion"),
        [sources, files = m_model->files(), folder](Progress& progress) {
          *sources = convertOverridden(files, folder, progress);
        },
        [self, sources] {
          if (!self || self->m_closed) return;
          self->m_workspace.document().edit(tr("Import motion"),
                                            [&](Experiment& e) { addNatural(e, *sources); });
          self->close();
        });
    refreshButtons();
  }

  Workspace& m_workspace;
  ImportModel* m_model;
  ImportExaminer* m_examiner;
  int m_job = -1;         ///< of adding
  bool m_closed = false;  ///< nothing more is added
  bool m_fitted = false;  ///< the columns, to what they hold
  QString m_others;       ///< on files of other formats in the folders
  QTimer m_refresh;
  QTableView* m_table = nullptr;
  QLabel* m_reason = nullptr;
  ImportPreview* m_preview = nullptr;
  ImportOverrides* m_overrides = nullptr;
  QLabel* m_note = nullptr;
  QLineEdit* m_folder = nullptr;
  QToolButton* m_browse = nullptr;
  QLabel* m_state = nullptr;
  QPushButton* m_add = nullptr;
};

}  // namespace

void showImportDialog(Workspace& workspace, const QStringList& files, QWidget* parent) {
  std::vector<std::string> given;
  for (const QString& file : files) given.push_back(file.toStdString());
  (new ImportDialog(workspace, given, parent))->show();
}

}  // namespace marey::gui
