#include "gui/path/path_list.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QInputDialog>
#include <QLabel>
#include <algorithm>

#include "gui/common/file_dialogs.h"
#include "gui/common/number_box.h"
#include "gui/common/paint_style.h"

#include "base/error.h"
#include "experiment/edits.h"

namespace marey::gui {

PathList::PathList(Workspace& workspace, CurrentPath& path, QWidget* parent)
    : QWidget(parent), m_workspace(workspace), m_path(path) {
  build();
  buildMenus();
  connect(&workspace.document(), &Document::changed, this, &PathList::refresh);
  connect(&workspace.document(), &Document::currentPathChanged, this, &PathList::refresh);
  connect(&workspace.view(), &View::selectionChanged, this, &PathList::refreshActions);
  connect(&path, &CurrentPath::changed, this, &PathList::refresh);
  refresh();
}

QToolButton* PathList::addMenuButton(const QString& name, const QString& text,
                                     const QString& toolTip) {
  auto* button = new QToolButton(this);
  button->setObjectName(name);
  button->setText(text);
  button->setToolTip(toolTip);
  button->setPopupMode(QToolButton::InstantPopup);
  button->setMenu(new QMenu(button));
  return button;
}

void PathList::build() {
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setSpacing(kSpacing);
  m_choice = new QComboBox(this);
  m_choice->setObjectName(QStringLiteral("pathChoice"));
  m_choice->setToolTip(tr("The path that is edited and sampled"));
  m_choice->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  m_choice->setMinimumContentsLength(10);
  connect(m_choice, qOverload<int>(&QComboBox::currentIndexChanged), this, [this](int index) {
    if (!m_filling && index >= 0) m_workspace.document().setCurrentPath(index);
  });
  m_add = addMenuButton(QStringLiteral("pathAdd"), tr("Add"), tr("Add a path to the document"));
  m_more = addMenuButton(QStringLiteral("pathMore"), tr("More"), tr("Rename, copy, files"));
  m_seconds = new NumberBox(this);
  m_seconds->setObjectName(QStringLiteral("pathSeconds"));
  m_seconds->setRange(0.0, 86400.0);
  m_seconds->setDecimals(1);
  m_seconds->setSuffix(tr(" s"));
  // Room for the words that stand for 0.
  m_seconds->setMinimumWidth(m_seconds->fontMetrics().horizontalAdvance(tr("whole path")) + 44);
  m_seconds->setToolTip(tr("How long motions follow the path; 0: as long as the path takes"));
  connect(m_seconds, qOverload<double>(&QDoubleSpinBox::valueChanged), this, [this](double value) {
    if (m_filling || !m_path.path()) return;
    const auto index = static_cast<size_t>(m_workspace.document().currentPath());
    m_workspace.document().edit(tr("Length of path"),
                                [&](Experiment& e) { setPathSeconds(e, index, value); });
    refresh();  // too short a length shows as it is now
  });
  m_type =
      new TypeBox("pathType", tr("Type of motion for all of the path, for models that know types"),
                  tr("as the path has it"), this);
  connect(m_type, &TypeBox::typeChosen, this, [this](const std::string& type) {
    if (!m_path.path()) return;
    const auto index = static_cast<size_t>(m_workspace.document().currentPath());
    m_workspace.document().edit(tr("Type of path"),
                                [&](Experiment& e) { e.paths.at(index).control.type = type; });
  });
  m_makeDrawn = new QPushButton(tr("Make editable"), this);
  m_makeDrawn->setObjectName(QStringLiteral("pathMakeEditable"));
  m_makeDrawn->setToolTip(tr("Turn this preset, clip or file into way-points, one per second"));
  connect(m_makeDrawn, &QPushButton::clicked, &m_path, &CurrentPath::makeDrawn);
  auto* seconds = new QLabel(tr("Length"), this);
  seconds->setBuddy(m_seconds);
  grid->addWidget(m_choice, 0, 0, 1, 3);
  grid->addWidget(m_add, 0, 3);
  grid->addWidget(m_more, 0, 4);
  grid->addWidget(seconds, 1, 0);
  grid->addWidget(m_seconds, 1, 1);
  auto* type = new QHBoxLayout;
  type->addWidget(new QLabel(tr("Type"), this));
  type->addWidget(m_type, 1);
  grid->addLayout(type, 1, 2);
  grid->addWidget(m_makeDrawn, 1, 3, 1, 2, Qt::AlignRight);
  grid->setColumnStretch(2, 1);
}

void PathList::buildMenus() {
  const auto action = [this](QMenu* menu, const char* name, const QString& text,
                             const std::function<void()>& run) {
    QAction* out = menu->addAction(text);
    out->setObjectName(QLatin1String(name));
    connect(out, &QAction::triggered, this, run);
    return out;
  };
  QMenu* menu = m_add->menu();
  action(menu, "pathAddDrawn", tr("Way-points of my own"), [this] {
    const auto point = [](double x, double z) {
      return WayPoint{.x = x, .z = z, .timeS = {}, .speedMS = {}, .facing = {}};
    };
    add(tr("Add path"), {.name = "path",
                         .path = {},
                         .wayPoints = {point(0, 0), point(0.5, 2), point(0, 4)},
                         .seconds = 0.0});
  });
  menu->addSeparator();
  for (const PathPreset& preset : pathPresets()) {
    const std::string id = "pathAddPreset_" + preset.name;
    QAction* one =
        action(menu, id.c_str(), QString::fromStdString(preset.name), [this, name = preset.name] {
          add(tr("Add path"), {.name = name, .path = "preset:" + name});
        });
    one->setToolTip(QString::fromStdString(preset.description));
  }
  menu->setToolTipsVisible(true);
  menu->addSeparator();
  action(menu, "pathImport", tr("From a path file…"), [this] { askImport(); });
  m_take = action(menu, "pathTakeMotion", tr("Way of the selected motion"),
                  [this] { takeSelectedMotion(); });
  QMenu* more = m_more->menu();
  m_rename = action(more, "pathRename", tr("Rename…"), [this] { askName(); });
  m_copy = action(more, "pathDuplicate", tr("Duplicate"), [this] {
    if (m_path.path()) add(tr("Duplicate path"), *m_path.path());
  });
  m_remove = action(more, "pathRemove", tr("Remove from the document"), [this] { remove(); });
  more->addSeparator();
  m_export = action(more, "pathExport", tr("Save as path file…"), [this] { askExport(); });
}

void PathList::refresh() {
  const auto& paths = m_workspace.document().experiment().paths;
  m_filling = true;
  m_choice->clear();
  for (const ExperimentPath& path : paths)
    m_choice->addItem(QString::fromStdString(path.name), QString::fromStdString(path.path));
  m_choice->setCurrentIndex(paths.empty() ? -1 : m_workspace.document().currentPath());
  const ExperimentPath* path = m_path.path();
  m_choice->setEnabled(path != nullptr);
  m_seconds->setEnabled(path != nullptr);
  // A preset has no end of its own.
  const bool preset = path && !m_path.drawn() && path->path.starts_with("preset:");
  m_seconds->setSpecialValueText(preset ? tr("usual") : tr("whole path"));
  m_seconds->display(path ? path->seconds : 0.0);
  m_type->setEnabled(path != nullptr);
  m_type->display(m_workspace.motionTypes(), path ? path->control.type : std::string());
  m_makeDrawn->setVisible(path && !m_path.drawn());
  m_makeDrawn->setEnabled(m_path.points().size() > 1);
  m_filling = false;
  refreshActions();
}

void PathList::refreshActions() {
  const bool any = m_path.path() != nullptr;
  m_rename->setEnabled(any);
  m_copy->setEnabled(any);
  m_remove->setEnabled(any);
  m_export->setEnabled(m_path.points().size() > 1);
  m_take->setEnabled(!m_workspace.view().selection().motions.empty());
}

void PathList::add(const QString& label, ExperimentPath path) {
  size_t index = m_workspace.document().experiment().paths.size();
  m_workspace.document().edit(label, [&](Experiment& e) { index = addPath(e, std::move(path)); });
  m_workspace.document().setCurrentPath(static_cast<int>(index));
}

void PathList::remove() {
  const auto index = static_cast<size_t>(m_workspace.document().currentPath());
  m_workspace.document().edit(tr("Remove path"), [index](Experiment& e) {
    e.paths.erase(e.paths.begin() + static_cast<std::ptrdiff_t>(index));
  });
}

void PathList::rename(const QString& name) {
  const auto index = static_cast<size_t>(m_workspace.document().currentPath());
  m_workspace.document().edit(tr("Rename path"), [&](Experiment& e) {
    renamePath(e, index, name.trimmed().toStdString());
  });
}

void PathList::takeSelectedMotion() {
  const auto& selected = m_workspace.view().selection().motions;
  const Motion* motion =
      selected.empty() ? nullptr : m_workspace.motions().motion(*selected.begin());
  if (!motion) return;
  try {
    const Clip& clip = *motion->clip;
    auto points = fitWayPoints(rootTrajectory(clip, FeatureSpec{}), clip.fps);
    add(tr("Path of a motion"), {.name = clip.name.empty() ? "motion" : clip.name,
                                 .path = {},
                                 .wayPoints = std::move(points),
                                 .seconds = 0.0});
  } catch (const Error& error) {
    m_workspace.report(tr("Path of a motion"), QString::fromUtf8(error.what()));
  }
}

void PathList::importFile(const QString& file) {
  try {
    add(tr("Import path"), {.name = QFileInfo(file).completeBaseName().toStdString(),
                            .path = {},
                            .wayPoints = readPathFile(file.toStdString()),
                            .seconds = 0.0});
  } catch (const Error& error) {
    m_workspace.report(tr("Import path"), QString::fromUtf8(error.what()));
  }
}

void PathList::exportFile(const QString& file) {
  try {
    writePathFile(file.toStdString(), m_path.points());
  } catch (const Error& error) {
    m_workspace.report(tr("Save path"), QString::fromUtf8(error.what()));
  }
}

void PathList::askName() {
  bool wanted = false;
  const QString name = QInputDialog::getText(this, tr("Rename path"), tr("Name"), QLineEdit::Normal,
                                             m_choice->currentText(), &wanted);
  if (wanted) rename(name);
}

void PathList::askImport() {
  const QString file = QFileDialog::getOpenFileName(this, tr("Path file"), {},
                                                    tr("Path files (*.json);;All files (*)"));
  if (!file.isEmpty()) importFile(file);
}

void PathList::askExport() {
  const QString file =
      askSaveFile(this, tr("Save path"), m_choice->currentText() + QStringLiteral(".json"),
                  tr("Path files (*.json)"), QStringLiteral("json"));
  if (!file.isEmpty()) exportFile(file);
}

}  // namespace marey::gui
