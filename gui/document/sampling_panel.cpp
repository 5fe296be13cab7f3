#include "gui/document/sampling_panel.h"

#include <QComboBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QRandomGenerator>
#include <QRegularExpressionValidator>
#include <QTableWidget>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <limits>
#include <optional>

#include "gui/common/number_box.h"
#include "gui/document/option_form.h"
#include "gui/workspace/workspace.h"

#include "experiment/edits.h"
#include "render/base/colours.h"

namespace marey::gui {
namespace {

class SamplingPanel : public QWidget {
 public:
  SamplingPanel(Workspace& workspace, QWidget* parent) : QWidget(parent), m_workspace(workspace) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(8, 8, 8, 8);
    layout->addWidget(buildSystems());
    m_options = new OptionForm(
        [this](const SamplingOption& option, double value) { takeOption(option, value); }, this);
    layout->addWidget(m_options);
    layout->addLayout(buildForm());
    layout->addLayout(buildButtons());
    m_speed = new QLabel(this);
    m_speed->setWordWrap(true);
    layout->addWidget(m_speed);
    layout->addStretch(1);
    connectEdits();
    connect(&workspace.document(), &Document::changed, this, &SamplingPanel::refresh);
    connect(&workspace.document(), &Document::currentPathChanged, this, &SamplingPanel::refresh);
    connect(&workspace.jobs(), &JobQueue::changed, this, &SamplingPanel::refreshButtons);
    refresh();
  }

 private:
  QWidget* buildSystems() {
    m_systems = new QTableWidget(0, 3, this);
    m_systems->setObjectName(QStringLiteral("systemTable"));
    m_systems->setHorizontalHeaderLabels({tr("Model"), tr("Temperature"), tr("File")});
    m_systems->verticalHeader()->hide();
    m_systems->horizontalHeader()->setSectionResizeMode(0, QHeaderView::Stretch);
    m_systems->horizontalHeader()->resizeSection(1, 100);
    m_systems->horizontalHeader()->setSectionResizeMode(2, QHeaderView::Stretch);
    m_systems->setSelectionBehavior(QAbstractItemView::SelectRows);
    m_systems->setMaximumHeight(150);
    connect(m_systems, &QTableWidget::currentCellChanged, this, [this] { refreshOptions(); });
    connect(m_systems, &QTableWidget::cellChanged, this, [this](int row, int column) {
      if (m_refreshing || column != 0) return;
      const std::string& before = m_workspace.document().experiment().systems.at(size_t(row)).name;
      m_workspace.sampling().setSampled(before,
                                        m_systems->item(row, 0)->checkState() == Qt::Checked);
      refreshButtons();
      const std::string name = m_systems->item(row, 0)->text().toStdString();
      if (name == before) return;
      m_workspace.document().edit(tr("Rename model"), [&](Experiment& e) {
        renameSystem(e, static_cast<size_t>(row), name);
      });
      refresh();  // a refused name goes back
    });
    return m_systems;
  }

  QLayout* buildForm() {
    auto* form = new QFormLayout;
    m_path = new QComboBox(this);
    m_path->setObjectName(QStringLiteral("samplePath"));
    m_seconds = new NumberBox(this);
    m_seconds->setObjectName(QStringLiteral("sampleSeconds"));
    m_seconds->setRange(0.0, 86400.0);
    m_seconds->setDecimals(1);
    m_seconds->setSuffix(tr(" s"));
    m_seconds->setSpecialValueText(tr("as long as the path takes"));
    m_count = new CountBox(this);
    m_count->setObjectName(QStringLiteral("sampleCount"));
    m_count->setRange(1, std::numeric_limits<int>::max());
    m_start = new QComboBox(this);
    m_start->setObjectName(QStringLiteral("sampleStart"));
    m_start->addItems({tr("Mean pose"), tr("First frames of the clip")});
    m_start->setToolTip(
        tr("What the motion grows out of; a clip's frames for paths of clips only"));
    // A spin box holds 32 bits, a seed 64.
    m_seed = new QLineEdit(this);
    m_seed->setObjectName(QStringLiteral("sampleSeed"));
    m_seed->setValidator(
        new QRegularExpressionValidator(QRegularExpression(QStringLiteral("[0-9]{1,20}")), m_seed));
    auto* another = new QToolButton(this);
    another->setObjectName(QStringLiteral("anotherSeed"));
    another->setText(tr("Another"));
    another->setToolTip(tr("A seed drawn at random"));
    connect(another, &QToolButton::clicked, this,
            [this] { takeSeed(QString::number(QRandomGenerator::global()->bounded(1, 1000000))); });
    auto* seed = new QHBoxLayout;
    seed->addWidget(m_seed, 1);
    seed->addWidget(another);
    form->addRow(tr("Path"), m_path);
    form->addRow(tr("Length"), m_seconds);
    form->addRow(tr("Start"), m_start);
    form->addRow(tr("Samples of each model"), m_count);
    form->addRow(tr("Seed"), seed);
    return form;
  }

