#include "panels/export_dialog.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QDir>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QGroupBox>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QMessageBox>
#include <QPointer>
#include <QProgressBar>
#include <QPushButton>
#include <QRadioButton>
#include <QSettings>
#include <QTableWidget>
#include <QToolButton>
#include <QVBoxLayout>

#include "panels/motion_export.h"

namespace marey::gui {
namespace {
namespace fs = std::filesystem;

constexpr double kMostGifFps = 50.0, kMostFps = 240.0;
constexpr int kLeastPixels = 64, kMostPixels = 8192;

class ExportDialog : public QDialog {
 public:
  ExportDialog(Workspace& workspace, QWidget* parent) : QDialog(parent), m_workspace(workspace) {
    setObjectName(QStringLiteral("exportDialog"));
    setWindowTitle(tr("Export motions"));
    setAttribute(Qt::WA_DeleteOnClose);
    auto* layout = new QVBoxLayout(this);
    layout->addLayout(buildWhat());
    layout->addWidget(buildPicture());
    layout->addLayout(buildWhere());
    layout->addWidget(buildResult());
    layout->addLayout(buildButtons());
    connect(&workspace, &Workspace::selectionChanged, this, &ExportDialog::refresh);
    connect(&workspace, &Workspace::visibilityChanged, this, &ExportDialog::refresh);
    connect(&workspace, &Workspace::rangeChanged, this, &ExportDialog::refresh);
    connect(&workspace.jobs(), &JobQueue::changed, this, &ExportDialog::refreshProgress);
    connect(&workspace.jobs(), &JobQueue::ended, this, [this](int id, bool successful) {
      if (id == m_job) finish(successful);
    });
    m_selected->setChecked(!workspace.selection().motions.empty());
    m_visible->setChecked(workspace.selection().motions.empty());
    refresh();
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
    connect(m_selected, &QRadioButton::toggled, this, &ExportDialog::refresh);
    connect(m_range, &QCheckBox::toggled, this, &ExportDialog::refresh);
    connect(m_format, qOverload<int>(&QComboBox::currentIndexChanged), this,
            &ExportDialog::refresh);
    return form;
  }

  QSpinBox* pixels(const char* name, int value) {
    auto* box = new QSpinBox(this);
    box->setObjectName(QLatin1String(name));
    box->setRange(kLeastPixels, kMostPixels);
    box->setSingleStep(2);
    box->setValue(value);
    return box;
  }

  QWidget* buildPicture() {
    m_picture = new QGroupBox(tr("Picture"), this);
    auto* form = new QFormLayout(m_picture);
    m_width = pixels("exportWidth", 1280);
    m_height = pixels("exportHeight", 720);
    auto* size = new QHBoxLayout;
    size->addWidget(m_width);
    size->addWidget(new QLabel(QStringLiteral("×"), m_picture));
    size->addWidget(m_height);
    size->addStretch(1);
    m_fps = new QDoubleSpinBox(this);
    m_fps->setObjectName(QStringLiteral("exportFps"));
    m_fps->setRange(1.0, kMostFps);
    m_fps->setDecimals(1);
    m_fps->setValue(30.0);
    m_view = new QComboBox(this);
    m_view->setObjectName(QStringLiteral("exportView"));
    m_view->addItem(tr("From the side and above"), static_cast<int>(render::View::ThreeQuarter));
    m_view->addItem(tr("From the side"), static_cast<int>(render::View::Side));
    m_view->addItem(tr("From above"), static_cast<int>(render::View::Top));
    m_follow = new QComboBox(this);
    m_follow->setObjectName(QStringLiteral("exportCamera"));
    m_follow->addItems({tr("Fixed"), tr("Following the figures")});
    m_strobe = new QDoubleSpinBox(this);
    m_strobe->setObjectName(QStringLiteral("exportStrobe"));
    m_strobe->setRange(0.05, 60.0);
    m_strobe->setSingleStep(0.1);
    m_strobe->setValue(0.4);
    m_strobe->setPrefix(tr("a figure every "));
    m_strobe->setSuffix(tr(" s"));
    m_trail = new QCheckBox(tr("Earlier figures stay, lighter"), this);
    m_trail->setObjectName(QStringLiteral("exportTrail"));
    m_path = new QCheckBox(tr("Path that was asked for"), this);
    m_path->setObjectName(QStringLiteral("exportPath"));
    m_path->setChecked(true);
    form->addRow(tr("Size in pixels"), size);
    form->addRow(tr("Frames per second"), m_fps);
    form->addRow(tr("View"), m_view);
    form->addRow(tr("Camera"), m_follow);
    form->addRow(tr("Trail"), m_trail);
    form->addRow(tr("Exposures"), m_strobe);
    form->addRow(tr("On the floor"), m_path);
    connect(m_trail, &QCheckBox::toggled, this, &ExportDialog::refresh);
    return m_picture;
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
    const auto& selected = m_workspace.selection().motions;
    if (m_selected->isChecked()) return {selected.begin(), selected.end()};
    return m_workspace.visibleMotions();
  }

