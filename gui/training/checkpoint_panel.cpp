#include "gui/training/checkpoint_panel.h"

#include <QFileDialog>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLineEdit>
#include <QPushButton>
#include <QSettings>
#include <QTableWidget>
#include <QToolButton>
#include <QVBoxLayout>
#include <cmath>

#include "gui/common/paint_style.h"
#include "gui/plots/workspace_chart.h"
#include "gui/training/checkpoint_strip.h"
#include "gui/training/loss_chart.h"

#include "base/error.h"

namespace marey::gui {
namespace {
namespace fs = std::filesystem;

/// A run that goes on writes a line now and then.
constexpr int kLookEveryMs = 3000;

class CheckpointPanel : public QWidget {
 public:
  CheckpointPanel(Workspace& workspace, QWidget* parent) : QWidget(parent), m_workspace(workspace) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(kMargin, kMargin, kMargin, kMargin);
    layout->addLayout(buildFolder());
    m_chart = new LossChart(this);
    m_chart->setObjectName(QStringLiteral("checkpointChart"));
    ChartOut out =
        chartOutOf(workspace, QStringLiteral("loss"), [this] { return m_chart->chart(); });
    // The curves are those of a training run, not of the document.
    out.recipe = [this] {
      return render::Recipe{{"marey", MAREY_VERSION},
                            {"plot", "loss"},
                            {"training_run", m_folder->text().toStdString()}};
    };
    new ChartMenu(m_chart, std::move(out));
    m_strip = new CheckpointStrip(workspace, this);
    m_strip->setObjectName(QStringLiteral("checkpointStrip"));
    buildTable();
    // Side by side: docks are wide rather than high.
    auto* row = new QHBoxLayout;
    row->addWidget(m_chart, 1);
    row->addWidget(m_strip, 1);
    row->addWidget(m_table, 1);
    layout->addLayout(row, 1);
    m_sample = new QPushButton(this);
    m_sample->setObjectName(QStringLiteral("checkpointSample"));
    m_sample->setToolTip(tr("The same seeds along the current path with every marked checkpoint"));
    layout->addWidget(m_sample);
    connect(m_sample, &QPushButton::clicked, this, &CheckpointPanel::sampleAll);
    connect(m_chart, &LossChart::checkpointClicked, this,
            [this](int index) { m_table->selectRow(index); });
    connect(m_strip, &CheckpointStrip::checkpointClicked, this,
            [this](int index) { m_table->selectRow(index); });
    connect(m_table, &QTableWidget::itemSelectionChanged, this, [this] {
      m_chart->setCurrent(m_table->currentRow());
      m_strip->setCurrentRow(m_table->currentRow());
    });
    connect(m_table, &QTableWidget::itemChanged, this, &CheckpointPanel::refreshButton);
    connect(&workspace.document(), &Document::changed, this, &CheckpointPanel::refreshButton);
    connect(&m_timer, &QTimer::timeout, this, [this] {
      if (isVisible() && !m_folder->text().isEmpty() && written() != m_written) readRun(false);
    });
    connect(&workspace, &Workspace::viewAsked, this, [this](ViewState& view) {
      if (!m_read.isEmpty())
        view.trainingRun = fs::absolute(m_read.toStdString()).lexically_normal().string();
    });
    connect(&workspace, &Workspace::viewOpened, this, [this](const ViewState& view) {
      if (view.trainingRun.empty()) return;
      const fs::path folder = m_workspace.document().experiment().folder / view.trainingRun;
      m_folder->setText(QString::fromStdString(folder.string()));
      readRun(false);
    });
    m_timer.start(kLookEveryMs);
    refreshButton();
  }

 private:
  QLayout* buildFolder() {
    m_folder = new QLineEdit(this);
    m_folder->setObjectName(QStringLiteral("checkpointFolder"));
    m_folder->setPlaceholderText(tr("Folder of a training run"));
    auto* browse = new QToolButton(this);
    browse->setObjectName(QStringLiteral("checkpointBrowse"));
    browse->setText(tr("Choose…"));
    connect(m_folder, &QLineEdit::editingFinished, this, [this] {
      if (m_folder->text() != m_read) readRun(true);
    });
    connect(browse, &QToolButton::clicked, this, [this] {
      const QSettings settings;
      const QString chosen = QFileDialog::getExistingDirectory(
          this, tr("Folder of a training run"),
          settings.value(QStringLiteral("trainingRun")).toString());
      if (chosen.isEmpty()) return;
      m_folder->setText(chosen);
      readRun(true);
    });
    auto* row = new QHBoxLayout;
    row->addWidget(m_folder, 1);
    row->addWidget(browse);
    return row;
  }

