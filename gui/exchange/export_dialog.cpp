#include "gui/exchange/export_dialog.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QDir>
#include <QFileDialog>
#include <QFormLayout>
#include <QGroupBox>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QMessageBox>
#include <QProgressBar>
#include <QPushButton>
#include <QRadioButton>
#include <QSettings>
#include <QTableWidget>
#include <QToolButton>
#include <QVBoxLayout>

#include "gui/exchange/export_picture_form.h"

namespace marey::gui {
namespace {
namespace fs = std::filesystem;

class ExportDialog : public QDialog {
 public:
  ExportDialog(Workspace& workspace, std::shared_ptr<const ShownScene> scene, QWidget* parent)
      : QDialog(parent),
        m_workspace(workspace),
        m_picture(new ExportPictureForm(std::move(scene), this)) {
    setObjectName(QStringLiteral("exportDialog"));
    setWindowTitle(tr("Export motions"));
    setAttribute(Qt::WA_DeleteOnClose);
    auto* layout = new QVBoxLayout(this);
    layout->addLayout(buildWhat());
    layout->addWidget(m_picture);
    layout->addLayout(buildWhere());
    layout->addWidget(buildResult());
    layout->addLayout(buildButtons());
    connect(&workspace.view(), &View::selectionChanged, this, &ExportDialog::refreshItems);
    connect(&workspace.motions(), &MotionGroups::visibilityChanged, this,
            &ExportDialog::refreshItems);
    connect(&workspace.view(), &View::rangeChanged, this, &ExportDialog::refreshItems);
    connect(&workspace.jobs(), &JobQueue::changed, this, &ExportDialog::refreshProgress);
    connect(&workspace.jobs(), &JobQueue::ended, this, [this](int id, bool successful) {
      if (id == m_job) finish(successful);
    });
    connect(&workspace.jobs(), &JobQueue::failed, this,
            [this](const QString& title, const QString& error) {
              if (title == m_title) m_done->setText(tr("Nothing was written. %1").arg(error));
            });
    m_selected->setChecked(!workspace.view().selection().motions.empty());
    m_visible->setChecked(workspace.view().selection().motions.empty());
    refreshItems();
    resize(520, 560);
  }

 private:
  QLayout* buildWhat() {
    auto* form = new QFormLayout;
    m_selected = new QRadioButton(this);
    m_selected->setObjectName(QStringLiteral("exportSelected"));
    m_visible = new QRadioButton(this);
    m_visible->setObjectName(QStringLiteral("exportVisible"));
    m_range = new QCheckBox(tr("Only the marked time range"), this);
    m_range->setObjectName(QStringLiteral("exportRange"));
    m_format = new QComboBox(this);
    m_format->setObjectName(QStringLiteral("exportFormat"));
    const std::pair<QString, ExportFormat> formats[] = {
        {tr("Video, MP4 (H.264)"), ExportFormat::Mp4},
        {tr("Video, WebM (VP9)"), ExportFormat::WebM},
        {tr("Animation, GIF"), ExportFormat::Gif},
        {tr("Frames, numbered PNG"), ExportFormat::PngFrames},
        {tr("Still picture, PNG"), ExportFormat::Still},
        {tr("Motion, BVH"), ExportFormat::Bvh},
        {tr("Motion, glTF (text)"), ExportFormat::Gltf},
        {tr("Motion, GLB (glTF in one file)"), ExportFormat::Glb},
        {tr("Motion, NPZ (NumPy)"), ExportFormat::Npz},
        {tr("Positions, CSV"), ExportFormat::Csv}};
    for (const auto& [text, format] : formats) m_format->addItem(text, static_cast<int>(format));
    form->addRow(tr("Motions"), m_selected);
    form->addRow({}, m_visible);
    form->addRow({}, m_range);
    form->addRow(tr("Format"), m_format);
    connect(m_selected, &QRadioButton::toggled, this, &ExportDialog::refreshItems);
    connect(m_range, &QCheckBox::toggled, this, &ExportDialog::refreshItems);
    connect(m_format, qOverload<int>(&QComboBox::currentIndexChanged), this,
            &ExportDialog::refresh);
    return form;
  }