  ExportRequest request() const {
    const bool part = m_range->isChecked() && m_workspace.range().has_value();
    return {.format = format(),
            .folder = m_folder->text().toStdString(),
            .name = m_name->text().toStdString(),
            .items = exportItems(m_workspace.experiment(), m_workspace.groups(), motions(),
                                 part ? m_workspace.range() : std::nullopt),
            .width = m_width->value(),
            .height = m_height->value(),
            .fps = m_fps->value(),
            .view = static_cast<render::View>(m_view->currentData().toInt()),
            .follow = m_follow->currentIndex() == 1,
            .trail = m_trail->isChecked(),
            .path = m_path->isChecked(),
            .strobeS = m_strobe->value()};
  }

  void refresh() {
    const auto selected = static_cast<int>(m_workspace.selection().motions.size());
    const auto visible = static_cast<int>(m_workspace.visibleMotions().size());
    m_selected->setText(tr("Selected (%1)").arg(selected));
    m_visible->setText(tr("All visible (%1)").arg(visible));
    m_range->setEnabled(m_workspace.range().has_value());
    const bool video = isVideo(format());
    m_picture->setVisible(isPicture(format()));
    m_fps->setEnabled(video);
    m_fps->setMaximum(format() == ExportFormat::Gif ? kMostGifFps : kMostFps);
    m_follow->setEnabled(video);
    m_trail->setEnabled(video);
    m_strobe->setEnabled(!video || m_trail->isChecked());
    m_name->setEnabled(isPicture(format()));
    const ExportRequest wanted = request();
    const auto files = exportFiles(wanted);
    QStringList names;
    constexpr size_t kNamed = 3;
    for (size_t i = 0; i < std::min(kNamed, files.size()); ++i)
      names += QString::fromStdString(files[i].filename().string());
    if (files.size() > kNamed) names += tr("… %1 files").arg(files.size());
    m_files->setText(names.join(QStringLiteral(", ")));
    refreshProgress();
    m_run->setEnabled(m_job < 0 && !wanted.items.empty() && !m_folder->text().isEmpty());
  }

  void refreshProgress() {
    m_cancel->setEnabled(m_job >= 0);
    m_progress->setVisible(m_job >= 0);
    for (const JobStatus& job : m_workspace.jobs().jobs())
      if (job.id == m_job) m_progress->setValue(static_cast<int>(1000.0 * job.fraction));
  }

  bool mayReplace(const ExportRequest& wanted) {
    int there = 0;
    for (const fs::path& file : exportFiles(wanted)) there += fs::exists(file) ? 1 : 0;
    if (there == 0) return true;
    return QMessageBox::question(
               this, tr("Export motions"),
               tr("%1 of the files are there already. Replace them?").arg(there)) ==
           QMessageBox::Yes;
  }

  void run() {
    ExportRequest wanted = request();
    // The encoders of videos halve the colours' resolution.
    if (format() == ExportFormat::Mp4 || format() == ExportFormat::WebM) {
      wanted.width -= wanted.width % 2;
      wanted.height -= wanted.height % 2;
    }
    if (!mayReplace(wanted)) return;
    QSettings().setValue(QStringLiteral("exportFolder"), m_folder->text());
    m_fit->hide();
    m_done->clear();
    m_result = std::make_shared<ExportResult>();
    m_job =
        m_workspace.jobs().start(Lane::Exports, tr("Exporting %1 motions").arg(wanted.items.size()),
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
  QRadioButton* m_selected = nullptr;
  QRadioButton* m_visible = nullptr;
  QCheckBox* m_range = nullptr;
  QComboBox* m_format = nullptr;
  QGroupBox* m_picture = nullptr;
  QSpinBox* m_width = nullptr;
  QSpinBox* m_height = nullptr;
  QDoubleSpinBox* m_fps = nullptr;
  QComboBox* m_view = nullptr;
  QComboBox* m_follow = nullptr;
  QDoubleSpinBox* m_strobe = nullptr;
  QCheckBox* m_trail = nullptr;
  QCheckBox* m_path = nullptr;
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

void showExportDialog(Workspace& workspace, QWidget* parent) {
  (new ExportDialog(workspace, parent))->show();
}

}  // namespace marey::gui