  void buildTable() {
    m_table = new QTableWidget(0, 4, this);
    m_table->setObjectName(QStringLiteral("checkpointTable"));
    m_table->setHorizontalHeaderLabels({tr("Checkpoint"), tr("Minutes"), tr("Train"), tr("Valid")});
    m_table->verticalHeader()->hide();
    m_table->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
    m_table->setEditTriggers(QAbstractItemView::NoEditTriggers);
    m_table->setSelectionBehavior(QAbstractItemView::SelectRows);
    m_table->setSelectionMode(QAbstractItemView::SingleSelection);
  }

  fs::file_time_type written() const {
    std::error_code none;
    return fs::last_write_time(fs::path(m_folder->text().toStdString()) / "log.csv", none);
  }

  /// `tell`: an error is the user's to know, not only that a running training is just writing.
  void readRun(bool tell) {
    m_read = m_folder->text();
    if (m_read.isEmpty()) return;
    m_written = written();
    try {
      m_run = readTrainingRun(m_read.toStdString());
      QSettings().setValue(QStringLiteral("trainingRun"), m_read);
    } catch (const Error& error) {
      if (tell) {
        m_run = {};
        m_workspace.report(tr("Reading the training run"), QString::fromStdString(error.what()));
      }
    }
    m_chart->setRun(m_run);
    m_strip->setRun(m_run);
    fillTable();
  }

  const LossRow* rowAt(int64_t step) const {
    for (const LossRow& row : m_run.rows)
      if (row.step == step) return &row;
    return nullptr;
  }

  void fillTable() {
    std::set<QString> unmarked;
    for (int row = 0; row < m_table->rowCount(); ++row)
      if (m_table->item(row, 0)->checkState() != Qt::Checked)
        unmarked.insert(m_table->item(row, 0)->text());
    m_table->setRowCount(static_cast<int>(m_run.checkpoints.size()));
    for (int row = 0; row < m_table->rowCount(); ++row) {
      const Checkpoint& checkpoint = m_run.checkpoints[static_cast<size_t>(row)];
      auto* name = new QTableWidgetItem(QString::fromStdString(checkpoint.name));
      name->setToolTip(QString::fromStdString(checkpoint.file));
      name->setCheckState(unmarked.contains(name->text()) ? Qt::Unchecked : Qt::Checked);
      m_table->setItem(row, 0, name);
      const LossRow* loss = rowAt(checkpoint.step);
      const double values[] = {loss ? loss->seconds / 60.0 : std::nan(""),
                               loss ? loss->train : std::nan(""),
                               loss ? loss->valid : std::nan("")};
      for (int i = 0; i < 3; ++i) {
        auto* item = new QTableWidgetItem(
            std::isfinite(values[i]) ? QString::number(values[i], 'f', 1) : QStringLiteral("–"));
        item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
        m_table->setItem(row, i + 1, item);
      }
    }
    refreshButton();
  }

  std::vector<int> marked() const {
    std::vector<int> out;
    for (int row = 0; row < m_table->rowCount(); ++row)
      if (m_table->item(row, 0) != nullptr && m_table->item(row, 0)->checkState() == Qt::Checked)
        out.push_back(row);
    return out;
  }

  void refreshButton() {
    const auto count = static_cast<int>(marked().size());
    m_sample->setEnabled(count > 0 && !m_workspace.document().experiment().paths.empty());
    m_sample->setText(count == m_table->rowCount() ? tr("Sample all (%1)").arg(count)
                                                   : tr("Sample the marked ones (%1)").arg(count));
  }

  void sampleAll() {
    const Experiment& e = m_workspace.document().experiment();
    const ExperimentPath path = e.paths[static_cast<size_t>(m_workspace.document().currentPath())];
    for (const int row : marked()) {
      const Checkpoint& checkpoint = m_run.checkpoints[static_cast<size_t>(row)];
      SampleRecipe recipe;
      recipe.system.name = checkpoint.name;
      recipe.system.model = fs::absolute(checkpoint.file).string();
      recipe.path = path;
      recipe.samples = e.samples;
      recipe.seed = e.seed;
      recipe.fps = e.fps;
      recipe.folder = e.folder;
      int old = -1;
      for (const MotionGroup& group : m_workspace.motions().groups())
        if (group.recipe && !group.pinned && group.recipe->system.model == recipe.system.model &&
            group.recipe->path.name == path.name)
          old = group.id;
      m_workspace.sampling().sample(recipe, old, render::stageIndex(stageOf(m_run, checkpoint)));
    }
  }

  Workspace& m_workspace;
  QLineEdit* m_folder = nullptr;
  LossChart* m_chart = nullptr;
  CheckpointStrip* m_strip = nullptr;
  QTableWidget* m_table = nullptr;
  QPushButton* m_sample = nullptr;
  QTimer m_timer;
  TrainingRun m_run;
  QString m_read;                  ///< the folder that was read last
  fs::file_time_type m_written{};  ///< of its log, then
};

}  // namespace

QWidget* makeCheckpointPanel(Workspace& workspace, QWidget* parent) {
  return new CheckpointPanel(workspace, parent);
}

}  // namespace marey::gui