  QLayout* buildWhere() {
    auto* form = new QFormLayout;
    const QString last = QSettings().value(QStringLiteral("exportFolder")).toString();
    m_folder = new QLineEdit(last.isEmpty() ? QDir::homePath() : last, this);
    m_folder->setObjectName(QStringLiteral("exportFolder"));
    auto* browse = new QToolButton(this);
    browse->setObjectName(QStringLiteral("exportBrowse"));
    browse->setText(tr("Choose…"));
    connect(browse, &QToolButton::clicked, this, [this] {
      const QString chosen = QFileDialog::getExistingDirectory(
          this, tr("Folder of the exported files"), m_folder->text());
      if (!chosen.isEmpty()) m_folder->setText(chosen);
    });
    auto* folder = new QHBoxLayout;
    folder->addWidget(m_folder, 1);
    folder->addWidget(browse);
    m_name = new QLineEdit(QStringLiteral("motions"), this);
    m_name->setObjectName(QStringLiteral("exportName"));
    m_files = new QLabel(this);
    m_files->setObjectName(QStringLiteral("exportFiles"));
    m_files->setWordWrap(true);
    m_files->setTextInteractionFlags(Qt::TextSelectableByMouse);
    form->addRow(tr("Folder"), folder);
    form->addRow(tr("Name"), m_name);
    form->addRow(tr("Writes"), m_files);
    connect(m_folder, &QLineEdit::textChanged, this, &ExportDialog::refresh);
    connect(m_name, &QLineEdit::textChanged, this, &ExportDialog::refresh);
    return form;
  }

  QWidget* buildResult() {
    m_fit = new QGroupBox(tr("Residual of the skeleton fit"), this);
    auto* layout = new QVBoxLayout(m_fit);
    auto* note = new QLabel(tr("The motions hold positions only. Rotations of a skeleton with "
                               "constant bones were fitted to them; this is how far its joints "
                               "stay from the motion."),
                            m_fit);
    note->setWordWrap(true);
    layout->addWidget(note);
    m_residual = new QTableWidget(0, 3, m_fit);
    m_residual->setObjectName(QStringLiteral("exportResidual"));
    m_residual->setHorizontalHeaderLabels({tr("Joint"), tr("RMS, cm"), tr("Largest, cm")});
    m_residual->verticalHeader()->hide();
    m_residual->horizontalHeader()->setSectionResizeMode(0, QHeaderView::Stretch);
    m_residual->setEditTriggers(QAbstractItemView::NoEditTriggers);
    m_residual->setMinimumHeight(140);
    layout->addWidget(m_residual);
    m_fit->hide();
    return m_fit;
  }

  QLayout* buildButtons() {
    m_progress = new QProgressBar(this);
    m_progress->setObjectName(QStringLiteral("exportProgress"));
    m_progress->setRange(0, 1000);
    m_progress->hide();
    m_done = new QLabel(this);
    m_done->setObjectName(QStringLiteral("exportDone"));
    m_done->setWordWrap(true);
    m_run = new QPushButton(tr("Export"), this);
    m_run->setObjectName(QStringLiteral("exportRun"));
    m_run->setDefault(true);
    m_cancel = new QPushButton(tr("Cancel the export"), this);
    m_cancel->setObjectName(QStringLiteral("exportCancel"));
    auto* close = new QPushButton(tr("Close"), this);
    close->setObjectName(QStringLiteral("exportClose"));
    connect(m_run, &QPushButton::clicked, this, &ExportDialog::run);
    connect(m_cancel, &QPushButton::clicked, this, [this] { m_workspace.jobs().cancel(m_job); });
    connect(close, &QPushButton::clicked, this, &QDialog::close);
    auto* buttons = new QHBoxLayout;
    buttons->addStretch(1);
    buttons->addWidget(m_cancel);
    buttons->addWidget(close);
    buttons->addWidget(m_run);
    auto* layout = new QVBoxLayout;
    layout->addWidget(m_progress);
    layout->addWidget(m_done);
    layout->addLayout(buttons);
    return layout;
  }