  QLayout* buildButtons() {
    m_run = new QPushButton(tr("Sample"), this);
    m_run->setObjectName(QStringLiteral("sampleButton"));
    m_run->setToolTip(tr("Sample the ticked models along the path (Ctrl+Return)"));
    m_run->setDefault(true);
    m_cancel = new QPushButton(tr("Cancel"), this);
    m_cancel->setObjectName(QStringLiteral("sampleCancel"));
    auto* remove = new QPushButton(tr("Remove model"), this);
    remove->setObjectName(QStringLiteral("removeModel"));
    connect(m_run, &QPushButton::clicked, &m_workspace.sampling(), &Sampling::sampleCurrentPath);
    connect(m_cancel, &QPushButton::clicked, &m_workspace.sampling(), &Sampling::cancel);
    connect(remove, &QPushButton::clicked, this, [this] {
      const int row = m_systems->currentRow();
      if (row < 0) return;
      m_workspace.document().edit(
          tr("Remove model"), [row](Experiment& e) { removeSystem(e, static_cast<size_t>(row)); });
    });
    auto* buttons = new QHBoxLayout;
    buttons->addWidget(m_run, 1);
    buttons->addWidget(m_cancel);
    buttons->addWidget(remove);
    return buttons;
  }

  void connectEdits() {
    connect(m_count, qOverload<int>(&QSpinBox::valueChanged), this, [this](int n) {
      change(tr("Number of samples"), [n](Experiment& e) { e.samples = n; });
    });
    connect(m_seed, &QLineEdit::editingFinished, this, [this] { takeSeed(m_seed->text()); });
    connect(m_start, qOverload<int>(&QComboBox::activated), this, [this](int index) {
      const auto path = static_cast<size_t>(m_workspace.document().currentPath());
      change(tr("Start of the motion"),
             [=](Experiment& e) { e.paths.at(path).startFromClip = index == 1; });
    });
    connect(m_path, qOverload<int>(&QComboBox::currentIndexChanged), this, [this](int index) {
      if (!m_refreshing) m_workspace.document().setCurrentPath(index);
    });
    connect(m_seconds, qOverload<double>(&QDoubleSpinBox::valueChanged), this, [this](double s) {
      const auto path = static_cast<size_t>(m_workspace.document().currentPath());
      change(tr("Length of path"), [=](Experiment& e) { setPathSeconds(e, path, s); });
    });
  }

  /// What the model of a system takes; nothing is known of a file that cannot be read.
  std::optional<std::vector<SamplingOption>> schemaOf(const ExperimentSystem& system) {
    try {
      return m_workspace.optionSchema(system);
    } catch (const Error&) {  // sampling will say what is wrong with it
      return std::nullopt;
    }
  }

  void takeOption(const SamplingOption& option, double value) {
    const int row = optionRow();
    if (row < 0) return;
    change(QString::fromStdString(option.title), [=](Experiment& e) {
      OptionValues& options = e.systems.at(static_cast<size_t>(row)).options;
      if (value == option.fallback)
        options.erase(option.name);
      else
        options[option.name] = value;
    });
  }

  /// The model whose options are shown: the chosen one, or the only one.
  int optionRow() const {
    const auto count = static_cast<int>(m_workspace.document().experiment().systems.size());
    const int row = m_systems->currentRow();
    return row >= 0 && row < count ? row : count == 1 ? 0 : -1;
  }

  /// The temperature has its place in the table.
  void refreshOptions() {
    const int row = optionRow();
    std::vector<SamplingOption> schema;
    OptionValues values;
    if (row >= 0) {
      const ExperimentSystem& system = m_workspace.document().experiment().systems[static_cast<size_t>(row)];
      schema = schemaOf(system).value_or(schema);
      std::erase_if(schema, [](const SamplingOption& o) { return o.name == kTemperature; });
      values = system.options;
    }
    m_options->show(schema, values);
  }

  /// A model without latents has no temperature.
  void showTemperature(NumberBox& box, const ExperimentSystem& system) {
    const std::vector<SamplingOption> schema = schemaOf(system).value_or(m_unknown);
    const auto option = std::find_if(schema.begin(), schema.end(), [](const SamplingOption& o) {
      return o.name == kTemperature;
    });
    const bool has = option != schema.end();
    // One that a document has set to what the model refuses can still be set back.
    box.setEnabled(has || system.temperature != 1.0);
    box.setToolTip(has ? QString::fromStdString(option->about)
                       : tr("This model draws nothing that could be cooled"));
    box.display(system.temperature);
  }

  /// Numbers that do not fit 64 bits go back to the document's.
  void takeSeed(const QString& text) {
    bool fits = false;
    const uint64_t seed = text.toULongLong(&fits);
    m_seed->setModified(false);
    if (fits) change(tr("Seed"), [seed](Experiment& e) { e.seed = seed; });
    refresh();
  }

  void change(const QString& label, const std::function<void(Experiment&)>& edit) {
    if (!m_refreshing) m_workspace.document().edit(label, edit, true);
  }

  void refresh() {
    m_refreshing = true;
    const Experiment& e = m_workspace.document().experiment();
    m_count->display(e.samples);
    // What is being typed is not finished yet.
    if (!m_seed->hasFocus() || !m_seed->isModified()) m_seed->setText(QString::number(e.seed));
    m_path->clear();
    for (const ExperimentPath& path : e.paths) m_path->addItem(QString::fromStdString(path.name));
    m_path->setCurrentIndex(m_workspace.document().currentPath());
    const auto index = static_cast<size_t>(m_workspace.document().currentPath());
    m_seconds->setEnabled(index < e.paths.size());
    if (index < e.paths.size()) m_seconds->display(e.paths[index].seconds);
    m_start->setEnabled(index < e.paths.size() && e.paths[index].followsClip());
    m_start->setCurrentIndex(index < e.paths.size() && e.paths[index].startFromClip ? 1 : 0);
    refreshSystems();
    m_refreshing = false;
    refreshButtons();
  }

  void refreshSystems() {
    const auto& systems = m_workspace.document().experiment().systems;
    m_systems->setRowCount(static_cast<int>(systems.size()));
    for (int row = 0; row < static_cast<int>(systems.size()); ++row) {
      const ExperimentSystem& system = systems[static_cast<size_t>(row)];
      auto* name = new QTableWidgetItem(QString::fromStdString(system.name));
      const render::Colour c = render::colourOf(row);
      QPixmap swatch(12, 12);
      swatch.fill(QColor::fromRgbF(c.r, c.g, c.b));
      name->setIcon(swatch);
      name->setCheckState(m_workspace.sampling().sampled(system.name) ? Qt::Checked
                                                                      : Qt::Unchecked);
      name->setToolTip(tr("Ticked models are sampled"));
      m_systems->setItem(row, 0, name);
      auto* file = new QTableWidgetItem(QString::fromStdString(system.model));
      file->setToolTip(QString::fromStdString(m_workspace.document().modelFile(system)));
      file->setFlags(file->flags() & ~Qt::ItemIsEditable);
      m_systems->setItem(row, 2, file);
      auto* box = static_cast<NumberBox*>(m_systems->cellWidget(row, 1));
      if (box == nullptr) box = temperatureBox(row);
      showTemperature(*box, system);
    }
    refreshOptions();
  }

  NumberBox* temperatureBox(int row) {
    auto* box = new NumberBox;
    box->setObjectName(QStringLiteral("temperature%1").arg(row));
    box->setRange(0.0, 4.0);
    box->setSingleStep(0.05);
    connect(box, qOverload<double>(&QDoubleSpinBox::valueChanged), this, [this, row](double t) {
      change(tr("Temperature"),
             [=](Experiment& e) { e.systems.at(static_cast<size_t>(row)).temperature = t; });
    });
    m_systems->setCellWidget(row, 1, box);
    return box;
  }

  void refreshButtons() {
    const Experiment& e = m_workspace.document().experiment();
    const bool any = std::any_of(e.systems.begin(), e.systems.end(), [this](const auto& system) {
      return m_workspace.sampling().sampled(system.name);
    });
    m_run->setEnabled(any && !e.paths.empty());
    m_cancel->setEnabled(m_workspace.sampling().active());
    m_speed->setText(e.systems.empty() ? tr("Add a model (Ctrl+M) or drop its file on the window.")
                     : e.paths.empty() ? tr("Add a path in the path editor.")
                     : !any            ? tr("Tick a model to sample it.")
                                       : QString());
  }

  static constexpr const char* kTemperature = "temperature";

  Workspace& m_workspace;
  QTableWidget* m_systems = nullptr;
  OptionForm* m_options = nullptr;
  /// Of a file that cannot be read.
  std::vector<SamplingOption> m_unknown{temperatureOption(1)};
  QComboBox* m_path = nullptr;
  NumberBox* m_seconds = nullptr;
  CountBox* m_count = nullptr;
  QLineEdit* m_seed = nullptr;
  QComboBox* m_start = nullptr;
  QPushButton* m_run = nullptr;
  QPushButton* m_cancel = nullptr;
  QLabel* m_speed = nullptr;
  bool m_refreshing = false;  ///< the widgets are being set, not used
};

}  // namespace

QWidget* makeSamplingPanel(Workspace& workspace, QWidget* parent) {
  return new SamplingPanel(workspace, parent);
}

}  // namespace marey::gui