  ExportFormat format() const { return static_cast<ExportFormat>(m_format->currentData().toInt()); }

  std::vector<MotionId> motions() const {
    const auto& selected = m_workspace.view().selection().motions;
    if (m_selected->isChecked()) return {selected.begin(), selected.end()};
    return m_workspace.motions().visibleMotions();
  }

  std::optional<TimeRange> range() const {
    return m_range->isChecked() ? m_workspace.view().range() : std::nullopt;
  }

  /// What is written where; the pictures' looks are filled in when it is asked for.
  ExportRequest request() const {
    return {.format = format(),
            .folder = m_folder->text().toStdString(),
            .name = m_name->text().toStdString(),
            .items = m_items,
            .range = range(),
            .contacts = m_workspace.contactRule()};
  }

  /// Names of the motions: worked out when these change, not at every letter of a folder's name.
  void refreshItems() {
    m_items = exportItems(m_workspace.document().experiment(), m_workspace.motions().groups(),
                          motions(), range());
    refresh();
  }

  void refresh() {
    const auto selected = static_cast<int>(m_workspace.view().selection().motions.size());
    const auto visible = static_cast<int>(m_workspace.motions().visibleMotions().size());
    m_selected->setText(tr("Selected (%1)").arg(selected));
    m_visible->setText(tr("All visible (%1)").arg(visible));
    m_range->setEnabled(m_workspace.view().range().has_value());
    m_picture->setVisible(isPicture(format()));
    m_picture->setFormat(format());
    m_name->setEnabled(isPicture(format()));
    const auto files = exportFiles(request());
    QStringList names;
    constexpr size_t kNamed = 3;
    for (size_t i = 0; i < std::min(kNamed, files.size()); ++i)
      names += QString::fromStdString(files[i].filename().string());
    if (files.size() > kNamed) names += tr("… %1 files").arg(files.size());
    m_files->setText(names.join(QStringLiteral(", ")));
    refreshProgress();
    m_run->setEnabled(m_job < 0 && !m_items.empty() && !m_folder->text().isEmpty());
  }

  void refreshProgress() {
    m_cancel->setEnabled(m_job >= 0);
    m_progress->setVisible(m_job >= 0);
    for (const JobStatus& job : m_workspace.jobs().jobs())
      if (job.id == m_job) m_progress->setValue(static_cast<int>(1000.0 * job.fraction));
  }

  bool mayReplace(const ExportRequest& wanted) {
    const auto there = static_cast<int>(replacedFiles(wanted).size());
    if (there == 0) return true;
    const QString question =
        wanted.format == ExportFormat::PngFrames
            ? tr("%1 numbered pictures of that name are there already. Replace them all?")
            : tr("%1 of the files are there already. Replace them?");
    return QMessageBox::question(this, tr("Export motions"), question.arg(there)) ==
           QMessageBox::Yes;
  }

  void run() {
    // The document may have been edited since the motions were listed.
    refreshItems();
    ExportRequest wanted = request();
    wanted.experimentHash = experimentHash(m_workspace.document().experiment());
    if (isPicture(wanted.format)) m_picture->fill(wanted, m_selected->isChecked());
    if (!mayReplace(wanted)) return;
    QSettings().setValue(QStringLiteral("exportFolder"), m_folder->text());
    m_fit->hide();
    m_done->clear();
    m_result = std::make_shared<ExportResult>();
    m_title = tr("Exporting %1 motions").arg(wanted.items.size());
    m_job = m_workspace.jobs().start(Lane::Exports, m_title,
                                     [wanted, result = m_result](Progress& progress) {
                                       *result = exportMotions(wanted, progress);
                                     });
    refresh();
  }

  void finish(bool successful) {
    m_job = -1;
    if (successful) {
      const auto count = static_cast<int>(m_result->files.size());
      m_done->setText(
          count == 1
              ? tr("Written: %1").arg(QString::fromStdString(m_result->files.front().string()))
              : tr("%1 files written to %2").arg(count).arg(m_folder->text()));
      if (m_result->fit) showResidual(*m_result->fit);
    } else {
      m_done->setText(tr("Nothing was written."));
    }
    refresh();
  }

  void showResidual(const FitResidual& fit) {
    constexpr double kCentimetres = 100.0;
    m_residual->setRowCount(static_cast<int>(fit.joints.size()));
    for (size_t j = 0; j < fit.joints.size(); ++j) {
      const QString cells[] = {QString::fromStdString(fit.joints[j]),
                               QString::number(kCentimetres * fit.rmsM[j], 'f', 2),
                               QString::number(kCentimetres * fit.maxM[j], 'f', 2)};
      for (int column = 0; column < 3; ++column) {
        auto* item = new QTableWidgetItem(cells[column]);
        if (column > 0) item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
        m_residual->setItem(static_cast<int>(j), column, item);
      }
    }
    m_fit->show();
  }

  Workspace& m_workspace;
  ExportPictureForm* m_picture;
  std::vector<ExportItem> m_items;
  QString m_title;  ///< of the job
  QRadioButton* m_selected = nullptr;
  QRadioButton* m_visible = nullptr;
  QCheckBox* m_range = nullptr;
  QComboBox* m_format = nullptr;
  QLineEdit* m_folder = nullptr;
  QLineEdit* m_name = nullptr;
  QLabel* m_files = nullptr;
  QGroupBox* m_fit = nullptr;
  QTableWidget* m_residual = nullptr;
  QProgressBar* m_progress = nullptr;
  QLabel* m_done = nullptr;
  QPushButton* m_run = nullptr;
  QPushButton* m_cancel = nullptr;
  std::shared_ptr<ExportResult> m_result;
  int m_job = -1;  ///< of the queue; -1: none runs
};

}  // namespace

void saveScenePicture(Workspace& workspace, const ShownScene& scene, QWidget* parent) {
  if (scene.width == 0) return;  // never drawn
  const QString last = QSettings().value(QStringLiteral("exportFolder")).toString();
  const QString file = QFileDialog::getSaveFileName(
      parent, QObject::tr("Picture of the 3D view"),
      (last.isEmpty() ? QDir::homePath() : last) + QStringLiteral("/scene.png"),
      QObject::tr("PNG (*.png)"));
  if (file.isEmpty()) return;
  fs::path path = file.toStdString();
  if (path.extension() != ".png") path += ".png";
  ExportRequest request{
      .format = ExportFormat::Still,
      .items = exportItems(workspace.document().experiment(), workspace.motions().groups(),
                           workspace.motions().visibleMotions(), std::nullopt),
      .range = std::nullopt,
      .experimentHash = experimentHash(workspace.document().experiment()),
      .width = scene.width,
      .height = scene.height};
  copyScene(scene, request, false);
  addLegend(scene, request);
  workspace.jobs().start(
      Lane::Exports, QObject::tr("Picture of the 3D view"), [request, path](Progress&) {
        render::writePng(
            path, render::drawShot(*request.shot, request.stillS, request.width, request.height),
            pictureRecipe(request));
      });
}

void showExportDialog(Workspace& workspace, std::shared_ptr<const ShownScene> scene,
                      QWidget* parent) {
  (new ExportDialog(workspace, std::move(scene), parent))->show();
}

}  // namespace marey::gui
